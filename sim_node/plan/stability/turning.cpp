// sim_node/plan/stability/turning.cpp
#include "sim_node/plan/stability/turning.h"

#include <algorithm>
#include <cstdint>

namespace cordis::plan {
namespace {

using engine::LiaisonId;
using engine::LiaisonKind;
using engine::NetworkDescription;

/// What presses a spring by a quarter of its rest length [J].
double energy_of_turning(double stiffness, double rest_length) noexcept {
  constexpr double kPressed = 0.25;  // of the rest length
  const double way = kPressed * rest_length;
  return 0.5 * stiffness * way * way;
}

/// The largest stiffness of a state that pushes [N/m].
double pushing_stiffness(const engine::StateMachine& state_machine) noexcept {
  double largest = 0.0;
  for (const engine::LinkState& state : state_machine.states) {
    if (state.pushes) largest = std::max(largest, state.stiffness);
  }
  return largest;
}

double mass_of(const NetworkDescription& network, std::uint32_t mat) noexcept {
  const engine::Mat& end = network.mats[mat];
  return end.kind == engine::MatKind::kMass ? end.mass : 0.0;
}

}  // namespace

Turning turning_of(const NetworkDescription& network, const Reach& reach) {
  Turning turning;
  if (network.dimension == 1 || network.integrator == engine::IntegratorKind::kModal)
    return turning;
  double most = 1.0;  // energy of the reach over what a link takes
  const auto consider = [&](const auto& link, double stiffness, LiaisonKind kind,
                            std::uint32_t index) {
    const double energy = energy_of_turning(stiffness, link.rest_length);
    if (!(link.rest_length > 0.0 && energy > 0.0)) return;
    Reach here = reach;
    here.mass_a.high = mass_of(network, link.mat_a);
    here.mass_b.high = mass_of(network, link.mat_b);
    if (here.mass_a.high == 0.0 && here.mass_b.high == 0.0) return;
    turning.energy = std::min(turning.energy, energy);
    const double share = energy_at(here) / energy;
    if (share < most) return;
    most = share;
    turning.liaison = LiaisonId{kind, index};
  };
  std::uint32_t index = 0;
  for (const engine::Link& link : network.links)
    consider(link, link.stiffness, LiaisonKind::kLink, index++);
  index = 0;
  for (const engine::StateLink& link : network.state_links) {
    consider(link, pushing_stiffness(network.state_machines[link.state_machine]),
             LiaisonKind::kStateLink, index++);
  }
  return turning;
}

}  // namespace cordis::plan
