// sim_node/engine/description/integrator_kind.cpp
#include "sim_node/engine/description/integrator_kind.h"

#include <stdexcept>

namespace cordis::engine {

const char* to_string(IntegratorKind integrator) noexcept {
  switch (integrator) {
    case IntegratorKind::kCordis:
      return "cordis";
    case IntegratorKind::kLeapfrog:
      return "leapfrog";
    case IntegratorKind::kSymplectic4:
      return "symplectic4";
    case IntegratorKind::kImplicit:
      return "implicit";
    case IntegratorKind::kModal:
      return "modal";
  }
  return "";
}

IntegratorKind integrator_named(const std::string& name) {
  for (const IntegratorKind integrator : kIntegrators) {
    if (name == to_string(integrator)) return integrator;
  }
  std::string names;
  for (const IntegratorKind integrator : kIntegrators)
    names += (names.empty() ? "" : ", ") + std::string(to_string(integrator));
  throw std::invalid_argument("no integrator is called '" + name + "': there are " + names);
}

}  // namespace cordis::engine
