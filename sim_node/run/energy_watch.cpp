// sim_node/run/energy_watch.cpp
#include "sim_node/run/energy_watch.h"

#include <algorithm>
#include <cmath>

namespace cordis::sim {

namespace {

/// Kinetic energy and the magnitudes of the true potentials, that of gravity from the start on [J].
double energy_of_moment(const engine::Energy& energy) noexcept {
  return std::abs(energy.kinetic + energy.kinetic_excess) +
         std::abs(energy.elastic - energy.elastic_error) +
         std::abs(energy.gravity - energy.initial_gravity);
}

}  // namespace

void EnergyWatch::add(double largest_kinetic) noexcept {
  if (std::isfinite(largest_kinetic)) largest_ = std::max(largest_, largest_kinetic);
}

engine::Energy EnergyWatch::read(const engine::World& world) const noexcept {
  engine::Energy energy = world.energy();
  const double now = energy_of_moment(energy);
  const double at_start = std::abs(energy.initial - energy.initial_gravity);
  energy.largest = std::isfinite(now) ? std::max({largest_, now, at_start}) : now;
  return energy;
}

/// Adds the integration error since the last update. Viscosity dissipates the same share of it as of all energy.
void EnergyWatch::update_made(const engine::Energy& energy, std::uint64_t step) noexcept {
  const double error = energy.integration_error();
  if (!std::isfinite(error)) {
    made_ = error;
    return;
  }
  if (step < step_) made_ = error_ = dissipated_ = 0.0;  // the scene has begun again
  const double there = energy_of_moment(energy);
  const double taken = std::max(energy.dissipated - dissipated_, 0.0);
  made_ += error - error_;
  if (taken > 0.0) made_ *= there / (there + taken);
  step_ = step;
  error_ = error;
  dissipated_ = energy.dissipated;
}

engine::Energy EnergyWatch::update(const engine::World& world) noexcept {
  engine::Energy energy = read(world);
  if (std::isfinite(energy.largest)) largest_ = energy.largest;
  update_made(energy, world.step_count());
  energy.made_there = made_;
  return energy;
}

}  // namespace cordis::sim
