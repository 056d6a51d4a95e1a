// sim_node/engine/description/partner_share.cpp
#include "sim_node/engine/description/partner_share.h"

#include <algorithm>
#include <cmath>

#include "sim_node/engine/description/network.h"

namespace cordis::engine {

PartnerShare partner_share(const NetworkDescription& network, const SetLiaison& set) noexcept {
  const StateMachine& state_machine = network.state_machines[set.state_machine];
  const LinkState& state = state_machine.states.front();
  const auto* rings = std::get_if<Rings>(&state.elasticity);
  const bool is_plain = state_machine.is_stateless() && is_none(state.dissipation) &&
                        !rubs(state_machine) && network.integrator == IntegratorKind::kCordis;
  if (rings == nullptr || !is_plain) return {};
  const bool turns = network.dimension > 1;
  const double core = rings->slope_beyond(0.0, turns);
  PartnerShare share;
  double softer = core;
  for (const Ring& ring : rings->rings) {
    constexpr double kSofter = 0.5;
    const double beyond = rings->slope_beyond(ring.radius, turns);
    if (!(beyond < kSofter * core) || !(ring.radius < share.near)) continue;
    share.near = ring.radius;
    softer = beyond;
  }
  const auto number = [&](double slope) {
    return network.step * (state.stiffness + slope) + 2.0 * state.viscosity;
  };
  constexpr double kParts = 64.0;
  const double part = number(softer) / number(core);
  share.beyond = part < 1.0 ? std::ceil(kParts * part) / kParts : 1.0;
  return share;
}

}  // namespace cordis::engine
