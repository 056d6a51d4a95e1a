// sim_node/engine/pair_kernel.cpp
#include "sim_node/engine/pair_kernel.h"

namespace cordis::engine {

const PairKernel& pair_kernel(VectorWidth width) noexcept {
  switch (width) {
    case VectorWidth::kAvx512:
      return kPairKernelAvx512;
    case VectorWidth::kAvx2:
      return kPairKernelAvx2;
    case VectorWidth::kSse2:
      break;
  }
  return kPairKernelSse2;
}

}  // namespace cordis::engine
