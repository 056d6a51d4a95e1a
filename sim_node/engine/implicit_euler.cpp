// sim_node/engine/implicit_euler.cpp
#include "sim_node/engine/implicit_euler.h"

#include <algorithm>

#include "sim_node/engine/world_state.h"

namespace cordis::engine {

ImplicitEuler::ImplicitEuler(const NetworkDescription& network)
    : matrix_(network), change_(4 * network.mats.size(), 0.0), before_(change_.size(), 0.0) {}

/// The delayed positions of the constructor, x0 - dt v0, are those of the velocity v0.
void ImplicitEuler::start(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  world.add_frozen_forces(mats.force_columns());
  world.outside.start(mats);
  mats.clear_forces();
  mats.set_forces_are_present(true);
  mats.find_displacements(before_);
  world.state_links.start();
  world.sets.start();
  world.account.open(energy(world).total());
}

Moved ImplicitEuler::step(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  Moved moved;
  StepEnergy& energy = moved.energy;
  energy = pending_;
  pending_ = {};
  energy.port_work += world.outside.move_ports(mats);
  const double half_power = world.add_forces_of_moment(mats.force_columns().delayed, energy);
  energy.dissipated += half_power;
  pending_.dissipated += half_power;
  energy.port_work += world.outside.work_at_ports(mats);
  energy.port_work += world.outside.push(mats);

  mats.find_displacements(before_);
  const double half_of_medium = mats.find_push_in_medium(before_, change_);
  energy.dissipated += half_of_medium;
  pending_.dissipated += half_of_medium;
  matrix_.assemble(mats);
  matrix_.subtract_stiffness_times(mats, before_.data(), change_.data());
  matrix_.solve(change_.data());
  for (std::size_t i = 0; i < change_.size(); ++i) change_[i] += before_[i];
  moved.non_finite_mats = mats.move_by(change_);
  pending_.port_work += world.outside.release(mats);
  mats.set_forces_are_present(false);
  started_ = true;
  return moved;
}

Energy ImplicitEuler::energy(WorldState& world) const noexcept {
  const double rate = 1.0 / world.network->step();
  return world.energy_of_moment([&](std::uint32_t mat) {
    return Vec3(rate * Vec3::Map(before_.data() + 4 * std::size_t{mat}));
  });
}

void ImplicitEuler::append_state(std::vector<double>& state) const {
  state.insert(state.end(), before_.begin(), before_.end());
  state.insert(state.end(),
               {pending_.dissipated, pending_.port_work, static_cast<double>(started_)});
}

const double* ImplicitEuler::take_state(WorldState& world, const double* state) noexcept {
  std::copy_n(state, before_.size(), before_.data());
  state += before_.size();
  pending_ = {};
  pending_.dissipated = *state++;
  pending_.port_work = *state++;
  started_ = *state++ != 0.0;
  world.mats.set_forces_are_present(!started_);
  return state;
}

}  // namespace cordis::engine
