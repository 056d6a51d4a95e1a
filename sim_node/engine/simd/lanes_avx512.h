// sim_node/engine/simd/lanes_avx512.h -- eight links in a register: for files compiled with
// -mavx512f, without contraction.
//
// It stands in an unnamed namespace so that every file that includes it has its own, which the
// linker cannot mix up with another's.
#pragma once

#include <cstddef>
#include <cstdint>

#include <immintrin.h>

#include "sim_node/engine/simd/simd_lanes.h"

namespace cordis::engine {
namespace {

struct Avx512Lanes {
  using Row = __m512d;
  using Column = __m256d;
  struct Row3 {
    Row x;
    Row y;
    Row z;
  };
  static constexpr std::size_t kWidth = 8;

  static Row zero() noexcept { return _mm512_setzero_pd(); }
  static Row load(const double* values) noexcept { return _mm512_load_pd(values); }
  static void store(double* values, Row v) noexcept { _mm512_store_pd(values, v); }
  static Row load_any(const double* values) noexcept { return _mm512_loadu_pd(values); }
  static void store_any(double* values, Row v) noexcept { _mm512_storeu_pd(values, v); }
  static Row shifted(Row before, Row v) noexcept {
    return _mm512_castsi512_pd(
        _mm512_alignr_epi64(_mm512_castpd_si512(v), _mm512_castpd_si512(before), 7));
  }
  static Row sqrt(Row v) noexcept { return _mm512_sqrt_pd(v); }
  static Row every(double value) noexcept { return _mm512_set1_pd(value); }
  static Row minimum(Row u, Row v) noexcept { return _mm512_min_pd(u, v); }
  static Row maximum(Row u, Row v) noexcept { return _mm512_max_pd(u, v); }
  static Row magnitude(Row v) noexcept { return _mm512_abs_pd(v); }

  using Mask = __mmask8;
  static Mask less(Row u, Row v) noexcept { return _mm512_cmp_pd_mask(u, v, _CMP_LT_OQ); }
  static Mask less_or_equal(Row u, Row v) noexcept { return _mm512_cmp_pd_mask(u, v, _CMP_LE_OQ); }
  static Mask equal(Row u, Row v) noexcept { return _mm512_cmp_pd_mask(u, v, _CMP_EQ_OQ); }
  static Mask not_equal(Row u, Row v) noexcept { return _mm512_cmp_pd_mask(u, v, _CMP_NEQ_UQ); }
  static Mask both(Mask m, Mask n) noexcept { return static_cast<Mask>(m & n); }
  static Mask either(Mask m, Mask n) noexcept { return static_cast<Mask>(m | n); }
  static Row select(Mask m, Row u, Row v) noexcept { return _mm512_mask_blend_pd(m, v, u); }
  static std::uint32_t bits(Mask m) noexcept { return m; }
  static Mask mask(std::uint32_t bits) noexcept { return static_cast<Mask>(bits); }

  static Row inverse_or_zero(Row square, Row length) noexcept {
    const __mmask8 has_direction = _mm512_cmp_pd_mask(square, zero(), _CMP_NEQ_UQ);
    return _mm512_maskz_div_pd(has_direction, _mm512_set1_pd(1.0), length);
  }

  static Row3 difference(const double* columns, const std::uint32_t* a,
                         const std::uint32_t* b) noexcept {
    return transposed(two_differences(columns, a, b, 0), two_differences(columns, a, b, 1),
                      two_differences(columns, a, b, 2), two_differences(columns, a, b, 3));
  }
  static void differences(const double* columns_u, const double* columns_v, const std::uint32_t* a,
                          const std::uint32_t* b, Row3& u, Row3& v) noexcept {
    Row of_u[4];
    Row of_v[4];
#pragma GCC unroll 4
    for (std::size_t l = 0; l < 4; ++l) {  // of both while the places of the columns are at hand
      of_u[l] = two_differences(columns_u, a, b, l);
      of_v[l] = two_differences(columns_v, a, b, l);
    }
    u = transposed(of_u[0], of_u[1], of_u[2], of_u[3]);
    v = transposed(of_v[0], of_v[1], of_v[2], of_v[3]);
  }
  static Row difference_1d(const double* columns, const std::uint32_t* a,
                           const std::uint32_t* b) noexcept {
    return gather(columns, b) - gather(columns, a);
  }

