// sim_node/engine/simd/kernel_of_width.h -- which of three kernels a vector width means.
#pragma once

#include "sim_node/engine/core/vector_width.h"

namespace cordis::engine {

template <class Kernel>
const Kernel& kernel_of_width(VectorWidth width, const Kernel& sse2, const Kernel& avx2,
                              const Kernel& avx512) noexcept {
  switch (width) {
    case VectorWidth::kAvx512:
      return avx512;
    case VectorWidth::kAvx2:
      return avx2;
    case VectorWidth::kSse2:
      break;
  }
  return sse2;
}

}  // namespace cordis::engine
