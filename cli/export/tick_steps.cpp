// cli/export/tick_steps.cpp
#include "cli/export/tick_steps.h"

#include <algorithm>

#include "sim_node/run/command.h"

namespace cordis::cli {

TickSteps::TickSteps(std::uint64_t version, double step_rate_hz, double gesture_rate_hz)
    : wanted_version_(version), division_(step_rate_hz, gesture_rate_hz) {}

void TickSteps::begin_scene() noexcept {
  ++version_;
  steps_left_ = 0;
}

void TickSteps::execute(const msg::InputEvent& input) {
  switch (input.kind()) {
    case msg::INPUT_PAUSE:
    case msg::INPUT_RESUME:
      paused_ = input.kind() == msg::INPUT_PAUSE;
      steps_left_ = 0;
      break;
    case msg::INPUT_STEP:
      paused_ = true;
      steps_left_ = sim::read_command(msg::VERB_STEP, input.argument()).steps;
      break;
    case msg::INPUT_RESET:
      begin_scene();
      break;
    default:
      break;
  }
}

bool TickSteps::play_turn() noexcept {
  if (!is_in_scene() || (paused_ && steps_left_ == 0)) return false;
  auto steps = static_cast<std::uint64_t>(division_.steps() - step_of_tick_);
  if (paused_) {
    steps = std::min(steps, steps_left_);
    steps_left_ -= steps;
  }
  step_ += steps;
  step_of_tick_ += static_cast<int>(steps);
  if (step_of_tick_ < division_.steps()) return false;
  step_of_tick_ = 0;
  division_.next();
  return true;
}

}  // namespace cordis::cli
