// node/milliseconds.h -- short times as a person reads them.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace cordis::node {

/// `0.25 ms`, `12.3 ms`, `1052 ms`: three digits, and whole milliseconds above.
inline std::string milliseconds_text(double seconds) {
  const double value = 1e3 * seconds;
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), std::abs(value) < 999.5 ? "%.3g ms" : "%.0f ms", value);
  return text.data();
}

}  // namespace cordis::node
