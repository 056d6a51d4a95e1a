// sim_node/engine/step_kernel_sse2.cpp -- a batch of 8 in four registers of 2: runs on every x86-64
// processor.
#include <emmintrin.h>

#include "sim_node/engine/step_kernel_body.h"

namespace cordis::engine {
namespace {

constexpr std::size_t kQuarters = 4;

struct Batch {
  __m128d quarter[kQuarters];  // lanes 2 q and 2 q + 1

  friend Batch operator+(const Batch& u, const Batch& v) noexcept {
    Batch w;
    for (std::size_t q = 0; q < kQuarters; ++q)
      w.quarter[q] = _mm_add_pd(u.quarter[q], v.quarter[q]);
    return w;
  }
  friend Batch operator-(const Batch& u, const Batch& v) noexcept {
    Batch w;
    for (std::size_t q = 0; q < kQuarters; ++q)
      w.quarter[q] = _mm_sub_pd(u.quarter[q], v.quarter[q]);
    return w;
  }
  friend Batch operator*(const Batch& u, const Batch& v) noexcept {
    Batch w;
    for (std::size_t q = 0; q < kQuarters; ++q)
      w.quarter[q] = _mm_mul_pd(u.quarter[q], v.quarter[q]);
    return w;
  }
};

struct Batch3 {
  Batch x;
  Batch y;
  Batch z;
};

struct Column {
  __m128d xy;
  __m128d z;  // and the pad

  friend Column operator+(const Column& u, const Column& v) noexcept {
    return {_mm_add_pd(u.xy, v.xy), _mm_add_pd(u.z, v.z)};
  }
  friend Column operator-(const Column& u, const Column& v) noexcept {
    return {_mm_sub_pd(u.xy, v.xy), _mm_sub_pd(u.z, v.z)};
  }
  friend Column operator*(const Column& u, const Column& v) noexcept {
    return {_mm_mul_pd(u.xy, v.xy), _mm_mul_pd(u.z, v.z)};
  }
};

struct Sse2Lanes {
  using Batch = engine::Batch;
  using Batch3 = engine::Batch3;
  using Column = engine::Column;

  static Batch zero() noexcept {
    const __m128d none = _mm_setzero_pd();
    return {{none, none, none, none}};
  }
  static Batch load(const double* values) noexcept {
    Batch w;
    for (std::size_t q = 0; q < kQuarters; ++q) w.quarter[q] = _mm_load_pd(values + 2 * q);
    return w;
  }
  static void store(double* values, const Batch& v) noexcept {
    for (std::size_t q = 0; q < kQuarters; ++q) _mm_store_pd(values + 2 * q, v.quarter[q]);
  }
  static Batch sqrt(const Batch& v) noexcept {
    Batch w;
    for (std::size_t q = 0; q < kQuarters; ++q) w.quarter[q] = _mm_sqrt_pd(v.quarter[q]);
    return w;
  }
  static Batch inverse_or_zero(const Batch& square, const Batch& length) noexcept {
    const __m128d one = _mm_set1_pd(1.0);
    const __m128d none = _mm_setzero_pd();
    Batch w;
    for (std::size_t q = 0; q < kQuarters; ++q) {
      w.quarter[q] =
          _mm_and_pd(_mm_cmpneq_pd(square.quarter[q], none), _mm_div_pd(one, length.quarter[q]));
    }
    return w;
  }
  static double sum(const Batch& v) noexcept {
    alignas(16) double lane[kLinkBatch];
    store(lane, v);
    double total = 0.0;
    for (const double value : lane) total += value;
    return total;
  }

  static Batch3 difference(const double* columns, const std::uint32_t* a,
                           const std::uint32_t* b) noexcept {
    Batch3 w;
    for (std::size_t q = 0; q < kQuarters; ++q) {
      const Column u = load_column(columns + b[2 * q]) - load_column(columns + a[2 * q]);
      const Column v = load_column(columns + b[2 * q + 1]) - load_column(columns + a[2 * q + 1]);
      w.x.quarter[q] = _mm_unpacklo_pd(u.xy, v.xy);
      w.y.quarter[q] = _mm_unpackhi_pd(u.xy, v.xy);
      w.z.quarter[q] = _mm_unpacklo_pd(u.z, v.z);
    }
    return w;
  }
  static Batch difference_1d(const double* columns, const std::uint32_t* a,
                             const std::uint32_t* b) noexcept {
    Batch w;
    for (std::size_t q = 0; q < kQuarters; ++q) {
      w.quarter[q] =
          _mm_sub_pd(_mm_loadh_pd(_mm_load_sd(columns + b[2 * q]), columns + b[2 * q + 1]),
                     _mm_loadh_pd(_mm_load_sd(columns + a[2 * q]), columns + a[2 * q + 1]));
    }
    return w;
  }
  static void add_pairs(double* force, const std::uint32_t* a, const std::uint32_t* b,
                        const Batch3& pull) noexcept {
    const __m128d none = _mm_setzero_pd();
    for (std::size_t q = 0; q < kQuarters; ++q) {
      const __m128d x = pull.x.quarter[q];
      const __m128d y = pull.y.quarter[q];
      const __m128d z = pull.z.quarter[q];
      add_pair(force + a[2 * q], force + b[2 * q],
               {_mm_unpacklo_pd(x, y), _mm_unpacklo_pd(z, none)});
      add_pair(force + a[2 * q + 1], force + b[2 * q + 1],
               {_mm_unpackhi_pd(x, y), _mm_unpackhi_pd(z, none)});
    }
  }
  static void add_pairs_1d(double* force, const std::uint32_t* a, const std::uint32_t* b,
                           const Batch& pull) noexcept {
    alignas(16) double lane[kLinkBatch];
    store(lane, pull);
    for (std::size_t i = 0; i < kLinkBatch; ++i) {
      force[a[i]] += lane[i];
      force[b[i]] -= lane[i];
    }
  }

  static Column load_column(const double* values) noexcept {
    return {_mm_load_pd(values), _mm_load_pd(values + 2)};
  }
  static void store_column(double* values, const Column& v) noexcept {
    _mm_store_pd(values, v.xy);
    _mm_store_pd(values + 2, v.z);
  }
  static Column broadcast(double value) noexcept {
    return {_mm_set1_pd(value), _mm_set1_pd(value)};
  }
  static Column unite(const Column& u, const Column& v) noexcept {
    return {_mm_or_pd(u.xy, v.xy), _mm_or_pd(u.z, v.z)};
  }
  static bool is_zero(const Column& v) noexcept {
    return _mm_movemask_pd(_mm_cmpneq_pd(_mm_or_pd(v.xy, v.z), _mm_setzero_pd())) == 0;
  }
  static double sum_column(const Column& v) noexcept {
    alignas(16) double value[4];
    store_column(value, v);
    return value[0] + value[1] + value[2];
  }

 private:
  static void add_pair(double* force_a, double* force_b, const Column& pull) noexcept {
    store_column(force_a, load_column(force_a) + pull);
    store_column(force_b, load_column(force_b) - pull);
  }
};

}  // namespace

const StepKernel kStepKernelSse2 = make_step_kernel<Sse2Lanes>();

}  // namespace cordis::engine
