// sim_node/engine/pairs/pair_kernel_avx2.cpp -- four pairs in a register. Compiled with -mavx2,
// without FMA.
#include "sim_node/engine/pairs/make_pair_kernel.h"
#include "sim_node/engine/simd/pair_lanes_avx2.h"

namespace cordis::engine {

const PairKernel kPairKernelAvx2 = make_pair_kernel<Avx2PairLanes>();

}  // namespace cordis::engine
