// sim_node/engine/simd/lanes_avx2.h -- four links in a register: for files compiled with -mavx2,
// without FMA.
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

struct Avx2Lanes {
  using Row = __m256d;
  using Column = __m256d;
  struct Row3 {
    Row x;
    Row y;
    Row z;
  };
  static constexpr std::size_t kWidth = 4;

  static Row zero() noexcept { return _mm256_setzero_pd(); }
  static Row load(const double* values) noexcept { return _mm256_load_pd(values); }
  static void store(double* values, Row v) noexcept { _mm256_store_pd(values, v); }
  static Row load_any(const double* values) noexcept { return _mm256_loadu_pd(values); }
  static void store_any(double* values, Row v) noexcept { _mm256_storeu_pd(values, v); }
  static Row shifted(Row before, Row v) noexcept {
    return _mm256_shuffle_pd(_mm256_permute2f128_pd(before, v, 0x21), v, 0x5);
  }
  static Row sqrt(Row v) noexcept { return _mm256_sqrt_pd(v); }
  static Row every(double value) noexcept { return _mm256_set1_pd(value); }
  static Row minimum(Row u, Row v) noexcept { return _mm256_min_pd(u, v); }
  static Row maximum(Row u, Row v) noexcept { return _mm256_max_pd(u, v); }
  static Row magnitude(Row v) noexcept { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), v); }

  using Mask = __m256d;
  static Mask less(Row u, Row v) noexcept { return _mm256_cmp_pd(u, v, _CMP_LT_OQ); }
  static Mask less_or_equal(Row u, Row v) noexcept { return _mm256_cmp_pd(u, v, _CMP_LE_OQ); }
  static Mask equal(Row u, Row v) noexcept { return _mm256_cmp_pd(u, v, _CMP_EQ_OQ); }
  static Mask not_equal(Row u, Row v) noexcept { return _mm256_cmp_pd(u, v, _CMP_NEQ_UQ); }
  static Mask both(Mask m, Mask n) noexcept { return _mm256_and_pd(m, n); }
  static Mask either(Mask m, Mask n) noexcept { return _mm256_or_pd(m, n); }
  static Row select(Mask m, Row u, Row v) noexcept { return _mm256_blendv_pd(v, u, m); }
  static std::uint32_t bits(Mask m) noexcept {
    return static_cast<std::uint32_t>(_mm256_movemask_pd(m));
  }
  static Mask mask(std::uint32_t bits) noexcept {
    const __m256i place = _mm256_set_epi64x(8, 4, 2, 1);
    const __m256i chosen = _mm256_and_si256(_mm256_set1_epi64x(bits), place);
    return _mm256_castsi256_pd(_mm256_cmpeq_epi64(chosen, place));
  }

  static Row inverse_or_zero(Row square, Row length) noexcept {
    return _mm256_and_pd(_mm256_cmp_pd(square, zero(), _CMP_NEQ_UQ),
                         _mm256_div_pd(_mm256_set1_pd(1.0), length));
  }

  static Row3 difference(const double* columns, const std::uint32_t* a,
                         const std::uint32_t* b) noexcept {
    const Row c0 = load(columns + b[0]) - load(columns + a[0]);
    const Row c1 = load(columns + b[1]) - load(columns + a[1]);
    const Row c2 = load(columns + b[2]) - load(columns + a[2]);
    const Row c3 = load(columns + b[3]) - load(columns + a[3]);
    const Row even01 = _mm256_unpacklo_pd(c0, c1);  // x0 x1 z0 z1
    const Row even23 = _mm256_unpacklo_pd(c2, c3);  // x2 x3 z2 z3
    const Row odd01 = _mm256_unpackhi_pd(c0, c1);   // y0 y1 and pads
    const Row odd23 = _mm256_unpackhi_pd(c2, c3);   // y2 y3 and pads
    return {_mm256_permute2f128_pd(even01, even23, 0x20),
            _mm256_permute2f128_pd(odd01, odd23, 0x20),
            _mm256_permute2f128_pd(even01, even23, 0x31)};
  }
  static void differences(const double* columns_u, const double* columns_v, const std::uint32_t* a,
                          const std::uint32_t* b, Row3& u, Row3& v) noexcept {
    u = difference(columns_u, a, b);
    v = difference(columns_v, a, b);
  }
  static Row difference_1d(const double* columns, const std::uint32_t* a,
                           const std::uint32_t* b) noexcept {
    return gather(columns, b) - gather(columns, a);
  }

  static void add_pairs(double* force, const std::uint32_t* a, const std::uint32_t* b,
                        const Row3& tension) noexcept {
    const Row even_xy = _mm256_unpacklo_pd(tension.x, tension.y);  // x0 y0 x2 y2
    const Row odd_xy = _mm256_unpackhi_pd(tension.x, tension.y);   // x1 y1 x3 y3
    const Row even_z = _mm256_unpacklo_pd(tension.z, zero());      // z0 0 z2 0
    const Row odd_z = _mm256_unpackhi_pd(tension.z, zero());       // z1 0 z3 0
    add_pair(force + a[0], force + b[0], _mm256_permute2f128_pd(even_xy, even_z, 0x20));
    add_pair(force + a[1], force + b[1], _mm256_permute2f128_pd(odd_xy, odd_z, 0x20));
    add_pair(force + a[2], force + b[2], _mm256_permute2f128_pd(even_xy, even_z, 0x31));
    add_pair(force + a[3], force + b[3], _mm256_permute2f128_pd(odd_xy, odd_z, 0x31));
  }
  static void add_pairs_1d(double* force, const std::uint32_t* a, const std::uint32_t* b,
                           Row tension) noexcept {
    alignas(32) double lane[kWidth];
    store(lane, tension);
    for (std::size_t i = 0; i < kWidth; ++i) {
      force[a[i]] += lane[i];
      force[b[i]] -= lane[i];
    }
  }

  static Column load_column(const double* values) noexcept { return load(values); }
  static void store_column(double* values, Column v) noexcept { store(values, v); }
  static Column broadcast(double value) noexcept { return _mm256_set1_pd(value); }
  static Column unite(Column u, Column v) noexcept { return _mm256_or_pd(u, v); }
  static bool is_zero(Column v) noexcept {
    return _mm256_movemask_pd(_mm256_cmp_pd(v, zero(), _CMP_NEQ_UQ)) == 0;
  }
  static double sum_column(Column v) noexcept {
    alignas(32) double value[4];
    store_column(value, v);
    return value[0] + value[1] + value[2];
  }

 protected:
  static Row gather(const double* columns, const std::uint32_t* offset) noexcept {
    return _mm256_set_pd(columns[offset[3]], columns[offset[2]], columns[offset[1]],
                         columns[offset[0]]);
  }
  static void add_pair(double* force_a, double* force_b, Column tension) noexcept {
    store_column(force_a, load_column(force_a) + tension);
    store_column(force_b, load_column(force_b) - tension);
  }
};

static_assert(SimdLanes<Avx2Lanes>);

}  // namespace

}  // namespace cordis::engine
