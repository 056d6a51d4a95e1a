// sim_node/scene/sections/fixed_part.cpp
#include "sim_node/scene/sections/fixed_part.h"

#include <algorithm>
#include <span>

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

namespace {

/// What moves one of the MATs from `first` on; empty when nothing does.
std::string contradiction_to_fixed(const Scene& scene, std::uint32_t first) {
  const engine::NetworkDescription& network = scene.network;
  if (!scene.ports.empty() && scene.ports.back().tool >= first)
    return "has a port, which its device moves";
  if (!network.drives.empty() && network.drives.back().mat >= first) return "is driven";
  const bool starts_in_motion =
      std::any_of(network.mats.begin() + first, network.mats.end(),
                  [](const engine::Mat& mat) { return !mat.velocity.isZero(0.0); });
  return starts_in_motion ? "starts in motion" : "";
}

}  // namespace

void fix_part(Assembly& assembly, std::uint32_t first, const std::string& what,
              const config::Place& place) {
  const std::string fault = contradiction_to_fixed(assembly.scene, first);
  if (!fault.empty()) {
    assembly.problems.error(place, what + " is fixed, and " + fault);
    return;
  }
  for (engine::Mat& mat : std::span(assembly.scene.network.mats).subspan(first)) {
    fix(mat);
    mat.medium_viscosity = engine::Mat::kOfNetwork;
  }
}

}  // namespace cordis::scene
