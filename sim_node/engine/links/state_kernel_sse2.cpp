// sim_node/engine/links/state_kernel_sse2.cpp -- two rows in a register: runs on every x86-64
// processor.
#include "sim_node/engine/links/link_kernels_body.h"
#include "sim_node/engine/simd/lanes_sse2.h"

namespace cordis::engine {

const StateKernel kStateKernelSse2 = make_state_kernel<Sse2Lanes>();

}  // namespace cordis::engine
