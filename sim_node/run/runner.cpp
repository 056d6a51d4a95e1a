// sim_node/run/runner.cpp
#include "sim_node/run/runner.h"

#include <algorithm>
#include <utility>

namespace cordis::sim {

Runner::Runner(std::unique_ptr<LoadedScene> scene, bool devices_wait) noexcept
    : scene_(std::move(scene)), devices_wait_(devices_wait) {}

void Runner::execute(Request& request) noexcept {
  request.step = simulation().world().step_count();
  request.was_paused = paused_;
  request.steps_dropped = request.kind == Request::Kind::kPause ? steps_left_ : 0;
  switch (request.kind) {
    case Request::Kind::kPause:
      paused_ = true;
      steps_left_ = 0;
      break;
    case Request::Kind::kResume:
      paused_ = false;
      steps_left_ = 0;
      break;
    case Request::Kind::kStep:
      paused_ = true;
      steps_left_ = request.steps;
      break;
    case Request::Kind::kRestart:
      steps_left_ = 0;
      restart(request.scene);
      break;
    case Request::Kind::kExchange:
      exchange(request);
      break;
    case Request::Kind::kForceStates:
      for (const Request::ForcedState& forced : request.forced) {
        if (forced.is_bend) {
          simulation().world().force_state_of_bend(forced.link, forced.state);
        } else {
          simulation().world().force_state(forced.link, forced.state);
        }
      }
      break;
  }
}

void Runner::restart(std::unique_ptr<LoadedScene>& next) noexcept {
  for (const DeviceExchange& before : simulation().devices()) {
    DeviceExchange* now = next->simulation.find(before.device_id());
    if (now != nullptr) now->take_over(before, /*at_once=*/false);
  }
  played_before_s_ = played_s();
  next->simulation.world().swap_teams(simulation().world());
  scene_.swap(next);
}

void Runner::exchange(Request& request) noexcept {
  request.done = request.scene->simulation.go_on_from(simulation(), request.room);
  if (!request.done) return;
  request.scene->simulation.world().swap_teams(simulation().world());
  scene_.swap(request.scene);
}

bool Runner::advance() noexcept {
  if (paused_ && !devices_wait_) {
    for (DeviceExchange& device : simulation().devices()) device.let_go();
  }
  if (!moves()) return false;
  auto steps = static_cast<std::uint64_t>(simulation().steps_left_in_tick());
  if (paused_) {
    steps = std::min(steps, steps_left_);
    steps_left_ -= steps;
  }
  return simulation().advance(static_cast<int>(steps), scene_->frames.events(), &scene_->step_rows);
}

double Runner::played_s() const noexcept {
  return played_before_s_ + simulation().simulated_s() - simulation().start_s();
}

}  // namespace cordis::sim
