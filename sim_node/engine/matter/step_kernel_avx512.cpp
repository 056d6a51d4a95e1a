// sim_node/engine/matter/step_kernel_avx512.cpp -- eight links in a register. Compiled with
// -mavx512f, without contraction.
#include "sim_node/engine/matter/step_kernel_body.h"
#include "sim_node/engine/simd/lanes_avx512.h"
#include "sim_node/engine/simd/modal_kernel_body.h"

namespace cordis::engine {

const StepKernel kStepKernelAvx512 = make_step_kernel<Avx512Lanes>();
const ModalKernel kModalKernelAvx512 = make_modal_kernel<Avx512Lanes>();

}  // namespace cordis::engine
