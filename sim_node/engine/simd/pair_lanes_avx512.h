// sim_node/engine/simd/pair_lanes_avx512.h -- what pairs need beyond lanes_avx512.h.
#pragma once

#include "sim_node/engine/simd/lanes_avx512.h"
#include "sim_node/engine/simd/sum_columns.h"

namespace cordis::engine {
namespace {

struct Avx512PairLanes : Avx512Lanes {
  static Row3 vectors(const double* columns, const std::uint32_t* offset) noexcept {
    return transposed(two_columns(columns + offset[0], columns + offset[4]),
                      two_columns(columns + offset[1], columns + offset[5]),
                      two_columns(columns + offset[2], columns + offset[6]),
                      two_columns(columns + offset[3], columns + offset[7]));
  }
  static Row3 neighbours(const double* columns) noexcept {
    const Row c01 = load_any(columns);
    const Row c23 = load_any(columns + 8);
    const Row c45 = load_any(columns + 16);
    const Row c67 = load_any(columns + 24);
    const Row xz0123 = _mm512_unpacklo_pd(c01, c23);  // x0 x2 z0 z2  x1 x3 z1 z3
    const Row xz4567 = _mm512_unpacklo_pd(c45, c67);
    const Row y0123 = _mm512_unpackhi_pd(c01, c23);  // y0 y2 . .  y1 y3 . .
    const Row y4567 = _mm512_unpackhi_pd(c45, c67);
    const __m512i first = _mm512_setr_epi64(0, 4, 1, 5, 8, 12, 9, 13);
    const __m512i second = _mm512_setr_epi64(2, 6, 3, 7, 10, 14, 11, 15);
    return {_mm512_permutex2var_pd(xz0123, first, xz4567),
            _mm512_permutex2var_pd(y0123, first, y4567),
            _mm512_permutex2var_pd(xz0123, second, xz4567)};
  }
  static void subtract(double* columns, const std::uint32_t* offset, const Row3& v,
                       Row w) noexcept {
    Row pairs[4];
    two_by_two(v, w, pairs);
#pragma GCC unroll 4
    for (std::size_t l = 0; l < 4; ++l) {
      subtract_column(columns + offset[l], _mm512_castpd512_pd256(pairs[l]));
    }
#pragma GCC unroll 4
    for (std::size_t l = 0; l < 4; ++l) {
      subtract_column(columns + offset[l + 4], _mm512_extractf64x4_pd(pairs[l], 1));
    }
  }
  static void subtract_from_neighbours(double* columns, const Row3& v) noexcept {
    subtract_two(columns, v, _mm512_setr_epi64(0, 8, 0, 0, 1, 9, 1, 1));
    subtract_two(columns + 8, v, _mm512_setr_epi64(2, 10, 2, 2, 3, 11, 3, 3));
    subtract_two(columns + 16, v, _mm512_setr_epi64(4, 12, 4, 4, 5, 13, 5, 5));
    subtract_two(columns + 24, v, _mm512_setr_epi64(6, 14, 6, 6, 7, 15, 7, 7));
  }
  static void copy_neighbours(double* columns, const double* from) noexcept {
#pragma GCC unroll 4
    for (std::size_t i = 0; i < 4 * kWidth; i += kWidth) store_any(columns + i, load_any(from + i));
  }
  static void store_columns(double* columns, const Row3& v, Row w) noexcept {
    Row pairs[4];
    two_by_two(v, w, pairs);
#pragma GCC unroll 4
    for (std::size_t l = 0; l < 4; ++l) {
      store_column(columns + 4 * l, _mm512_castpd512_pd256(pairs[l]));
      store_column(columns + 4 * l + 16, _mm512_extractf64x4_pd(pairs[l], 1));
    }
  }

  static Column sum_batch(const Row* x, const Row* y, const Row* z, const Row* w) noexcept {
    // lanes 0 + 4, 1 + 5, 2 + 6 and 3 + 7 of each
    return sum_columns(sum_halves(*x), sum_halves(*y), sum_halves(*z), sum_halves(*w));
  }

  static void pack(double* out, Row v, unsigned chosen) noexcept {
    _mm512_storeu_pd(out, _mm512_maskz_compress_pd(static_cast<__mmask8>(chosen), v));
  }
  static void pack(std::uint32_t* out, const std::uint32_t* in, unsigned chosen) noexcept {
    const __m512i all =
        _mm512_castsi256_si512(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(in)));
    const __m512i packed = _mm512_maskz_compress_epi32(static_cast<__mmask16>(chosen), all);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm512_castsi512_si256(packed));
  }

 private:
  /// The columns of lanes l and l + 4, one after the other.
  static void two_by_two(const Row3& v, Row w, Row* pairs) noexcept {
    const Row even_xy = _mm512_unpacklo_pd(v.x, v.y);  // x0 y0 x2 y2  x4 y4 x6 y6
    const Row odd_xy = _mm512_unpackhi_pd(v.x, v.y);
    const Row even_z = _mm512_unpacklo_pd(v.z, w);
    const Row odd_z = _mm512_unpackhi_pd(v.z, w);
    pairs[0] = first_pairs(even_xy, even_z);
    pairs[1] = first_pairs(odd_xy, odd_z);
    pairs[2] = second_pairs(even_xy, even_z);
    pairs[3] = second_pairs(odd_xy, odd_z);
  }
  static Column sum_halves(Row v) noexcept {
    return _mm512_castpd512_pd256(v) + _mm512_extractf64x4_pd(v, 1);
  }
  /// Subtracts the vectors of two lanes from their columns.
  /// @param lanes  of x and of y (8 more), in the places of x, y and z in both columns
  static void subtract_two(double* columns, const Row3& v, __m512i lanes) noexcept {
    const Row xy = _mm512_maskz_permutex2var_pd(0x33, v.x, lanes, v.y);
    const Row xyz = _mm512_mask_permutexvar_pd(xy, 0x44, lanes, v.z);
    store_any(columns, load_any(columns) - xyz);
  }
  static void subtract_column(double* column, Column v) noexcept {
    store_column(column, load_column(column) - v);
  }
};

static_assert(SimdPairLanes<Avx512PairLanes>);

}  // namespace
}  // namespace cordis::engine
