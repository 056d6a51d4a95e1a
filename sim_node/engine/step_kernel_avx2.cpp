// sim_node/engine/step_kernel_avx2.cpp -- a batch of 8 in two registers of 4. Compiled with -mavx2,
// without FMA.
#include <immintrin.h>

#include "sim_node/engine/step_kernel_body.h"

namespace cordis::engine {
namespace {

struct Batch {
  __m256d low;   // lanes 0 to 3
  __m256d high;  // lanes 4 to 7

  friend Batch operator+(const Batch& u, const Batch& v) noexcept {
    return {_mm256_add_pd(u.low, v.low), _mm256_add_pd(u.high, v.high)};
  }
  friend Batch operator-(const Batch& u, const Batch& v) noexcept {
    return {_mm256_sub_pd(u.low, v.low), _mm256_sub_pd(u.high, v.high)};
  }
  friend Batch operator*(const Batch& u, const Batch& v) noexcept {
    return {_mm256_mul_pd(u.low, v.low), _mm256_mul_pd(u.high, v.high)};
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

struct Half3 {  // the vectors of 4 links
  __m256d x;
  __m256d y;
  __m256d z;
};

struct Avx2Lanes {
  using Batch = engine::Batch;
  using Batch3 = engine::Batch3;
  using Column = engine::Column;

  static Batch zero() noexcept { return {_mm256_setzero_pd(), _mm256_setzero_pd()}; }
  static Batch load(const double* values) noexcept {
    return {_mm256_load_pd(values), _mm256_load_pd(values + 4)};
  }
  static void store(double* values, const Batch& v) noexcept {
    _mm256_store_pd(values, v.low);
    _mm256_store_pd(values + 4, v.high);
  }
  static Batch sqrt(const Batch& v) noexcept {
    return {_mm256_sqrt_pd(v.low), _mm256_sqrt_pd(v.high)};
  }
  static Batch inverse_or_zero(const Batch& square, const Batch& length) noexcept {
    return {inverse_or_zero(square.low, length.low), inverse_or_zero(square.high, length.high)};
  }
  static double sum(const Batch& v) noexcept {
    alignas(32) double lane[kLinkBatch];
    store(lane, v);
    double total = 0.0;
    for (const double value : lane) total += value;
    return total;
  }

  static Batch3 difference(const double* columns, const std::uint32_t* a,
                           const std::uint32_t* b) noexcept {
    const Half3 low = half_difference(columns, a, b);
    const Half3 high = half_difference(columns, a + 4, b + 4);
    return {{low.x, high.x}, {low.y, high.y}, {low.z, high.z}};
  }
  static Batch difference_1d(const double* columns, const std::uint32_t* a,
                             const std::uint32_t* b) noexcept {
    return {_mm256_sub_pd(gather(columns, b), gather(columns, a)),
            _mm256_sub_pd(gather(columns, b + 4), gather(columns, a + 4))};
  }
  static void add_pairs(double* force, const std::uint32_t* a, const std::uint32_t* b,
                        const Batch3& pull) noexcept {
    add_half(force, a, b, {pull.x.low, pull.y.low, pull.z.low});
    add_half(force, a + 4, b + 4, {pull.x.high, pull.y.high, pull.z.high});
  }
  static void add_pairs_1d(double* force, const std::uint32_t* a, const std::uint32_t* b,
                           const Batch& pull) noexcept {
    alignas(32) double lane[kLinkBatch];
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
  static __m256d inverse_or_zero(__m256d square, __m256d length) noexcept {
    return _mm256_and_pd(_mm256_cmp_pd(square, _mm256_setzero_pd(), _CMP_NEQ_UQ),
                         _mm256_div_pd(_mm256_set1_pd(1.0), length));
  }
  static __m256d gather(const double* columns, const std::uint32_t* offset) noexcept {
    return _mm256_set_pd(columns[offset[3]], columns[offset[2]], columns[offset[1]],
                         columns[offset[0]]);
  }
  static Half3 half_difference(const double* columns, const std::uint32_t* a,
                               const std::uint32_t* b) noexcept {
    const __m256d c0 =
        _mm256_sub_pd(_mm256_load_pd(columns + b[0]), _mm256_load_pd(columns + a[0]));
    const __m256d c1 =
        _mm256_sub_pd(_mm256_load_pd(columns + b[1]), _mm256_load_pd(columns + a[1]));
    const __m256d c2 =
        _mm256_sub_pd(_mm256_load_pd(columns + b[2]), _mm256_load_pd(columns + a[2]));
    const __m256d c3 =
        _mm256_sub_pd(_mm256_load_pd(columns + b[3]), _mm256_load_pd(columns + a[3]));
    const __m256d even01 = _mm256_unpacklo_pd(c0, c1);  // x0 x1 z0 z1
    const __m256d even23 = _mm256_unpacklo_pd(c2, c3);  // x2 x3 z2 z3
    const __m256d odd01 = _mm256_unpackhi_pd(c0, c1);   // y0 y1 and pads
    const __m256d odd23 = _mm256_unpackhi_pd(c2, c3);   // y2 y3 and pads
    return {_mm256_permute2f128_pd(even01, even23, 0x20),
            _mm256_permute2f128_pd(odd01, odd23, 0x20),
            _mm256_permute2f128_pd(even01, even23, 0x31)};
  }
  static void add_half(double* force, const std::uint32_t* a, const std::uint32_t* b,
                       const Half3& pull) noexcept {
    const __m256d none = _mm256_setzero_pd();
    const __m256d even_xy = _mm256_unpacklo_pd(pull.x, pull.y);  // x0 y0 x2 y2
    const __m256d odd_xy = _mm256_unpackhi_pd(pull.x, pull.y);   // x1 y1 x3 y3
    const __m256d even_z = _mm256_unpacklo_pd(pull.z, none);     // z0 0 z2 0
    const __m256d odd_z = _mm256_unpackhi_pd(pull.z, none);      // z1 0 z3 0
    add_pair(force + a[0], force + b[0], _mm256_permute2f128_pd(even_xy, even_z, 0x20));
    add_pair(force + a[1], force + b[1], _mm256_permute2f128_pd(odd_xy, odd_z, 0x20));
    add_pair(force + a[2], force + b[2], _mm256_permute2f128_pd(even_xy, even_z, 0x31));
    add_pair(force + a[3], force + b[3], _mm256_permute2f128_pd(odd_xy, odd_z, 0x31));
  }
  static void add_pair(double* force_a, double* force_b, __m256d pull) noexcept {
    _mm256_store_pd(force_a, _mm256_add_pd(_mm256_load_pd(force_a), pull));
    _mm256_store_pd(force_b, _mm256_sub_pd(_mm256_load_pd(force_b), pull));
  }
};

}  // namespace

const StepKernel kStepKernelAvx2 = make_step_kernel<Avx2Lanes>();

}  // namespace cordis::engine