  static void add_pairs(double* force, const std::uint32_t* a, const std::uint32_t* b,
                        const Row3& tension) noexcept {
    const Row even_xy = _mm512_unpacklo_pd(tension.x, tension.y);  // x0 y0 x2 y2  x4 y4 x6 y6
    const Row odd_xy = _mm512_unpackhi_pd(tension.x, tension.y);   // x1 y1 x3 y3  x5 y5 x7 y7
    const Row even_z = _mm512_unpacklo_pd(tension.z, zero());      // z0 0 z2 0  z4 0 z6 0
    const Row odd_z = _mm512_unpackhi_pd(tension.z, zero());       // z1 0 z3 0  z5 0 z7 0
    const Row c04 = first_pairs(even_xy, even_z);
    const Row c15 = first_pairs(odd_xy, odd_z);
    const Row c26 = second_pairs(even_xy, even_z);
    const Row c37 = second_pairs(odd_xy, odd_z);
    add_pair(force + a[0], force + b[0], _mm512_castpd512_pd256(c04));
    add_pair(force + a[1], force + b[1], _mm512_castpd512_pd256(c15));
    add_pair(force + a[2], force + b[2], _mm512_castpd512_pd256(c26));
    add_pair(force + a[3], force + b[3], _mm512_castpd512_pd256(c37));
    add_pair(force + a[4], force + b[4], _mm512_extractf64x4_pd(c04, 1));
    add_pair(force + a[5], force + b[5], _mm512_extractf64x4_pd(c15, 1));
    add_pair(force + a[6], force + b[6], _mm512_extractf64x4_pd(c26, 1));
    add_pair(force + a[7], force + b[7], _mm512_extractf64x4_pd(c37, 1));
  }
  static void add_pairs_1d(double* force, const std::uint32_t* a, const std::uint32_t* b,
                           Row tension) noexcept {
    alignas(64) double lane[kWidth];
    store(lane, tension);
    for (std::size_t i = 0; i < kWidth; ++i) {
      force[a[i]] += lane[i];
      force[b[i]] -= lane[i];
    }
  }

  static Column load_column(const double* values) noexcept {
    return _mm256_load_pd(values);
  }
  static void store_column(double* values, Column v) noexcept {
    _mm256_store_pd(values, v);
  }
  static Column broadcast(double value) noexcept {
    return _mm256_set1_pd(value);
  }
  static Column unite(Column u, Column v) noexcept {
    return _mm256_or_pd(u, v);
  }
  static bool is_zero(Column v) noexcept {
    return _mm256_movemask_pd(_mm256_cmp_pd(v, _mm256_setzero_pd(), _CMP_NEQ_UQ)) == 0;
  }
  static double sum_column(Column v) noexcept {
    alignas(32) double value[4];
    store_column(value, v);
    return value[0] + value[1] + value[2];
  }

 protected:
  /// The vectors of links l and l + 4, one after the other.
  static Row two_differences(const double* columns, const std::uint32_t* a, const std::uint32_t* b,
                             std::size_t l) noexcept {
    return two_columns(columns + b[l], columns + b[l + 4]) -
           two_columns(columns + a[l], columns + a[l + 4]);
  }
  static Row two_columns(const double* low, const double* high) noexcept {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(load_column(low)), load_column(high), 1);
  }
  /// Lanes 0 1 of u and then of v, in each half.
  static Row first_pairs(Row u, Row v) noexcept {
    return _mm512_permutex2var_pd(u, _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), v);
  }
  /// Lanes 2 3 of u and then of v, in each half.
  static Row second_pairs(Row u, Row v) noexcept {
    return _mm512_permutex2var_pd(u, _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15), v);
  }
  static Row3 transposed(Row c04, Row c15, Row c26, Row c37) noexcept {
    const Row even01 = _mm512_unpacklo_pd(c04, c15);  // x0 x1 z0 z1  x4 x5 z4 z5
    const Row even23 = _mm512_unpacklo_pd(c26, c37);  // x2 x3 z2 z3  x6 x7 z6 z7
    const Row odd01 = _mm512_unpackhi_pd(c04, c15);   // y0 y1 . .  y4 y5 . .
    const Row odd23 = _mm512_unpackhi_pd(c26, c37);   // y2 y3 . .  y6 y7 . .
    return {first_pairs(even01, even23), first_pairs(odd01, odd23), second_pairs(even01, even23)};
  }
  static Row gather(const double* columns, const std::uint32_t* offset) noexcept {
    return _mm512_set_pd(columns[offset[7]], columns[offset[6]], columns[offset[5]],
                         columns[offset[4]], columns[offset[3]], columns[offset[2]],
                         columns[offset[1]], columns[offset[0]]);
  }
  static void add_pair(double* force_a, double* force_b, Column tension) noexcept {
    store_column(force_a, load_column(force_a) + tension);
    store_column(force_b, load_column(force_b) - tension);
  }
};

static_assert(SimdLanes<Avx512Lanes>);

}  // namespace

}  // namespace cordis::engine
