// sim_node/engine/simd/pair_lanes_sse2.h -- what pairs need beyond lanes_sse2.h.
#pragma once

#include "sim_node/engine/simd/lanes_sse2.h"

namespace cordis::engine {
namespace {

struct Sse2PairLanes : Sse2Lanes {
  static Row3 vectors(const double* columns, const std::uint32_t* offset) noexcept {
    const Column u = load_column(columns + offset[0]);
    const Column v = load_column(columns + offset[1]);
    return transposed(u, v);
  }
  static Row3 neighbours(const double* columns) noexcept {
    return transposed(load_column(columns), load_column(columns + 4));
  }
  static void subtract(double* columns, const std::uint32_t* offset, const Row3& v,
                       Row w) noexcept {
    const Column first{_mm_unpacklo_pd(v.x, v.y), _mm_unpacklo_pd(v.z, w)};
    const Column second{_mm_unpackhi_pd(v.x, v.y), _mm_unpackhi_pd(v.z, w)};
    store_column(columns + offset[0], load_column(columns + offset[0]) - first);
    store_column(columns + offset[1], load_column(columns + offset[1]) - second);
  }
  static void subtract_from_neighbours(double* columns, const Row3& v) noexcept {
    constexpr std::uint32_t kOffsets[kWidth] = {0, 4};
    subtract(columns, kOffsets, v, zero());
  }
  static void copy_neighbours(double* columns, const double* from) noexcept {
    for (std::size_t i = 0; i < 4 * kWidth; i += kWidth) store(columns + i, load(from + i));
  }
  static void store_columns(double* columns, const Row3& v, Row w) noexcept {
    store_column(columns, {_mm_unpacklo_pd(v.x, v.y), _mm_unpacklo_pd(v.z, w)});
    store_column(columns + 4, {_mm_unpackhi_pd(v.x, v.y), _mm_unpackhi_pd(v.z, w)});
  }

  static Column sum_batch(const Row* x, const Row* y, const Row* z, const Row* w) noexcept {
    return {sum_lanes(quarters(x), quarters(y)), sum_lanes(quarters(z), quarters(w))};
  }

  static void pack(double* out, Row v, unsigned chosen) noexcept {
    _mm_storeu_pd(out, chosen == 2U ? _mm_unpackhi_pd(v, v) : v);
  }
  static void pack(std::uint32_t* out, const std::uint32_t* in, unsigned chosen) noexcept {
    out[0] = chosen == 2U ? in[1] : in[0];
    out[1] = in[1];
  }

 private:
  /// Lanes (0 + 4) + (2 + 6) and (1 + 5) + (3 + 7) of a batch.
  static Row quarters(const Row* parts) noexcept {
    return (parts[0] + parts[2]) + (parts[1] + parts[3]);
  }
  /// Lane 0 + lane 1 of u, and of v.
  static Row sum_lanes(Row u, Row v) noexcept {
    return _mm_unpacklo_pd(u, v) + _mm_unpackhi_pd(u, v);
  }
  static Row3 transposed(const Column& u, const Column& v) noexcept {
    return {_mm_unpacklo_pd(u.xy, v.xy), _mm_unpackhi_pd(u.xy, v.xy), _mm_unpacklo_pd(u.z, v.z)};
  }
};

static_assert(SimdPairLanes<Sse2PairLanes>);

}  // namespace
}  // namespace cordis::engine
