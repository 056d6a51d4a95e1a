// sim_node/engine/links/state_kernel.cpp
#include "sim_node/engine/links/state_kernel.h"

#include "sim_node/engine/simd/kernel_of_width.h"

namespace cordis::engine {

const StateKernel& state_kernel(VectorWidth width) noexcept {
  return kernel_of_width(width, kStateKernelSse2, kStateKernelAvx2, kStateKernelAvx512);
}

}  // namespace cordis::engine
