// sim_node/engine/integrators/full_step_integrator.cpp
#include "sim_node/engine/integrators/full_step_integrator.h"

#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {

void FullStepIntegrator::begin_step(WorldState& world, StepEnergy& energy) noexcept {
  energy = pending_;
  pending_ = {};
  energy.port_work += world.port_inputs.move_ports(world.mats);
}

void FullStepIntegrator::find_forces(WorldState& world, const double* extrapolated,
                                     StepEnergy& energy) noexcept {
  const double half = world.add_forces_at_full_step(extrapolated, energy);
  take_half(half + correct_forces(world), energy);
  find_outer_forces(world, energy);
}

void FullStepIntegrator::find_outer_forces(WorldState& world, StepEnergy& energy) noexcept {
  // The moment of the first forces is the start: nothing has been driven or pushed on a way to it.
  energy.port_work += world.port_inputs.work_at_ports(world.mats, /*at_start=*/!started_);
  const double before = world.port_inputs.kick(world.mats);
  if (started_) energy.port_work += before;
}

void FullStepIntegrator::take_half(double half, StepEnergy& energy) noexcept {
  if (started_) energy.dissipated += half;
  pending_.dissipated += half;
}

void FullStepIntegrator::end_step(WorldState& world) noexcept {
  world.mats.set_forces_are_present(false);
  started_ = true;
}

void FullStepIntegrator::serialize(Archive& archive) {
  archive.reals(memory_);
  archive.real(pending_.dissipated);
  archive.real(pending_.port_work);
  archive.flag(started_);
}

void FullStepIntegrator::restored(WorldState& world) noexcept {
  world.mats.set_forces_are_present(!started_);
  adopt(world);
}

}  // namespace cordis::engine
