// sim_node/run/loaded_scene.cpp
#include "sim_node/run/loaded_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim_node/plan/plan.h"
#include "sim_node/run/describe.h"

namespace cordis::sim {
namespace {

std::size_t ticks_per_frame_of(const scene::Scene& scene) {
  return static_cast<std::size_t>(
      std::max(1.0, std::round(scene.gesture_rate_hz / scene.frame_rate_hz)));
}

/// As many pairs as the sets whose pairs have states can have at most, or kMaxBonds.
std::size_t max_bonds(const scene::Scene& scene, const std::vector<std::size_t>& state_sets) {
  std::size_t pairs = 0;
  for (const std::size_t set : state_sets) {
    const std::size_t p = scene.network.sets[set].set_p.size();
    const std::size_t q = scene.network.sets[set].set_q.size();
    pairs = std::min(kMaxBonds, pairs + (q == 0 ? p * (p - 1) / 2 : p * q));
  }
  return pairs;
}

FrameShape shape_of(const Simulation& simulation, std::uint64_t version) {
  const scene::Scene& scene = simulation.scene();
  const std::vector<std::size_t> state_sets = state_sets_of(scene);
  return {.version = version,
          .mat_count = scene.network.mats.size(),
          .signal_count = scene.signals.count(),
          .rows_per_frame = ticks_per_frame_of(scene),
          .stride_steps = static_cast<std::uint32_t>(simulation.division().whole_steps()),
          .has_even_rows = simulation.division().is_even(),
          .step_signal_count = scene.signals.by_step().size(),
          .step_rows_per_frame = ticks_per_frame_of(scene) * simulation.division().max_steps(),
          .layout = layout_of(scene),
          .link_count = scene.network.state_links.empty() ? 0 : link_count_of(scene),
          .first_state_link = scene.network.links.size(),
          .state_link_count = scene.network.state_links.size(),
          .state_sets = state_sets,
          .bond_capacity = max_bonds(scene, state_sets),
          .port_mats = port_mats_of(scene)};
}

plan::Stability stability_of(const scene::Scene& scene) {
  return plan::stability_of(scene.network, plan::liaison_graph(scene.network));
}

double number_of_start(LimitWatch& limits, const engine::World& world) {
  limits.update(world);
  return limits.largest();
}

}  // namespace

LoadedScene::LoadedScene(std::shared_ptr<const scene::Scene> scene, std::uint64_t epoch,
                         std::uint64_t version)
    : LoadedScene(scene, stability_of(*scene), epoch, version) {}

LoadedScene::LoadedScene(const std::shared_ptr<const scene::Scene>& scene,
                         const plan::Stability& stability, std::uint64_t epoch,
                         std::uint64_t version)
    : simulation(scene, epoch),
      frames(shape_of(simulation, version)),
      step_rows(simulation.scene().signals.by_step().size(), simulation.division().max_steps()),
      changes(simulation.scene().network.state_machines),
      limits(simulation.scene().network),
      is_certain(stability.holds()),
      may_gain(std::isfinite(stability.turning.energy) || stability.bending || stability.touching),
      reach(is_certain ? plan::reach_limit(simulation.scene().network) : plan::ReachLimit{}),
      watches_number(!is_certain && number_of_start(limits, simulation.world()) < 4.0),
      shadow(std::make_shared<ShadowWorld>(simulation.world().shared_network(), reach)),
      ticks_per_frame(ticks_per_frame_of(simulation.scene())) {}

PassedBound LoadedScene::passed_bound(const BoundSigns& signs) noexcept {
  is_beyond_reach = is_beyond_reach || signs.is_beyond_reach;
  if (is_certain && !may_gain && !is_beyond_reach) return PassedBound::kNone;
  if (watches_number) {
    constexpr double kLimit = 4.0;
    limits.update(simulation.world());
    if (limits.largest() >= kLimit) return PassedBound::kNumber;
  }
  return signs.makes_energy ? PassedBound::kEnergy : PassedBound::kNone;
}

}  // namespace cordis::sim
