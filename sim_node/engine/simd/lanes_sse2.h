// sim_node/engine/simd/lanes_sse2.h -- two links in a register: runs on every x86-64 processor.
//
// It stands in an unnamed namespace so that every file that includes it has its own, which the
// linker cannot mix up with another's.
#pragma once

#include <cstddef>
#include <cstdint>

#include <emmintrin.h>

#include "sim_node/engine/simd/simd_lanes.h"

namespace cordis::engine {
namespace {

struct Column {
  __m128d xy;
  __m128d z;  // and the pad

  friend Column operator+(const Column& u, const Column& v) noexcept {
    return {u.xy + v.xy, u.z + v.z};
  }
  friend Column operator-(const Column& u, const Column& v) noexcept {
    return {u.xy - v.xy, u.z - v.z};
  }
  friend Column operator*(const Column& u, const Column& v) noexcept {
    return {u.xy * v.xy, u.z * v.z};
  }
};

struct Sse2Lanes {
  using Row = __m128d;
  using Column = engine::Column;
  struct Row3 {
    Row x;
    Row y;
    Row z;
  };
  static constexpr std::size_t kWidth = 2;

  static Row zero() noexcept { return _mm_setzero_pd(); }
  static Row load(const double* values) noexcept { return _mm_load_pd(values); }
  static void store(double* values, Row v) noexcept { _mm_store_pd(values, v); }
  static Row load_any(const double* values) noexcept { return _mm_loadu_pd(values); }
  static void store_any(double* values, Row v) noexcept { _mm_storeu_pd(values, v); }
  static Row shifted(Row before, Row v) noexcept { return _mm_shuffle_pd(before, v, 0x1); }
  static Row sqrt(Row v) noexcept { return _mm_sqrt_pd(v); }
  static Row every(double value) noexcept { return _mm_set1_pd(value); }
  static Row minimum(Row u, Row v) noexcept { return _mm_min_pd(u, v); }
  static Row maximum(Row u, Row v) noexcept { return _mm_max_pd(u, v); }
  static Row magnitude(Row v) noexcept { return _mm_andnot_pd(_mm_set1_pd(-0.0), v); }

  using Mask = __m128d;
  static Mask less(Row u, Row v) noexcept { return _mm_cmplt_pd(u, v); }
  static Mask less_or_equal(Row u, Row v) noexcept { return _mm_cmple_pd(u, v); }
  static Mask equal(Row u, Row v) noexcept { return _mm_cmpeq_pd(u, v); }
  static Mask not_equal(Row u, Row v) noexcept { return _mm_cmpneq_pd(u, v); }
  static Mask both(Mask m, Mask n) noexcept { return _mm_and_pd(m, n); }
  static Mask either(Mask m, Mask n) noexcept { return _mm_or_pd(m, n); }
  static Row select(Mask m, Row u, Row v) noexcept {
    return _mm_or_pd(_mm_and_pd(m, u), _mm_andnot_pd(m, v));
  }
  static std::uint32_t bits(Mask m) noexcept {
    return static_cast<std::uint32_t>(_mm_movemask_pd(m));
  }
  static Mask mask(std::uint32_t bits) noexcept {
    return _mm_castsi128_pd(_mm_set_epi64x(-static_cast<std::int64_t>(bits >> 1 & 1U),
                                           -static_cast<std::int64_t>(bits & 1U)));
  }

  static Row inverse_or_zero(Row square, Row length) noexcept {
    return _mm_and_pd(_mm_cmpneq_pd(square, zero()), _mm_div_pd(_mm_set1_pd(1.0), length));
  }

  static Row3 difference(const double* columns, const std::uint32_t* a,
                         const std::uint32_t* b) noexcept {
    const Column u = load_column(columns + b[0]) - load_column(columns + a[0]);
    const Column v = load_column(columns + b[1]) - load_column(columns + a[1]);
    return {_mm_unpacklo_pd(u.xy, v.xy), _mm_unpackhi_pd(u.xy, v.xy), _mm_unpacklo_pd(u.z, v.z)};
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
    add_pair(force + a[0], force + b[0],
             {_mm_unpacklo_pd(tension.x, tension.y), _mm_unpacklo_pd(tension.z, zero())});
    add_pair(force + a[1], force + b[1],
             {_mm_unpackhi_pd(tension.x, tension.y), _mm_unpackhi_pd(tension.z, zero())});
  }
  static void add_pairs_1d(double* force, const std::uint32_t* a, const std::uint32_t* b,
                           Row tension) noexcept {
    alignas(16) double lane[kWidth];
    store(lane, tension);
    for (std::size_t i = 0; i < kWidth; ++i) {
      force[a[i]] += lane[i];
      force[b[i]] -= lane[i];
    }
  }

  static Column load_column(const double* values) noexcept {
    return {load(values), load(values + 2)};
  }
  static void store_column(double* values, const Column& v) noexcept {
    store(values, v.xy);
    store(values + 2, v.z);
  }
  static Column broadcast(double value) noexcept {
    return {_mm_set1_pd(value), _mm_set1_pd(value)};
  }
  static Column unite(const Column& u, const Column& v) noexcept {
    return {_mm_or_pd(u.xy, v.xy), _mm_or_pd(u.z, v.z)};
  }
  static bool is_zero(const Column& v) noexcept {
    return _mm_movemask_pd(_mm_cmpneq_pd(_mm_or_pd(v.xy, v.z), zero())) == 0;
  }
  static double sum_column(const Column& v) noexcept {
    alignas(16) double value[4];
    store_column(value, v);
    return value[0] + value[1] + value[2];
  }

 protected:
  static Row gather(const double* columns, const std::uint32_t* offset) noexcept {
    return _mm_loadh_pd(_mm_load_sd(columns + offset[0]), columns + offset[1]);
  }
  static void add_pair(double* force_a, double* force_b, const Column& tension) noexcept {
    store_column(force_a, load_column(force_a) + tension);
    store_column(force_b, load_column(force_b) - tension);
  }
};

static_assert(SimdLanes<Sse2Lanes>);

}  // namespace

}  // namespace cordis::engine
