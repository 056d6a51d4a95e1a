// sim_node/engine/links/behaviour_kernel_avx2.cpp -- four rows in a register. Compiled with -mavx2,
// without FMA.
#include "sim_node/engine/simd/lanes_avx2.h"
#include "sim_node/engine/links/link_kernels_body.h"

namespace cordis::engine {

const BehaviourKernel kBehaviourKernelAvx2 = make_behaviour_kernel<Avx2Lanes>();

}  // namespace cordis::engine
