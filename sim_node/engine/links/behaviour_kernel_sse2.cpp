// sim_node/engine/links/behaviour_kernel_sse2.cpp -- two rows in a register: runs on every x86-64
// processor.
#include "sim_node/engine/simd/lanes_sse2.h"
#include "sim_node/engine/links/link_kernels_body.h"

namespace cordis::engine {

const BehaviourKernel kBehaviourKernelSse2 = make_behaviour_kernel<Sse2Lanes>();

}  // namespace cordis::engine
