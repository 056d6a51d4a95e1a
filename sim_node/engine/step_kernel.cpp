// sim_node/engine/step_kernel.cpp
#include "sim_node/engine/step_kernel.h"

namespace cordis::engine {

const StepKernel& step_kernel(VectorWidth width) noexcept {
  switch (width) {
    case VectorWidth::kAvx512:
      return kStepKernelAvx512;
    case VectorWidth::kAvx2:
      return kStepKernelAvx2;
    case VectorWidth::kSse2:
      break;
  }
  return kStepKernelSse2;
}

}  // namespace cordis::engine
