// sim_node/run/runner.h -- the loop's side of live change: plays a scene, and executes
// requests between two steps.
#pragma once

#include <cstdint>
#include <memory>

#include "sim_node/run/loaded_scene.h"
#include "sim_node/run/request.h"

namespace cordis::sim {

/// Plays a scene turn by turn, pauses, does single steps and changes over to another scene.
/// The threads that share the steps of one scene then share those of the other.
///
/// Time stops in a paused scene. Where the devices are the clock (lockstep) it stops
/// for them too, and the pause leaves no trace in the result. Elsewhere the devices live on: they
/// are let go of, so that their MATs hold still and their forces are 0, and they take over
/// gradually when the scene goes on. Real time: everything but the constructor allocates and frees
/// nothing, and does not throw.
class Runner {
 public:
  /// @param devices_wait  whether devices wait for the scene, as in lockstep
  Runner(std::unique_ptr<LoadedScene> scene, bool devices_wait) noexcept;

  /// Does what the request wants; the step in progress, if any, is complete.
  /// Precondition of kRestart and kExchange: no other thread uses the frames of the present scene.
  void execute(Request& request) noexcept;

  /// True if this turn of the loop has something to do.
  bool moves() const noexcept { return !paused_ || steps_left_ > 0; }

  /// One turn: the rest of the tick, or the single steps still wanted of it; nothing while the
  /// scene is paused. @return whether a tick is complete, and its answers are due.
  bool advance() noexcept;

  LoadedScene& loaded_scene() noexcept { return *scene_; }
  const Simulation& simulation() const noexcept { return scene_->simulation; }
  Simulation& simulation() noexcept { return scene_->simulation; }
  bool is_paused() const noexcept { return paused_; }
  std::uint64_t steps_left() const noexcept { return steps_left_; }  ///< single steps still wanted
  double played_s() const noexcept;  ///< simulated time of all scenes together [s]

 private:
  void restart(std::unique_ptr<LoadedScene>& next) noexcept;
  void exchange(Request& request) noexcept;

  std::unique_ptr<LoadedScene> scene_;
  bool devices_wait_;
  bool paused_ = false;
  std::uint64_t steps_left_ = 0;
  double played_before_s_ = 0.0;  // by earlier scenes
};

}  // namespace cordis::sim
