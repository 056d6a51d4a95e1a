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

engine::Energy EnergyWatch::update(const engine::World& world) noexcept {
  const engine::Energy energy = read(world);
  if (std::isfinite(energy.largest)) largest_ = energy.largest;
  return energy;
}

}  // namespace cordis::sim
