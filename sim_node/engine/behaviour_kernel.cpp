// sim_node/engine/behaviour_kernel.cpp
#include "sim_node/engine/behaviour_kernel.h"

namespace cordis::engine {

const BehaviourKernel& behaviour_kernel(VectorWidth width) noexcept {
  switch (width) {
    case VectorWidth::kAvx512:
      return kBehaviourKernelAvx512;
    case VectorWidth::kAvx2:
      return kBehaviourKernelAvx2;
    case VectorWidth::kSse2:
      break;
  }
  return kBehaviourKernelSse2;
}

}  // namespace cordis::engine
