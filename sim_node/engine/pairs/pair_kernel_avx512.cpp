// sim_node/engine/pairs/pair_kernel_avx512.cpp -- eight pairs in a register. Compiled with
// -mavx512f, without contraction.
#include "sim_node/engine/pairs/make_pair_kernel.h"
#include "sim_node/engine/simd/pair_lanes_avx512.h"

namespace cordis::engine {

const PairKernel kPairKernelAvx512 = make_pair_kernel<Avx512PairLanes>();

}  // namespace cordis::engine
