// cli/export/tick_steps.h -- which turns of sim_node's loop completed a gesture period of a scene.
#pragma once

#include <cstdint>

#include "idl/inputs.h"
#include "sim_node/run/tick_division.h"

namespace cordis::cli {

/// Follows the commands of a session turn by turn, as sim_node did, and counts steps of one scene.
class TickSteps {
 public:
  /// @param version  of the scene whose steps are counted; 1 is the first of an epoch
  TickSteps(std::uint64_t version, double step_rate_hz, double gesture_rate_hz);

  /// A scene that was loaded.
  void load() noexcept { begin_scene(); }
  /// An input that took effect before the next turn; other ones than commands count for nothing.
  /// @throws std::invalid_argument when its words are none
  void execute(const msg::InputEvent& input);
  /// Plays the next turn. @return true if a gesture period of the scene was completed
  bool play_turn() noexcept;

  std::uint64_t step() const noexcept { return step_; }  ///< steps of the scene so far
  bool is_in_scene() const noexcept { return version_ == wanted_version_; }

 private:
  void begin_scene() noexcept;

  std::uint64_t wanted_version_;
  std::uint64_t version_ = 1;
  sim::TickDivision division_;
  bool paused_ = false;
  std::uint64_t steps_left_ = 0;  // of a command `step`
  std::uint64_t step_ = 0;
  int step_of_tick_ = 0;
};

}  // namespace cordis::cli
