// sim_node/engine/integrators/leapfrog.cpp
#include "sim_node/engine/integrators/leapfrog.h"

#include <algorithm>

#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {
namespace {

Eigen::Map<Vec3> column(AlignedVector<double>& columns, std::size_t mat) noexcept {
  return Eigen::Map<Vec3>(columns.data() + 4 * mat);
}

}  // namespace

Leapfrog::Leapfrog(const NetworkDescription& network)
    : FullStepIntegrator(network.mats.size()),
      sweeps_(damps_in_sweeps(network) ? std::make_unique<DampingSweeps>(network) : nullptr),
      stiff_friction_(network),
      velocity_(sweeps_ ? felt_.size() : 0, 0.0) {}

void Leapfrog::start(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  world.add_frozen_forces(mats.force_columns());  // the delayed positions are x0 - dt v0
  for (std::uint32_t i = 0; i < mats.count(); ++i) column(felt_, i) = mats.delayed(i);
  world.outside.start(mats);
  mats.start();
  mats.set_forces_are_present(true);
  if (sweeps_) {
    world.links.drop_viscosity();
    world.ties.drop_viscosity();
  }
  world.links.start();
  world.ties.start();
  world.state_links.start();
  world.sets.start();
  world.account.open(energy(world).total());
}

Moved Leapfrog::step(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  Moved moved;
  StepEnergy& energy = moved.energy;
  begin_step(world, energy);
  feel_ports(world);
  stiff_friction_.begin_step(world);
  find_forces(world, felt_.data(), energy);

  if (sweeps_) {
    moved.non_finite_mats = advance_in_sweeps(world, energy);
  } else {
    if (world.freezing) energy.dissipated += stop_what_rests(world);
    const AdvanceReport advance = mats.extrapolate(world.kernel, felt_);
    moved.non_finite_mats = advance.non_finite_mats;
    take_half(0.5 * advance.medium_work, energy);
  }
  pending_.port_work += world.outside.release(mats);
  if (sweeps_) mats.add_forces(sweeps_->force());
  end_step(world);
  return moved;
}

/// @return the energy of what is stopped [J]
double Leapfrog::stop_what_rests(WorldState& world) noexcept {
  const double energy = world.freezing->choose_movers(world, true);
  for (const std::uint32_t mat : world.freezing->stopped()) {
    column(felt_, mat) = world.mats.position(mat);
  }
  return energy;
}

/// A network that freezes has no links to be solved (refusal_of), whatever they are changed to.
double Leapfrog::correct_forces(WorldState& world) noexcept {
  if (world.freezing) return 0.0;
  return stiff_friction_.solve(world, felt_, sweeps_.get(), started_);
}

void Leapfrog::adopt(WorldState& world) noexcept {
  stiff_friction_.choose(world.description(), world.table.state_machines());
}

/// What a port does is given from outside: it is felt as it has moved in the last period.
void Leapfrog::feel_ports(const WorldState& world) noexcept {
  for (const std::uint32_t port : world.outside.ports()) {
    column(felt_, port) = world.mats.delayed(port);
  }
}

/// Half of the push, what dampers do in a period, the other half.
std::uint32_t Leapfrog::advance_in_sweeps(WorldState& world, StepEnergy& energy) noexcept {
  MatArray& mats = world.mats;
  const double rate = 1.0 / world.network->step();
  for (std::uint32_t i = 0; i < mats.count(); ++i) {
    const Vec3 before = started_ || !mats.is_mass(i) ? mats.delayed_at_rest(i) : column(felt_, i);
    column(velocity_, i) = rate * (mats.position(i) - before);
  }
  for (const std::uint32_t port : world.outside.ports()) {
    column(velocity_, port) = rate * (mats.position(port) - mats.delayed(port));
  }
  sweeps_->clear_force();
  if (started_) {  // before step 0 nothing is known to have pushed
    mats.kick(world.kernel, 0.5, velocity_);
    const DampingSweeps::Loss loss = sweeps_->sweep(mats, false, velocity_);
    energy.dissipated += loss.dissipated;
    energy.port_work += loss.port_work;
  }
  felt_ = velocity_;  // v(n), of which follows what is felt; the same size: no allocation
  const DampingSweeps::Loss loss = sweeps_->sweep(mats, true, velocity_);
  pending_.dissipated += loss.dissipated;
  pending_.port_work += loss.port_work;
  mats.kick(world.kernel, 0.5, velocity_);
  const double dt = world.network->step();
  for (double& value : velocity_) value *= dt;  // displacements now
  const std::uint32_t non_finite = mats.move_by(velocity_);

  for (std::uint32_t i = 0; i < mats.count(); ++i) {
    const Vec3 moved = mats.position(i) - mats.delayed_at_rest(i);
    column(felt_, i) = mats.delayed_at_rest(i) - (moved - dt * column(felt_, i));
  }
  return non_finite;
}

/// dt v at the moment of the last forces [m].
Vec3 Leapfrog::centred_displacement(const WorldState& world, std::uint32_t mat) const noexcept {
  const Vec3 felt = column(felt_, mat);
  if (!started_) return world.mats.position(mat) - felt;
  const Vec3 delayed = world.mats.delayed(mat);
  return (world.mats.position(mat) - delayed) - (delayed - felt);
}

Energy Leapfrog::energy(WorldState& world) const noexcept {
  const double rate = 1.0 / world.network->step();
  return world.energy_at_full_step(
      [&](std::uint32_t mat) { return Vec3(rate * centred_displacement(world, mat)); });
}

Vec3 Leapfrog::velocity(const WorldState& world, std::uint32_t mat) const noexcept {
  if (!world.mats.is_mass(mat)) return Integrator::velocity(world, mat);
  return (world.mats.position(mat) - column(felt_, mat)) / world.network->step();
}

void Leapfrog::add_to(StateHash& hash) const noexcept {
  for (const double value : felt_) hash.add(value);
}

}  // namespace cordis::engine
