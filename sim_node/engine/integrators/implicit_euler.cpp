// sim_node/engine/integrators/implicit_euler.cpp
#include "sim_node/engine/integrators/implicit_euler.h"

#include <algorithm>

#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {
namespace {

constexpr std::uint64_t kStepsOfStart = 8;

}  // namespace

ImplicitEuler::ImplicitEuler(const NetworkDescription& network)
    : FullStepIntegrator(4 * network.mats.size()),
      matrix_(network),
      change_(memory_.size(), 0.0),
      carried_(memory_.size(), 0.0),
      drag_(memory_.size(), 0.0) {}

/// The delayed positions of the constructor, x0 - dt v0, are those of the velocity v0.
void ImplicitEuler::start(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  world.add_frozen_forces(mats.force_columns());
  world.outside.start(mats);
  mats.clear_forces(*world.team);
  mats.set_forces_are_present(true);
  mats.find_displacements(before_);
  world.state_links.start();
  world.sets.start();
  world.account.open(energy(world).total());
}

/// Corrects the mean of dt v Z v at both ends of the period, `change_` being dt v+. @return energy [J]
double ImplicitEuler::correction_at_start(const WorldState& world) noexcept {
  const std::vector<Mat>& mats = world.description().mats;
  const auto jump = [this](std::size_t i) { return Vec3(column(change_, i) - column(before_, i)); };
  std::fill(carried_.begin(), carried_.end(), 0.0);
  matrix_.add_viscosity_times(world.mats, change_.data(), carried_.data());
  for (std::size_t i = 0; i < mats.size(); ++i) column(carried_, i) += mats[i].mass * jump(i);
  matrix_.solve(carried_.data());
  for (std::size_t i = 0; i < mats.size(); ++i) {
    if (mats[i].kind == MatKind::kMass) column(carried_, i) += column(before_, i);
  }
  std::fill(drag_.begin(), drag_.end(), 0.0);
  matrix_.add_viscosity_times(world.mats, carried_.data(), drag_.data());
  double energy = 0.0;
  for (std::size_t i = 0; i < mats.size(); ++i) {
    if (mats[i].kind == MatKind::kMass) energy += dot(jump(i), column(drag_, i));
  }
  const double rate = 1.0 / world.network->step();
  return 0.5 * rate * rate * energy;
}

Moved ImplicitEuler::step(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  Moved moved;
  StepEnergy& energy = moved.energy;
  begin_step(world, energy);
  find_forces(world, mats.force_columns().delayed, energy);

  mats.find_displacements(before_);
  take_half(mats.find_push_in_medium(before_, change_), energy);
  matrix_.assemble(mats);
  matrix_.subtract_stiffness_times(mats, before_.data(), change_.data());
  matrix_.solve(change_.data());
  for (std::size_t i = 0; i < change_.size(); ++i) change_[i] += before_[i];
  if (world.step_count < kStepsOfStart) pending_.dissipated += correction_at_start(world);
  moved.non_finite_mats = mats.move_by(change_);
  pending_.port_work += world.outside.release(mats);
  pending_.port_work += world.outside.drive_to(world.step_count + 1, mats);
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
