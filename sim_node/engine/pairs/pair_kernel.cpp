// sim_node/engine/pairs/pair_kernel.cpp
#include "sim_node/engine/pairs/pair_kernel.h"

#include "sim_node/engine/simd/kernel_of_width.h"

namespace cordis::engine {

const PairKernel& pair_kernel(VectorWidth width) noexcept {
  return kernel_of_width(width, kPairKernelSse2, kPairKernelAvx2, kPairKernelAvx512);
}

}  // namespace cordis::engine
