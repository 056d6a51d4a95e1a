// sim_node/engine/step_kernel_avx512.cpp -- a batch of 8 in one register. Compiled with -mavx512f,
// without contraction.
#include <immintrin.h>

#include "sim_node/engine/step_kernel_body.h"

namespace cordis::engine {
namespace {

struct Batch {
  __m512d value;

  friend Batch operator+(const Batch& u, const Batch& v) noexcept {
    return {_mm512_add_pd(u.value, v.value)};
  }
  friend Batch operator-(const Batch& u, const Batch& v) noexcept {
    return {_mm512_sub_pd(u.value, v.value)};
  }
  friend Batch operator*(const Batch& u, const Batch& v) noexcept {
    return {_mm512_mul_pd(u.value, v.value)};
  }
};

struct Batch3 {
  Batch x;
  Batch y;
  Batch z;
};

struct Column {
  __m256d value;

  friend Column operator+(const Column& u, const Column& v) noexcept {
    return {_mm256_add_pd(u.value, v.value)};
  }
  friend Column operator-(const Column& u, const Column& v) noexcept {
    return {_mm256_sub_pd(u.value, v.value)};
  }
  friend Column operator*(const Column& u, const Column& v) noexcept {
    return {_mm256_mul_pd(u.value, v.value)};
  }
};

struct Avx512Lanes {
  using Batch = engine::Batch;
  using Batch3 = engine::Batch3;
  using Column = engine::Column;

  static Batch zero() noexcept { return {_mm512_setzero_pd()}; }
  static Batch load(const double* values) noexcept { return {_mm512_load_pd(values)}; }
  static void store(double* values, const Batch& v) noexcept { _mm512_store_pd(values, v.value); }
  static Batch sqrt(const Batch& v) noexcept { return {_mm512_sqrt_pd(v.value)}; }
  static Batch inverse_or_zero(const Batch& square, const Batch& length) noexcept {
    const __mmask8 has_direction =
        _mm512_cmp_pd_mask(square.value, _mm512_setzero_pd(), _CMP_NEQ_UQ);
    return {_mm512_maskz_div_pd(has_direction, _mm512_set1_pd(1.0), length.value)};
  }
  static double sum(const Batch& v) noexcept {
    alignas(64) double lane[kLinkBatch];
    store(lane, v);
    double total = 0.0;
    for (const double value : lane) total += value;
    return total;
  }

  static Batch3 difference(const double* columns, const std::uint32_t* a,
                           const std::uint32_t* b) noexcept {
    const __m512d c04 = two_differences(columns, a, b, 0);
    const __m512d c15 = two_differences(columns, a, b, 1);
    const __m512d c26 = two_differences(columns, a, b, 2);
    const __m512d c37 = two_differences(columns, a, b, 3);
    const __m512d even01 = _mm512_unpacklo_pd(c04, c15);  // x0 x1 z0 z1  x4 x5 z4 z5
    const __m512d even23 = _mm512_unpacklo_pd(c26, c37);  // x2 x3 z2 z3  x6 x7 z6 z7
    const __m512d odd01 = _mm512_unpackhi_pd(c04, c15);   // y0 y1 . .  y4 y5 . .
    const __m512d odd23 = _mm512_unpackhi_pd(c26, c37);   // y2 y3 . .  y6 y7 . .
    const __m512i firsts = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    const __m512i seconds = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    return {{_mm512_permutex2var_pd(even01, firsts, even23)},
            {_mm512_permutex2var_pd(odd01, firsts, odd23)},
            {_mm512_permutex2var_pd(even01, seconds, even23)}};
  }
  static Batch difference_1d(const double* columns, const std::uint32_t* a,
                             const std::uint32_t* b) noexcept {
    return {_mm512_sub_pd(gather(columns, b), gather(columns, a))};
  }
  static void add_pairs(double* force, const std::uint32_t* a, const std::uint32_t* b,
                        const Batch3& pull) noexcept {
    const __m512d none = _mm512_setzero_pd();
    const __m512d even_xy = _mm512_unpacklo_pd(pull.x.value, pull.y.value);  // x0 y0 x2 y2  x4 ..
    const __m512d odd_xy = _mm512_unpackhi_pd(pull.x.value, pull.y.value);   // x1 y1 x3 y3  x5 ..
    const __m512d even_z = _mm512_unpacklo_pd(pull.z.value, none);           // z0 0 z2 0  z4 ..
    const __m512d odd_z = _mm512_unpackhi_pd(pull.z.value, none);            // z1 0 z3 0  z5 ..
    const __m512i firsts = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    const __m512i seconds = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    const __m512d c04 = _mm512_permutex2var_pd(even_xy, firsts, even_z);
    const __m512d c15 = _mm512_permutex2var_pd(odd_xy, firsts, odd_z);
    const __m512d c26 = _mm512_permutex2var_pd(even_xy, seconds, even_z);
    const __m512d c37 = _mm512_permutex2var_pd(odd_xy, seconds, odd_z);
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
                           const Batch& pull) noexcept {
    alignas(64) double lane[kLinkBatch];
    store(lane, pull);
    for (std::size_t i = 0; i < kLinkBatch; ++i) {
      force[a[i]] += lane[i];
      force[b[i]] -= lane[i];
    }
  }

  static Column load_column(const double* values) noexcept { return {_mm256_load_pd(values)}; }
  static void store_column(double* values, const Column& v) noexcept {
    _mm256_store_pd(values, v.value);
  }
  static Column broadcast(double value) noexcept { return {_mm256_set1_pd(value)}; }
  static Column unite(const Column& u, const Column& v) noexcept {
    return {_mm256_or_pd(u.value, v.value)};
  }
  static bool is_zero(const Column& v) noexcept {
    return _mm256_movemask_pd(_mm256_cmp_pd(v.value, _mm256_setzero_pd(), _CMP_NEQ_UQ)) == 0;
  }
  static double sum_column(const Column& v) noexcept {
    alignas(32) double value[4];
    store_column(value, v);
    return value[0] + value[1] + value[2];
  }

 private:
  /// The vectors of links l and l + 4, one above the other.
  static __m512d two_differences(const double* columns, const std::uint32_t* a,
                                 const std::uint32_t* b, std::size_t l) noexcept {
    return _mm512_sub_pd(two_columns(columns + b[l], columns + b[l + 4]),
                         two_columns(columns + a[l], columns + a[l + 4]));
  }
  static __m512d two_columns(const double* low, const double* high) noexcept {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(low)), _mm256_load_pd(high), 1);
  }
  static __m512d gather(const double* columns, const std::uint32_t* offset) noexcept {
    return _mm512_set_pd(columns[offset[7]], columns[offset[6]], columns[offset[5]],
                         columns[offset[4]], columns[offset[3]], columns[offset[2]],
                         columns[offset[1]], columns[offset[0]]);
  }
  static void add_pair(double* force_a, double* force_b, __m256d pull) noexcept {
    _mm256_store_pd(force_a, _mm256_add_pd(_mm256_load_pd(force_a), pull));
    _mm256_store_pd(force_b, _mm256_sub_pd(_mm256_load_pd(force_b), pull));
  }
};

}  // namespace

const StepKernel kStepKernelAvx512 = make_step_kernel<Avx512Lanes>();

}  // namespace cordis::engine
