// sim_node/engine/simd/lanes_scalar.h -- one value in a register of one: the loops of the kernels
// as plain C++, with the bits of every vector width.
//
// For files that are compiled without options of a vector width.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace cordis::engine {

struct ScalarLanes {
  using Row = double;
  static constexpr std::size_t kWidth = 1;

  static Row zero() noexcept { return 0.0; }
  static Row load(const double* value) noexcept { return *value; }
  static void store(double* value, Row v) noexcept { *value = v; }
  static Row sqrt(Row v) noexcept { return std::sqrt(v); }
  static Row every(double value) noexcept { return value; }
  static Row minimum(Row u, Row v) noexcept { return u < v ? u : v; }  // v when one is NaN
  static Row maximum(Row u, Row v) noexcept { return u > v ? u : v; }
  static Row magnitude(Row v) noexcept { return std::abs(v); }

  using Mask = bool;
  static Mask less(Row u, Row v) noexcept { return u < v; }
  static Mask less_or_equal(Row u, Row v) noexcept { return u <= v; }
  static Mask equal(Row u, Row v) noexcept { return u == v; }
  static Mask not_equal(Row u, Row v) noexcept { return u != v; }
  static Mask both(Mask m, Mask n) noexcept { return m && n; }
  static Mask either(Mask m, Mask n) noexcept { return m || n; }
  static Row select(Mask m, Row u, Row v) noexcept { return m ? u : v; }
  static std::uint32_t bits(Mask m) noexcept { return m ? 1U : 0U; }
  static Mask mask(std::uint32_t bits) noexcept { return (bits & 1U) != 0; }
};

}  // namespace cordis::engine
