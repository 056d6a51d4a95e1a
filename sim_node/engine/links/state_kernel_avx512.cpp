// sim_node/engine/links/state_kernel_avx512.cpp -- eight rows in a register. Compiled with
// -mavx512f, without contraction.
#include "sim_node/engine/links/link_kernels_body.h"
#include "sim_node/engine/simd/lanes_avx512.h"

namespace cordis::engine {

const StateKernel kStateKernelAvx512 = make_state_kernel<Avx512Lanes>();

}  // namespace cordis::engine
