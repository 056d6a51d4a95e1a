// sim_node/engine/idle_state.h -- states in which a liaison is as good as absent.
#pragma once

#include <cstdint>

#include "node/assert.h"
#include "sim_node/engine/world.h"

namespace cordis::engine {

/// True if a liaison neither pulls nor pushes in a state, whatever its ends do: apart, broken.
inline bool is_idle(const LinkState& state) noexcept {
  return state.stiffness == 0.0 && state.viscosity == 0.0 && is_none(state.elasticity) &&
         is_none(state.dissipation);
}

/// True if a link with states is idle in its present state. Precondition: the link exists.
inline bool is_idle(const World& world, std::uint32_t state_link) noexcept {
  const NetworkDescription& network = world.network().description();
  CORDIS_ASSERT(state_link < network.state_links.size());
  const StateMachine& state_machine =
      network.state_machines[network.state_links[state_link].state_machine];
  return is_idle(state_machine.states[world.state_of(state_link)]);
}

}  // namespace cordis::engine
