// sim_node/checks/short_text.h -- numbers in warnings.
#pragma once

#include <cstdio>
#include <string>

namespace cordis::sim {

/// A number with three digits.
inline std::string short_text(double number) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", number);
  return text;
}

}  // namespace cordis::sim
