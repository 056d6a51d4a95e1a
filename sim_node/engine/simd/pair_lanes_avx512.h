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
    return transposed(two_columns(columns, columns + 16), two_columns(columns + 4, columns + 20),
                      two_columns(columns + 8, columns + 24),
                      two_columns(columns + 12, columns + 28));
  }
  static void subtract(double* columns, const std::uint32_t* offset, const Row3& v,
                       Row w) noexcept {
    const Row even_xy = _mm512_unpacklo_pd(v.x, v.y);  // x0 y0 x2 y2  x4 y4 x6 y6
    const Row odd_xy = _mm512_unpackhi_pd(v.x, v.y);
    const Row even_z = _mm512_unpacklo_pd(v.z, w);
    const Row odd_z = _mm512_unpackhi_pd(v.z, w);
    const Row c04 = first_pairs(even_xy, even_z);
    const Row c15 = first_pairs(odd_xy, odd_z);
    const Row c26 = second_pairs(even_xy, even_z);
    const Row c37 = second_pairs(odd_xy, odd_z);
    subtract_column(columns + offset[0], _mm512_castpd512_pd256(c04));
    subtract_column(columns + offset[1], _mm512_castpd512_pd256(c15));
    subtract_column(columns + offset[2], _mm512_castpd512_pd256(c26));
    subtract_column(columns + offset[3], _mm512_castpd512_pd256(c37));
    subtract_column(columns + offset[4], _mm512_extractf64x4_pd(c04, 1));
    subtract_column(columns + offset[5], _mm512_extractf64x4_pd(c15, 1));
    subtract_column(columns + offset[6], _mm512_extractf64x4_pd(c26, 1));
    subtract_column(columns + offset[7], _mm512_extractf64x4_pd(c37, 1));
  }
  static void store_columns(double* columns, const Row3& v, Row w) noexcept {
    const Row even_xy = _mm512_unpacklo_pd(v.x, v.y);  // x0 y0 x2 y2  x4 y4 x6 y6
    const Row odd_xy = _mm512_unpackhi_pd(v.x, v.y);
    const Row even_z = _mm512_unpacklo_pd(v.z, w);
    const Row odd_z = _mm512_unpackhi_pd(v.z, w);
    store_two(columns, columns + 16, first_pairs(even_xy, even_z));
    store_two(columns + 4, columns + 20, first_pairs(odd_xy, odd_z));
    store_two(columns + 8, columns + 24, second_pairs(even_xy, even_z));
    store_two(columns + 12, columns + 28, second_pairs(odd_xy, odd_z));
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
  static void store_two(double* low, double* high, Row v) noexcept {
    store_column(low, _mm512_castpd512_pd256(v));
    store_column(high, _mm512_extractf64x4_pd(v, 1));
  }
  static Column sum_halves(Row v) noexcept {
    return _mm512_castpd512_pd256(v) + _mm512_extractf64x4_pd(v, 1);
  }
  static void subtract_column(double* column, Column v) noexcept {
    store_column(column, load_column(column) - v);
  }
};

static_assert(SimdPairLanes<Avx512PairLanes>);

}  // namespace
}  // namespace cordis::engine
