// sim_node/engine/links/behaviour_kernel_avx512.cpp -- eight rows in a register. Compiled with -mavx512f,
// without contraction.
#include "sim_node/engine/simd/lanes_avx512.h"
#include "sim_node/engine/links/link_kernels_body.h"

namespace cordis::engine {

const BehaviourKernel kBehaviourKernelAvx512 = make_behaviour_kernel<Avx512Lanes>();

}  // namespace cordis::engine
