// sim_node/engine/simd/pair_lanes_avx2.h -- what pairs need beyond lanes_avx2.h.
#pragma once

#include "sim_node/engine/simd/lanes_avx2.h"
#include "sim_node/engine/simd/sum_columns.h"

namespace cordis::engine {
namespace {

/// The 32-bit halves of each set of chosen lanes in order, the rest filled up with lane 0.
// NOLINTNEXTLINE(misc-definitions-in-headers): of an unnamed namespace on purpose, see lanes_sse2.h
alignas(32) constexpr std::int32_t kPackHalves[16][8] = {
    {0, 1, 0, 1, 0, 1, 0, 1}, {0, 1, 0, 1, 0, 1, 0, 1}, {2, 3, 0, 1, 0, 1, 0, 1},
    {0, 1, 2, 3, 0, 1, 0, 1}, {4, 5, 0, 1, 0, 1, 0, 1}, {0, 1, 4, 5, 0, 1, 0, 1},
    {2, 3, 4, 5, 0, 1, 0, 1}, {0, 1, 2, 3, 4, 5, 0, 1}, {6, 7, 0, 1, 0, 1, 0, 1},
    {0, 1, 6, 7, 0, 1, 0, 1}, {2, 3, 6, 7, 0, 1, 0, 1}, {0, 1, 2, 3, 6, 7, 0, 1},
    {4, 5, 6, 7, 0, 1, 0, 1}, {0, 1, 4, 5, 6, 7, 0, 1}, {2, 3, 4, 5, 6, 7, 0, 1},
    {0, 1, 2, 3, 4, 5, 6, 7}};

/// Likewise, of 32-bit numbers.
// NOLINTNEXTLINE(misc-definitions-in-headers)
alignas(16) constexpr std::int32_t kPackWords[16][4] = {
    {0, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {2, 0, 0, 0}, {0, 2, 0, 0},
    {1, 2, 0, 0}, {0, 1, 2, 0}, {3, 0, 0, 0}, {0, 3, 0, 0}, {1, 3, 0, 0}, {0, 1, 3, 0},
    {2, 3, 0, 0}, {0, 2, 3, 0}, {1, 2, 3, 0}, {0, 1, 2, 3}};

struct Avx2PairLanes : Avx2Lanes {
  static Row3 vectors(const double* columns, const std::uint32_t* offset) noexcept {
    return transposed(load(columns + offset[0]), load(columns + offset[1]),
                      load(columns + offset[2]), load(columns + offset[3]));
  }
  static Row3 neighbours(const double* columns) noexcept {
    return transposed(load(columns), load(columns + 4), load(columns + 8), load(columns + 12));
  }
  static void subtract(double* columns, const std::uint32_t* offset, const Row3& v,
                       Row w) noexcept {
    Row column[4];
    columns_of(v, w, column);
#pragma GCC unroll 4
    for (std::size_t l = 0; l < 4; ++l)
      store(columns + offset[l], load(columns + offset[l]) - column[l]);
  }
  static void subtract_from_neighbours(double* columns, const Row3& v) noexcept {
    Row column[4];
    columns_of(v, zero(), column);
#pragma GCC unroll 4
    for (std::size_t l = 0; l < 4; ++l) store(columns + 4 * l, load(columns + 4 * l) - column[l]);
  }
  static void copy_neighbours(double* columns, const double* from) noexcept {
#pragma GCC unroll 4
    for (std::size_t i = 0; i < 4 * kWidth; i += kWidth) store(columns + i, load(from + i));
  }
  static void store_columns(double* columns, const Row3& v, Row w) noexcept {
    Row column[4];
    columns_of(v, w, column);
#pragma GCC unroll 4
    for (std::size_t l = 0; l < 4; ++l) store(columns + 4 * l, column[l]);
  }

  static Column sum_batch(const Row* x, const Row* y, const Row* z, const Row* w) noexcept {
    // lanes 0 + 4, 1 + 5, 2 + 6 and 3 + 7 of each
    return sum_columns(x[0] + x[1], y[0] + y[1], z[0] + z[1], w[0] + w[1]);
  }

  static void pack(double* out, Row v, unsigned chosen) noexcept {
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(kPackHalves[chosen]));
    _mm256_storeu_pd(
        out, _mm256_castsi256_pd(_mm256_permutevar8x32_epi32(_mm256_castpd_si256(v), order)));
  }
  static void pack(std::uint32_t* out, const std::uint32_t* in, unsigned chosen) noexcept {
    const __m128 all = _mm_loadu_ps(reinterpret_cast<const float*>(in));
    const __m128i order = _mm_load_si128(reinterpret_cast<const __m128i*>(kPackWords[chosen]));
    _mm_storeu_ps(reinterpret_cast<float*>(out), _mm_permutevar_ps(all, order));
  }

 private:
  static Row3 transposed(Row c0, Row c1, Row c2, Row c3) noexcept {
    const Row even01 = _mm256_unpacklo_pd(c0, c1);  // x0 x1 z0 z1
    const Row even23 = _mm256_unpacklo_pd(c2, c3);
    const Row odd01 = _mm256_unpackhi_pd(c0, c1);  // y0 y1 and pads
    const Row odd23 = _mm256_unpackhi_pd(c2, c3);
    return {_mm256_permute2f128_pd(even01, even23, 0x20),
            _mm256_permute2f128_pd(odd01, odd23, 0x20),
            _mm256_permute2f128_pd(even01, even23, 0x31)};
  }
  static void columns_of(const Row3& v, Row w, Row* column) noexcept {
    const Row even_xy = _mm256_unpacklo_pd(v.x, v.y);  // x0 y0 x2 y2
    const Row odd_xy = _mm256_unpackhi_pd(v.x, v.y);   // x1 y1 x3 y3
    const Row even_z = _mm256_unpacklo_pd(v.z, w);
    const Row odd_z = _mm256_unpackhi_pd(v.z, w);
    column[0] = _mm256_permute2f128_pd(even_xy, even_z, 0x20);
    column[1] = _mm256_permute2f128_pd(odd_xy, odd_z, 0x20);
    column[2] = _mm256_permute2f128_pd(even_xy, even_z, 0x31);
    column[3] = _mm256_permute2f128_pd(odd_xy, odd_z, 0x31);
  }
};

static_assert(SimdPairLanes<Avx2PairLanes>);

}  // namespace
}  // namespace cordis::engine
