// sim_node/scene/scene.cpp
#include "sim_node/scene/scene.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/scene/liaisons/liaison.h"
#include "sim_node/scene/naming.h"

namespace cordis::scene {

namespace {

engine::LiaisonKind kind_of(LinkKind kind) {
  constexpr std::array<engine::LiaisonKind, kLinkKindCount> kKinds{
      engine::LiaisonKind::kLink, engine::LiaisonKind::kStateLink,
      engine::LiaisonKind::kMaxwellLink, engine::LiaisonKind::kBend};
  return kKinds[static_cast<std::size_t>(kind)];
}

/// The liaison that links or sets are made of; nullptr where there is none.
const Liaison* definition_of(const Scene& scene, engine::LiaisonId id) {
  const auto find = [&scene](const std::string& name) {
    return scene.liaisons ? scene.liaisons->find(name) : nullptr;
  };
  if (id.kind == engine::LiaisonKind::kSet)
    return find(scene.network.state_machines[scene.network.sets[id.index].state_machine].name);
  const auto group = std::ranges::find_if(scene.link_groups, [id](const LinkGroup& each) {
    return kind_of(each.kind) == id.kind && id.index >= each.first &&
           id.index - each.first < each.count;
  });
  return group == scene.link_groups.end() ? nullptr : find(group->liaison);
}

/// "cordis, leapfrog": the integrators that take the scene.
std::string fitting_integrators(const Scene& scene) {
  engine::NetworkDescription network = scene.network;
  std::string words;
  for (const engine::IntegratorKind kind : engine::kIntegrators) {
    network.integrator = kind;
    if (!engine::refusal_of(network))
      words += (words.empty() ? "" : ", ") + std::string(to_string(kind));
  }
  return words;
}

/// Where a liaison stands, and what it is made of.
std::string places_of(const Scene& scene, engine::LiaisonId id, const Called& called) {
  if (called.place.line == 0) return {};
  std::string text = called.name + " stands at " + place_text(called.place);
  if (const Liaison* liaison = definition_of(scene, id))
    text += ", its liaison at " + place_text(liaison->place);
  return text;
}

/// @return whether the integrator takes all that is in the scene
bool check_integrator(const Scene& scene, const config::Place& place, config::Problems& problems) {
  const auto refusal = engine::refusal_of(scene.network);
  if (!refusal) return true;
  std::string owner = "the scene";
  std::string hint;
  if (refusal->liaison) {
    const Called liaison = call_liaison(scene, refusal->liaison);
    owner = liaison.name;
    hint = places_of(scene, *refusal->liaison, liaison);
  }
  const std::string fitting = fitting_integrators(scene);
  if (!fitting.empty())
    hint = "integrators that take the scene: " + fitting + (hint.empty() ? "" : "; " + hint);
  problems.error(place,
                 std::string("the integrator ") + to_string(scene.network.integrator) +
                     " does not take " + refusal->what + ", which " + owner + " has",
                 hint);
  return false;
}

}  // namespace

void check_network(const Scene& scene, const config::Place& integrator, const config::Place& matter,
                   config::Problems& problems) {
  if (scene.network.mass_count() == 0 && scene.ports.empty()) {
    problems.error(matter, "the scene has no mass that can move, and no port");
    return;
  }
  if (!check_integrator(scene, integrator, problems)) return;
  try {
    engine::require_valid(scene.network);
  } catch (const std::invalid_argument& refusal) {
    problems.error(matter, std::string("this cannot be simulated: ") + refusal.what());
  }
}

void set_step(Scene& scene, double rate_hz, engine::IntegratorKind integrator) {
  scene.step_rate_hz = rate_hz;
  scene.network.step = 1.0 / rate_hz;
  scene.network.integrator = integrator;
  scene.rate_is_open = false;
  scene.integrator_is_open = false;
}

void number_links(Scene& scene) {
  const engine::NetworkDescription& network = scene.network;
  const std::array<std::size_t, kLinkKindCount> first{
      0, network.links.size(), network.links.size() + network.state_links.size(),
      scene.link_count()};
  scene.links.clear();
  for (const LinkGroup& group : scene.link_groups) {
    const std::size_t before = first[static_cast<std::size_t>(group.kind)];
    scene.links.push_back(
        {group.name, static_cast<std::uint32_t>(before + group.first), group.count, group.place});
  }
  std::stable_sort(scene.links.begin(), scene.links.end(),
                   [](const NamedRange& a, const NamedRange& b) { return a.first < b.first; });
}

}  // namespace cordis::scene
