// sim_node/run/loaded_scene.h -- a scene ready to be played, made away from the loop.
#pragma once

#include <cstdint>
#include <memory>

#include "sim_node/checks/limit_watch.h"
#include "sim_node/run/change_counter.h"
#include "sim_node/run/frame_store.h"
#include "sim_node/run/shadow_world.h"
#include "sim_node/run/simulation.h"

namespace cordis::sim {

/// A simulation and the room for its frames: all that changes hands when another scene is played.
struct LoadedScene {
  /// @param epoch    of this sim_node
  /// @param version  of the description that its frames belong to
  LoadedScene(std::shared_ptr<const scene::Scene> scene, std::uint64_t epoch,
              std::uint64_t version);

  Simulation simulation;
  FrameStore frames;
  ChangeCounter changes;
  LimitWatch limits;
  std::shared_ptr<ShadowWorld> shadow;
  std::uint64_t ticks_per_frame;
};

}  // namespace cordis::sim
