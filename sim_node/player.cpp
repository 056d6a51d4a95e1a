// sim_node/player.cpp
#include "sim_node/player.h"

#include <algorithm>
#include <utility>

namespace cordis::sim {

Player::Player(std::unique_ptr<Stage> stage, bool devices_wait) noexcept
    : stage_(std::move(stage)), devices_wait_(devices_wait) {}

void Player::obey(Order& order) noexcept {
  order.step = simulation().world().step_count();
  order.was_paused = paused_;
  steps_left_ = 0;
  switch (order.kind) {
    case Order::Kind::kPause:
      paused_ = true;
      break;
    case Order::Kind::kResume:
      paused_ = false;
      break;
    case Order::Kind::kStep:
      paused_ = true;
      steps_left_ = order.steps;
      break;
    case Order::Kind::kRestart:
      restart(order.stage);
      break;
  }
}

void Player::restart(std::unique_ptr<Stage>& stage) noexcept {
  for (const DeviceExchange& before : simulation().devices()) {
    DeviceExchange* now = stage->simulation.find(before.device_id());
    if (now != nullptr) now->take_over(before, /*at_once=*/false);
  }
  played_before_s_ = played_s();
  stage_.swap(stage);
}

bool Player::advance() noexcept {
  if (paused_) hold();
  if (!moves()) return false;
  auto steps = static_cast<std::uint64_t>(simulation().steps_left_in_tick());
  if (paused_) {
    steps = std::min(steps, steps_left_);
    steps_left_ -= steps;
  }
  return simulation().advance(static_cast<int>(steps), stage_->frames.events());
}

void Player::hold() noexcept {
  if (devices_wait_) return;
  for (DeviceExchange& device : simulation().devices()) device.let_go();
}

double Player::played_s() const noexcept {
  return played_before_s_ + simulation().simulated_s();
}

}  // namespace cordis::sim
