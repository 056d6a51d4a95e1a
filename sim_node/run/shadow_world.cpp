// sim_node/run/shadow_world.cpp
#include "sim_node/run/shadow_world.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace cordis::sim {

namespace {

/// True if an error is above this share of the largest energy, and no rounding; also once they are no
/// finite numbers any more.
bool is_above(double share, double error, const engine::Energy& energy) noexcept {
  constexpr double kRounding = 1e-20;          // [J]
  constexpr double kRoundingOfHeight = 1e-10;  // of the energy of gravity, counted from the origin
  if (!std::isfinite(error) || !std::isfinite(energy.largest)) return true;
  return error > share * energy.largest &&
         error > std::max(kRounding, kRoundingOfHeight * std::abs(energy.gravity));
}

std::uint64_t next_id() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

bool is_error_large(const engine::Energy& energy) noexcept {
  return is_above(0.01, std::abs(energy.integration_error()), energy);
}

bool makes_energy(const engine::Energy& energy) noexcept {
  return is_above(0.1, energy.made_there, energy);
}

WorldFigures figures_of(const engine::World& world, EnergyWatch& watch,
                        const plan::ReachLimit& reach) noexcept {
  const engine::Energy energy = watch.update(world);
  return {energy, world.step_count(), world.state_hash(), signs_of(world, energy, reach)};
}

BoundSigns signs_of(const engine::World& world, const engine::Energy& energy,
                    const plan::ReachLimit& reach) noexcept {
  return {makes_energy(energy), plan::is_beyond(reach, world, energy),
          std::isfinite(energy.total())};
}

ShadowWorld::ShadowWorld(std::shared_ptr<const engine::Network> network,
                         plan::ReachLimit reach) noexcept
    : id_(next_id()), network_(std::move(network)), reach_(std::move(reach)) {}

void ShadowWorld::hand_over(const engine::World& world, double largest_kinetic) noexcept {
  if (copy_.load(std::memory_order_acquire) != Copy::kAsked) return;
  value_count_ = world.max_values_of_state();
  if (value_count_ > room_.capacity()) {
    copy_.store(Copy::kTooLarge, std::memory_order_release);
    return;
  }
  world.copy_state(room_);
  step_ = world.step_count();
  largest_kinetic_ = largest_kinetic;
  copy_.store(Copy::kThere, std::memory_order_release);
}

std::optional<WorldFigures> ShadowWorld::read(std::chrono::milliseconds patience) {
  if (!world_) {
    world_ = std::make_unique<engine::World>(network_);
    room_.assign(world_->max_values_of_state(), 0.0);  // touches every page before the loop does
  }
  if (copy_.load(std::memory_order_acquire) == Copy::kNone)
    copy_.store(Copy::kAsked, std::memory_order_release);
  const auto limit = std::chrono::steady_clock::now() + patience;
  for (Copy copy = copy_.load(std::memory_order_acquire); copy != Copy::kThere;
       copy = copy_.load(std::memory_order_acquire)) {
    if (copy == Copy::kTooLarge) {
      room_.assign(value_count_, 0.0);
      copy_.store(Copy::kAsked, std::memory_order_release);
    }
    if (std::chrono::steady_clock::now() >= limit) return std::nullopt;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const bool fits = world_->take_state(room_, step_);
  const double largest_kinetic = largest_kinetic_;
  copy_.store(Copy::kNone, std::memory_order_release);
  if (!fits) return std::nullopt;
  watch_.add(largest_kinetic);
  return figures_of(*world_, watch_, reach_);
}

}  // namespace cordis::sim
