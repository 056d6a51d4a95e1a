// sim_node/engine/matter/step_kernel_avx2.cpp -- four links in a register. Compiled with -mavx2,
// without FMA.
#include "sim_node/engine/matter/step_kernel_body.h"
#include "sim_node/engine/simd/lanes_avx2.h"
#include "sim_node/engine/simd/modal_kernel_body.h"

namespace cordis::engine {

const StepKernel kStepKernelAvx2 = make_step_kernel<Avx2Lanes>();
const ModalKernel kModalKernelAvx2 = make_modal_kernel<Avx2Lanes>();

}  // namespace cordis::engine
