// sim_node/engine/integrators/central_difference.cpp
#include "sim_node/engine/integrators/central_difference.h"

#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {
namespace {

/// m (a dt)^2 / 8 over the masses, a the acceleration by the last forces [J].
double kinetic_excess_of(const WorldState& world) noexcept {
  const NetworkDescription& network = world.description();
  const bool has_moved = world.step_count > 0;  // since the forces were summed
  double sum = 0.0;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != MatKind::kMass) continue;
    const Vec3 external_force = world.port_inputs.external_force(i);
    const Vec3 increment = has_moved ? world.mats.velocity_increment(i, external_force)
                                     : world.mats.next_velocity_increment(i, external_force);
    sum += network.mats[i].mass * increment.squaredNorm();
  }
  return sum / (8.0 * network.step * network.step);
}

}  // namespace

void CentralDifference::start(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  world.add_frozen_forces(mats.force_columns());
  const double excess = kinetic_excess_of(world);
  world.port_inputs.kick(mats);  // what drives push with is known from the start
  mats.start();
  world.start_one_period_ago();
  const StepEnergy since = world.work_since_last_call();
  world.account.start(world.description(), mats, world.stored_energy(), since.elastic);
  world.account.begin_dissipated(since.dissipated);
  world.account.set_initial_excess(excess);
}

Moved CentralDifference::step(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  Moved moved;
  StepEnergy& energy = moved.energy;
  energy.port_work = world.port_inputs.move_ports(mats);
  energy += world.begin_forces(mats.force_columns());
  world.add_forces_at_half_step(energy);
  energy.port_work += world.port_inputs.work_at_ports(mats);

  energy.port_work += world.port_inputs.kick(mats);
  if (world.freezing) energy.dissipated += world.freezing->choose_movers(world, false);
  const AdvanceReport advance = mats.advance(world.kernel, *world.team);
  energy.port_work += world.port_inputs.release(mats);
  energy.port_work += world.port_inputs.drive_to(world.step_count + 1, mats);

  energy.dissipated += advance.medium_work;
  moved.non_finite_mats = advance.non_finite_mats;
  return moved;
}

Energy CentralDifference::energy(WorldState& world) const noexcept {
  Energy energy = world.account.energy(world.description(), world.mats,
                                       world.work_since_last_call(), world.stored_energy());
  if (world.step_count > 0)
    energy.kinetic_excess = kinetic_excess_of(world) - world.account.initial_excess();
  return energy;
}

}  // namespace cordis::engine
