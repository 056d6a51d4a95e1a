// sim_node/engine/links/state_kernel_avx2.cpp -- four rows in a register. Compiled with -mavx2,
// without FMA.
#include "sim_node/engine/links/link_kernels_body.h"
#include "sim_node/engine/simd/lanes_avx2.h"

namespace cordis::engine {

const StateKernel kStateKernelAvx2 = make_state_kernel<Avx2Lanes>();

}  // namespace cordis::engine
