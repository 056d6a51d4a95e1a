// sim_node/plan/reduction/held.cpp
#include "sim_node/plan/reduction/held.h"

namespace cordis::plan {
namespace {

void hold(const engine::Variable& variable, Held& held) {
  if (is_of_one_mat(variable)) held.mats[variable.index] = true;
  if (is_of_one_link(variable) && variable.kind == engine::LinkKind::kLinear) {
    held.links[variable.index] = true;
  }
  if (variable.quantity == engine::VariableKind::kEnergy ||
      variable.quantity == engine::VariableKind::kElasticEnergy) {
    held.energy = true;
  }
}

}  // namespace

Held held_in(const scene::Scene& scene) {
  const engine::NetworkDescription& network = scene.network;
  Held held{std::vector<bool>(network.mats.size()), std::vector<bool>(network.links.size()), false};
  for (std::size_t i = 0; i < network.mats.size(); ++i) {
    held.mats[i] = network.mats[i].kind != engine::MatKind::kMass;
  }
  for (const std::uint32_t mat : network.kept_awake) held.mats[mat] = true;
  for (const engine::Drive& drive : network.drives) held.mats[drive.mat] = true;
  const auto hold_ends = [&held](const auto& links) {
    for (const auto& link : links) held.mats[link.mat_a] = held.mats[link.mat_b] = true;
  };
  hold_ends(network.state_links);
  hold_ends(network.maxwell_links);
  for (const engine::Bend& bend : network.bends) {
    held.mats[bend.mat_a] = held.mats[bend.mat_b] = held.mats[bend.mat_c] = true;
  }
  for (const engine::SetLiaison& set : network.sets) {
    for (const std::uint32_t mat : set.set_p) held.mats[mat] = true;
    for (const std::uint32_t mat : set.set_q) held.mats[mat] = true;
  }
  std::vector<bool> handles(network.mats.size());
  for (const scene::Port& port : scene.ports) {
    held.mats[port.mat] = held.mats[port.tool] = true;
    for (const scene::BodyMass& mass : port.body) held.mats[mass.mat] = true;
    handles[port.mat] = port.mat != port.tool;
  }
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    held.links[l] = handles[network.links[l].mat_a] || handles[network.links[l].mat_b];
  }
  for (const scene::Signal& signal : scene.signals.signals()) {
    for (const std::uint32_t mat : signal.mats) held.mats[mat] = true;
    hold(signal, held);
  }
  for (const engine::Variable& variable : network.variables) hold(variable, held);
  for (const engine::VariableGroup& group : network.groups) {
    if (group.is_of_links && group.kind != engine::LinkKind::kLinear) continue;
    std::vector<bool>& kept = group.is_of_links ? held.links : held.mats;
    for (const std::uint32_t member : group.members) kept[member] = true;
  }
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    if (!held.links[l]) continue;
    held.mats[network.links[l].mat_a] = held.mats[network.links[l].mat_b] = true;
  }
  return held;
}

}  // namespace cordis::plan
