// sim_node/engine/links/link_kernels_body.h -- all loops of links other than linear ones.
#pragma once

#include "sim_node/engine/links/maxwell_kernel_body.h"
#include "sim_node/engine/links/state_link_kernel_body.h"

namespace cordis::engine {

template <class Lanes>
constexpr StateKernel make_state_kernel() noexcept {
  return StateKernel{StateMachineLoop<Lanes>::step,
                     StateMachineLoop<Lanes>::find_pulls,
                     StateLinkLoop<Lanes, MotionInLine>::add_forces,
                     StateLinkLoop<Lanes, MotionInSpace>::add_forces,
                     add_maxwell_forces<Lanes, GrowthInLine>,
                     add_maxwell_forces<Lanes, GrowthInSpace>};
}

}  // namespace cordis::engine
