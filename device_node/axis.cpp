// device_node/axis.cpp
#include "device_node/axis.h"

#include <cmath>

namespace cordis::device {

const char* name_of(Role role) noexcept {
  return role == Role::kMass ? "mass" : "liaison";
}

bool all_finite(const AxisValues& values, int count) noexcept {
  for (int a = 0; a < count; ++a) {
    if (!std::isfinite(values[static_cast<std::size_t>(a)])) return false;
  }
  return true;
}

}  // namespace cordis::device
