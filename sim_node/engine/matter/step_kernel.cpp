// sim_node/engine/matter/step_kernel.cpp
#include "sim_node/engine/matter/step_kernel.h"

#include "sim_node/engine/simd/kernel_of_width.h"

namespace cordis::engine {

const StepKernel& step_kernel(VectorWidth width) noexcept {
  return kernel_of_width(width, kStepKernelSse2, kStepKernelAvx2, kStepKernelAvx512);
}

}  // namespace cordis::engine
