// sim_node/engine/integrators/implicit_euler.cpp
#include "sim_node/engine/integrators/implicit_euler.h"

#include <algorithm>

#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {
namespace {

constexpr std::uint64_t kStepsOfStart = 8;

/// Half of what a product of displacements and dt Z takes in a period [J].
double half_loss(const WorldState& world, double product) noexcept {
  const double rate = 1.0 / world.network->step();
  return 0.5 * rate * rate * product;
}

}  // namespace

ImplicitEuler::ImplicitEuler(const NetworkDescription& network)
    : FullStepIntegrator(4 * network.mats.size()),
      matrix_(network),
      change_(memory_.size(), 0.0),
      carried_(memory_.size(), 0.0) {}

/// The delayed positions of the constructor, x0 - dt v0, are those of the velocity v0.
void ImplicitEuler::start(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  world.add_frozen_forces(mats.force_columns());
  world.port_inputs.start(mats);
  mats.clear_forces(*world.team);
  mats.set_forces_are_present(true);
  mats.find_displacements(before_);
  world.state_links.start();
  world.bends.forget_viscous_forces();
  world.sets.start();
  world.account.open(energy(world).total());
}

/// `change_` being dt (v+ - v). @return energy [J]
double ImplicitEuler::loss_of_creep(const WorldState& world) noexcept {
  const std::vector<Mat>& mats = world.description().mats;
  for (std::size_t i = 0; i < mats.size(); ++i) {
    column(carried_, i) = mats[i].mass * column(change_, i);
  }
  matrix_.add_viscosity_times(world.mats, before_.data(), carried_.data());
  matrix_.add_viscosity_times(world.mats, change_.data(), carried_.data());
  matrix_.solve(carried_.data());
  return half_loss(world, matrix_.viscous_product(world.mats, change_.data(), carried_.data()));
}

/// Ports feel the force that is solved for, and PortInputs counts that of the beginning. `change_` being dt (v+ - v).
/// @return energy [J]
double ImplicitEuler::work_of_change_at_ports(const WorldState& world) noexcept {
  if (world.port_inputs.ports().empty()) return 0.0;
  std::fill(carried_.begin(), carried_.end(), 0.0);
  for (const std::uint32_t port : world.port_inputs.ports()) {
    column(carried_, port) = column(before_, port);
  }
  return half_loss(world, matrix_.viscous_product(world.mats, change_.data(), carried_.data()));
}

Moved ImplicitEuler::step(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  Moved moved;
  StepEnergy& energy = moved.energy;
  begin_step(world, energy);
  take_half(world.add_forces_to_solve_on(energy), energy);
  find_outer_forces(world, energy);

  mats.find_displacements(before_);
  if (started_) {
    energy.dissipated += half_loss(world, matrix_.turned_product(mats, before_.data()));
  }
  take_half(mats.find_kick_in_medium(before_, change_), energy);
  matrix_.assemble(mats);
  matrix_.subtract_stiffness_times(mats, before_.data(), change_.data());
  matrix_.solve(change_.data());
  pending_.dissipated +=
      half_loss(world, matrix_.viscous_product(mats, change_.data(), before_.data()));
  pending_.port_work += work_of_change_at_ports(world);
  if (world.step_count < kStepsOfStart) pending_.dissipated += loss_of_creep(world);
  for (std::size_t i = 0; i < change_.size(); ++i) change_[i] += before_[i];
  moved.non_finite_mats = mats.move_by(change_);
  pending_.port_work += world.port_inputs.release(mats);
  pending_.port_work += world.port_inputs.drive_to(world.step_count + 1, mats);
  end_step(world);
  return moved;
}

Energy ImplicitEuler::energy(WorldState& world) const noexcept {
  const double rate = 1.0 / world.network->step();
  return world.energy_at_full_step([&](std::uint32_t mat) {
    return Vec3(rate * Vec3::Map(before_.data() + 4 * std::size_t{mat}));
  });
}

}  // namespace cordis::engine
