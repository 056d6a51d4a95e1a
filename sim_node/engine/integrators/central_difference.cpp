// sim_node/engine/integrators/central_difference.cpp
#include "sim_node/engine/integrators/central_difference.h"

#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {

void CentralDifference::start(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  world.add_frozen_forces(mats.force_columns());
  mats.start();
  world.start_one_period_ago();
  world.account.start(world.description(), mats, world.stored_energy(),
                      world.work_since_last_call().elastic);
}

Moved CentralDifference::step(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  Moved moved;
  StepEnergy& energy = moved.energy;
  energy.port_work = world.outside.move_ports(mats);
  energy += world.begin_forces(mats.force_columns());
  world.add_forces_at_half_step(energy);
  energy.port_work += world.outside.work_at_ports(mats);

  energy.port_work += world.outside.kick(mats);
  if (world.freezing) energy.dissipated += world.freezing->choose_movers(world, false);
  const AdvanceReport advance = mats.advance(world.kernel);
  energy.port_work += world.outside.release(mats);

  energy.dissipated += advance.medium_work;
  moved.non_finite_mats = advance.non_finite_mats;
  return moved;
}

Energy CentralDifference::energy(WorldState& world) const noexcept {
  return world.account.energy(world.description(), world.mats, world.work_since_last_call(),
                              world.stored_energy());
}

}  // namespace cordis::engine
