// sim_node/run/loaded_scene.cpp
#include "sim_node/run/loaded_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim_node/run/describe.h"

namespace cordis::sim {
namespace {

std::size_t ticks_per_frame_of(const scene::Scene& scene) {
  return static_cast<std::size_t>(
      std::max(1.0, std::round(scene.gesture_rate_hz / scene.frame_rate_hz)));
}

FrameShape shape_of(const Simulation& simulation, std::uint64_t version) {
  const scene::Scene& scene = simulation.scene();
  return {.version = version,
          .mat_count = scene.network.mats.size(),
          .signal_count = scene.signals.count(),
          .rows_per_frame = ticks_per_frame_of(scene),
          .stride_steps = static_cast<std::uint32_t>(simulation.steps_per_tick()),
          .layout = layout_of(scene),
          .link_count = scene.network.state_links.empty() ? 0 : link_count_of(scene),
          .first_state_link = scene.network.links.size(),
          .state_link_count = scene.network.state_links.size()};
}

}  // namespace

LoadedScene::LoadedScene(std::shared_ptr<const scene::Scene> scene, std::uint64_t epoch,
                         std::uint64_t version)
    : simulation(std::move(scene), epoch),
      frames(shape_of(simulation, version)),
      changes(simulation.scene().network.state_machines),
      limits(simulation.scene().network),
      shadow(std::make_shared<ShadowWorld>(simulation.world().shared_network())),
      ticks_per_frame(ticks_per_frame_of(simulation.scene())) {}

}  // namespace cordis::sim
