// sim_node/engine/simd/lane_batch.h -- 8 values in memory, worked on in the registers of one width;
// a single value with scalar lanes.
//
// `Lanes` is one of the types of lanes_*.h; what is made of it belongs to the file that does so.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_node/engine/core/vector_width.h"

namespace cordis::engine {

template <class Lanes>
struct LaneBatch {
  static_assert(kBatchRows % Lanes::kWidth == 0, "a batch is whole registers");
  using Row = typename Lanes::Row;
  static constexpr std::size_t kRows = Lanes::kWidth == 1 ? 1 : kBatchRows;
  static constexpr std::uint32_t kAll = (1U << kBatchRows) - 1U;

  /// out = make(values...), value by value; arrays 64-byte aligned, out may be one of the others.
  template <class Make, class... Values>
  static void each(double* out, Make make, const Values*... values) noexcept {
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kRows; i += Lanes::kWidth) {
      Lanes::store(out + i, make(Lanes::load(values + i)...));
    }
  }

  static void fill(double* out, double value) noexcept {
    each(out, [value] { return Lanes::every(value); });
  }

  /// out = value where the bit of `rows` is set.
  static void put(double* out, const double* value, std::uint32_t rows) noexcept {
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kRows; i += Lanes::kWidth) {
      const Row put_in = Lanes::load(value + i);
      const Row kept = Lanes::load(out + i);
      Lanes::store(out + i, Lanes::select(Lanes::mask(part(rows, i)), put_in, kept));
    }
  }

  /// Bit i: test(value i).
  template <class Test>
  static std::uint32_t bits(const double* values, Test test) noexcept {
    std::uint32_t bits = 0;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kRows; i += Lanes::kWidth) {
      bits |= Lanes::bits(test(Lanes::load(values + i))) << i;
    }
    return bits;
  }

  /// Sum of the 8 values of the registers of a batch, in the order of their places.
  static double sum(const Row* parts) noexcept {
    alignas(64) double lane[kRows];
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kRows; i += Lanes::kWidth) {
      Lanes::store(lane + i, parts[i / Lanes::kWidth]);
    }
    double sum = 0.0;
    for (const double value : lane) sum += value;
    return sum;
  }

  /// The bits of the register that begins at row i.
  static std::uint32_t part(std::uint32_t rows, std::size_t i) noexcept {
    return rows >> i & ((1U << Lanes::kWidth) - 1U);
  }
};

}  // namespace cordis::engine
