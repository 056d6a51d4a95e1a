// sim_node/engine/matter/step_kernel_sse2.cpp -- two links in a register: runs on every x86-64
// processor.
#include "sim_node/engine/matter/step_kernel_body.h"
#include "sim_node/engine/simd/lanes_sse2.h"
#include "sim_node/engine/simd/modal_kernel_body.h"

namespace cordis::engine {

const StepKernel kStepKernelSse2 = make_step_kernel<Sse2Lanes>();
const ModalKernel kModalKernelSse2 = make_modal_kernel<Sse2Lanes>();

}  // namespace cordis::engine
