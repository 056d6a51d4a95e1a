// sim_node/engine/pairs/pair_kernel_sse2.cpp -- two pairs in a register: runs on every x86-64
// processor.
#include "sim_node/engine/pairs/make_pair_kernel.h"
#include "sim_node/engine/simd/pair_lanes_sse2.h"

namespace cordis::engine {

const PairKernel kPairKernelSse2 = make_pair_kernel<Sse2PairLanes>();

}  // namespace cordis::engine
