// sim_node/engine/links/link_kernels_body.h -- all loops of links other than linear ones.
#pragma once

#include "sim_node/engine/links/maxwell_kernel_body.h"
#include "sim_node/engine/links/state_link_kernel_body.h"

namespace cordis::engine {

template <class Lanes>
constexpr StateKernel make_state_kernel() noexcept {
  return StateKernel{StateMachineLoop<Lanes>::step,
                     StateMachineLoop<Lanes>::find_tensions,
                     StateLinkLoop<Lanes, Motion1d>::add_forces,
                     StateLinkLoop<Lanes, MotionNd>::add_forces,
                     add_maxwell_forces<Lanes, Increment1d>,
                     add_maxwell_forces<Lanes, IncrementNd>};
}

}  // namespace cordis::engine
