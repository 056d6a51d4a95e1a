// sim_node/run/loaded_scene.h -- a scene ready to be played, built outside the loop.
#pragma once

#include <cstdint>
#include <memory>

#include "sim_node/checks/limit_watch.h"
#include "sim_node/plan/plan.h"
#include "sim_node/run/change_counter.h"
#include "sim_node/run/energy_watch.h"
#include "sim_node/run/frame_store.h"
#include "sim_node/run/shadow_world.h"
#include "sim_node/run/simulation.h"
#include "sim_node/run/step_rows.h"

namespace cordis::sim {

/// A simulation and the room for its frames: all that changes hands when another scene is played.
struct LoadedScene {
  /// @param epoch    of this sim_node
  /// @param version  of the description that its frames belong to
  LoadedScene(std::shared_ptr<const scene::Scene> scene, std::uint64_t epoch,
              std::uint64_t version);
  /// @param stability  of the scene, which is not found again
  LoadedScene(const std::shared_ptr<const scene::Scene>& scene, const plan::Stability& stability,
              std::uint64_t epoch, std::uint64_t version);

  /// True if the run of this scene needs its energy.
  bool watches_energy() const noexcept { return !is_certain || may_gain || !reach.is_infinite(); }

  /// The energy of now, and the largest so far. Real time: O(MATs + links + pairs), no allocation.
  engine::Energy sample_energy() noexcept {
    energy.add(simulation.largest_kinetic_energy());
    return energy.update(simulation.world());
  }

  /// The bound beyond which a scene that is not certain lets go of its devices, if K' + 2 Z' or its
  /// energy passes it now. A scene that is certified within a reach is certain until it goes beyond
  /// it, once and for all. The energy of links that may turn about, and of bends, is watched from the start on. What is
  /// certified ends with the partners too, which the simulation watches itself. Real time.
  /// @param signs  of a moment of this scene
  PassedBound passed_bound(const BoundSigns& signs) noexcept;

  Simulation simulation;
  FrameStore frames;
  StepRows step_rows;  ///< rows of the present turn
  ChangeCounter changes;
  LimitWatch limits;
  EnergyWatch energy;  ///< largest energy in the eyes of the loop
  bool is_certain;     ///< the step is certified
  bool may_gain;       ///< enough energy turns a link about, or bends gain some: plan::Stability
  plan::ReachLimit reach;        ///< within which it is certain; infinite where it is not certain
  bool is_beyond_reach = false;  ///< it has gone beyond its reach
  bool watches_number;  ///< K' + 2 Z' is below 4 at the start, and the step is not certified
  std::shared_ptr<ShadowWorld> shadow;
  std::uint64_t ticks_per_frame;
};

}  // namespace cordis::sim
