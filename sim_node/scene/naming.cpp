// sim_node/scene/naming.cpp
#include "sim_node/scene/naming.h"

#include "node/config/count_text.h"

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
  constexpr const char* kMedium = "the viscosity of the medium";
  if (!liaison) return {kMedium, {}};
  const engine::NetworkDescription& network = scene.network;
  const auto linear = static_cast<std::uint32_t>(network.links.size());
  const auto with_states = static_cast<std::uint32_t>(network.state_links.size());
  const std::uint32_t index = liaison->index;
  switch (liaison->kind) {
    case engine::LiaisonKind::kLink:
      return call(scene.links, index, "link");
    case engine::LiaisonKind::kStateLink:
      return call(scene.links, linear + index, "link");
    case engine::LiaisonKind::kMaxwellLink:
      return call(scene.links, linear + with_states + index, "link");
    case engine::LiaisonKind::kSet:
      return {scene.set_names[index] + " of sets", scene.set_places[index]};
    case engine::LiaisonKind::kBend:
      return call(scene.bends, index, "bend");
    case engine::LiaisonKind::kForce: {
      const engine::Drive& drive = network.drives[index];
      if (drive.function == scene.gravity_function) return {"the gravity of the world", {}};
      if (drive.function == scene.medium_function) return {kMedium, {}};
      const Called mat = call_mat(scene, drive.mat);
      return {"the force on " + mat.name, mat.place};
    }
  }
  return {};
}

std::string size_text(const Scene& scene) {
  const engine::NetworkDescription& network = scene.network;
  const std::string bends =
      network.bends.empty() ? "" : config::count_text(network.bends.size(), "bend") + ", ";
  return config::count_text(network.mats.size(), "MAT") + ", " +
         config::count_text(scene.link_count(), "link") + ", " + bends +
         config::count_text(network.sets.size(), "set") + ", " + std::to_string(scene.space()) +
         "-D";
}

std::string place_text(const config::Place& place) {
  return place.line > 0 ? place.file + ":" + std::to_string(place.line) : place.file;
}

}  // namespace cordis::scene
