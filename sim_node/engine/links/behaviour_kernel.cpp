// sim_node/engine/links/behaviour_kernel.cpp
#include "sim_node/engine/links/behaviour_kernel.h"

#include "sim_node/engine/simd/kernel_of_width.h"

namespace cordis::engine {

const BehaviourKernel& behaviour_kernel(VectorWidth width) noexcept {
  return kernel_of_width(width, kBehaviourKernelSse2, kBehaviourKernelAvx2, kBehaviourKernelAvx512);
}

}  // namespace cordis::engine
