// sim_node/engine/core/require.h -- one sentence for what is refused.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace cordis::engine {

/// What becomes a string is made one where the condition fails.
/// @throws std::invalid_argument "`what` must be `expected`" unless the condition holds.
template <class What>
void require(bool condition, const What& what, const char* expected) {
  if (!condition) throw std::invalid_argument(std::string(what) + " must be " + expected);
}

inline bool is_finite_and_at_least_zero(double value) {
  return std::isfinite(value) && value >= 0.0;
}

}  // namespace cordis::engine
