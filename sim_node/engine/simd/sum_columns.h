// sim_node/engine/simd/sum_columns.h -- sums of lanes as columns: for files compiled with AVX.
//
// It stands in an unnamed namespace, as lanes_avx2.h does.
#pragma once

#include <immintrin.h>

namespace cordis::engine {
namespace {

/// The column of the sums (0 + 2) + (1 + 3) of the lanes of x, y, z and w.
inline __m256d sum_columns(__m256d x, __m256d y, __m256d z, __m256d w) noexcept {
  const __m256d even_xy = _mm256_unpacklo_pd(x, y);  // x0 y0 x2 y2
  const __m256d odd_xy = _mm256_unpackhi_pd(x, y);   // x1 y1 x3 y3
  const __m256d even_zw = _mm256_unpacklo_pd(z, w);
  const __m256d odd_zw = _mm256_unpackhi_pd(z, w);
  return (_mm256_permute2f128_pd(even_xy, even_zw, 0x20) +
          _mm256_permute2f128_pd(even_xy, even_zw, 0x31)) +
         (_mm256_permute2f128_pd(odd_xy, odd_zw, 0x20) +
          _mm256_permute2f128_pd(odd_xy, odd_zw, 0x31));
}

}  // namespace
}  // namespace cordis::engine
