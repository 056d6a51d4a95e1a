// sim_node/scene/naming.cpp
#include "sim_node/scene/naming.h"

namespace cordis::scene {
namespace {

Called call(const std::vector<NamedRange>& ranges, std::uint32_t index, const char* kind) {
  for (const NamedRange& range : ranges) {
    if (index < range.first || index - range.first >= range.count) continue;
    const bool single = range.count == 1;
    return {single ? range.name : range.name + "[" + std::to_string(index - range.first) + "]",
            range.place};
  }
  return {std::string(kind) + " " + std::to_string(index), {}};
}

}  // namespace

Called call_mat(const Scene& scene, std::uint32_t mat) {
  return call(scene.matter, mat, "MAT");
}

Called call_liaison(const Scene& scene, std::optional<engine::LiaisonId> liaison) {
  if (!liaison) return {"the viscosity of the medium", {}};
  const engine::NetworkDescription& network = scene.network;
  const std::uint32_t index = liaison->index;
  const auto of_behaviour = [&](std::uint32_t behaviour, const std::string& where) {
    return Called{"liaison '" + network.behaviours[behaviour].name + "' " + where, {}};
  };
  switch (liaison->kind) {
    case engine::LiaisonKind::kLink:
      return call(scene.links, index, "link");
    case engine::LiaisonKind::kStateLink: {
      const engine::StateLink& link = network.state_links[index];
      return of_behaviour(link.behaviour, "between " + call_mat(scene, link.mat_a).name + " and " +
                                              call_mat(scene, link.mat_b).name);
    }
    case engine::LiaisonKind::kMaxwellLink: {
      const engine::MaxwellLink& link = network.maxwell_links[index];
      return {"the Maxwell element between " + call_mat(scene, link.mat_a).name + " and " +
                  call_mat(scene, link.mat_b).name,
              {}};
    }
    case engine::LiaisonKind::kSet:
      return of_behaviour(network.sets[index].behaviour, "of sets");
  }
  return {};
}

std::string place_text(const config::Place& place) {
  return place.line > 0 ? place.file + ":" + std::to_string(place.line) : place.file;
}

}  // namespace cordis::scene
