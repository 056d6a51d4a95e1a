// sim_node/engine/integrators/leapfrog.cpp
#include "sim_node/engine/integrators/leapfrog.h"

#include <algorithm>
#include <array>

#include "sim_node/engine/integrators/world_state.h"
#include "sim_node/engine/links/link_runs.h"

namespace cordis::engine {

namespace {

/// True if forces other than those of implicit dampers may store no energy.
bool has_explicit_losses(const NetworkDescription& network) noexcept {
  return !network.state_links.empty() || !network.bends.empty() || !network.sets.empty();
}

}  // namespace

Leapfrog::Leapfrog(const NetworkDescription& network)
    : FullStepIntegrator(layout_of(network).value_count(network.mats.size()) +
                         4 * network.mats.size() + 2),
      damping_(damps_implicitly(network) ? std::make_unique<ImplicitDamping>(network) : nullptr),
      stiff_friction_(network),
      layout_(layout_of(network)),
      velocity_(4 * network.mats.size(), 0.0),
      losses_(damping_ && has_explicit_losses(network) ? velocity_.size() : 0, 0.0) {
  // What asks for velocities before start() has those of the network.
  for (std::size_t i = 0; i < network.mats.size(); ++i)
    set_extrapolated(i, network.mats[i].position - network.step * network.mats[i].velocity);
}

void Leapfrog::start(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  if (damping_) {
    world.links.drop_viscosity();
    world.vector_springs.drop_viscosity();
  }
  world.add_frozen_forces(mats.force_columns());  // the delayed positions are x0 - dt v0
  for (std::uint32_t i = 0; i < mats.count(); ++i) set_extrapolated(i, mats.delayed(i));
  world.port_inputs.start(mats);
  if (damping_) {
    mats.clear_forces(*world.team);
  } else {
    world.port_inputs.kick(mats);  // what drives push with is known from the start
    mats.start();
  }
  mats.set_forces_are_present(true);
  world.links.start();
  world.vector_springs.start();
  world.bends.forget_viscous_forces();
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
  find_forces(world, extrapolated_.data(), energy);

  if (damping_) {
    moved.non_finite_mats = advance_damped(world, energy);
  } else {
    last_kick_count() = 0.0;
    if (world.freezing) energy.dissipated += stop_what_rests(world);
    const AdvanceReport advance = mats.extrapolate(world.kernel, extrapolated_, *world.team);
    moved.non_finite_mats = advance.non_finite_mats;
    take_half(0.5 * advance.medium_work, energy);
  }
  pending_.port_work += world.port_inputs.release(mats);
  pending_.port_work += world.port_inputs.drive_to(world.step_count + 1, mats);
  if (damping_) mats.add_forces(damping_->force());
  end_step(world);
  return moved;
}

/// @return the energy of what is stopped [J]
double Leapfrog::stop_what_rests(WorldState& world) noexcept {
  const double energy = world.freezing->choose_movers(world, true);
  for (const std::uint32_t mat : world.freezing->stopped()) {
    set_extrapolated(mat, world.mats.position(mat));
  }
  return energy;
}

/// A network that freezes has no links to be solved (refusal_of), whatever they are changed to.
double Leapfrog::correct_forces(WorldState& world) noexcept {
  if (world.freezing) return 0.0;
  if (damping_) begin_damping(world);
  return stiff_friction_.solve(world, extrapolated_, damping_.get(), started_);
}

void Leapfrog::adopt(WorldState& world) noexcept {
  stiff_friction_.choose(world.description(), world.table.state_machines());
}

/// What a port does is given from outside: it is extrapolated as it has moved in the last period. Of a
/// driven one the next place is known, and so its velocity to second order.
void Leapfrog::feel_ports(const WorldState& world) noexcept {
  for (const std::uint32_t port : world.port_inputs.ports()) {
    const Vec3 delayed = world.mats.delayed(port);
    set_extrapolated(port, delayed);
    if (!world.mats.is_driven(port)) continue;
    const Vec3 next = world.port_inputs.driven_place(port, world.step_count + 1);
    if (!next.allFinite()) continue;
    set_extrapolated(port, world.mats.position(port) - 0.5 * (next - delayed));
  }
}

void Leapfrog::begin_damping(WorldState& world) noexcept {
  const MatArray& mats = world.mats;
  for (std::uint32_t i = 0; i < mats.count(); ++i) {
    const Vec3 before = mats.is_mass(i) ? extrapolated(i) : mats.delayed_at_rest(i);
    column(velocity_, i) =
        started_ && mats.is_mass(i) ? mats.moved(i) : Vec3(mats.position(i) - before);
  }
  for (const std::uint32_t port : world.port_inputs.ports()) {
    column(velocity_, port) = mats.position(port) - mats.delayed(port);
  }
  damping_->begin_step(mats, velocity_, extrapolated_, has_last_kick() ? last_kick() : nullptr,
                       !started_);
}

/// Half of the work of dampers lies before the moment of the forces; in the first step all of it
/// comes after.
std::uint32_t Leapfrog::advance_damped(WorldState& world, StepEnergy& energy) noexcept {
  damping_->find_velocities(world.mats, nullptr);
  if (!losses_.empty()) world.find_viscous_forces(losses_);
  const ImplicitDamping::Work work = damping_->advance(world.mats, extrapolated_, losses_);
  const double before = started_ ? 0.5 : 0.0;
  energy.dissipated += before * work.dissipated;
  energy.port_work += before * work.port_work;
  pending_.dissipated += (1.0 - before) * work.dissipated;
  pending_.port_work += (1.0 - before) * work.port_work;
  std::copy(damping_->kick().begin(), damping_->kick().end(), last_kick());
  last_kick_count() = 1.0;
  memory_.back() = work.kinetic;
  return work.non_finite_mats;
}

/// dt v at the moment of the last forces [m].
Vec3 Leapfrog::centred_displacement(const WorldState& world, std::uint32_t mat) const noexcept {
  if (!started_) return world.mats.position(mat) - extrapolated(mat);
  return world.mats.moved(mat) - (world.mats.delayed(mat) - extrapolated(mat));
}

Energy Leapfrog::energy(WorldState& world) const noexcept {
  if (damping_ && has_last_kick()) return world.energy_at_full_step(memory_.back());
  const double rate = 1.0 / world.network->step();
  return world.energy_at_full_step(
      [&](std::uint32_t mat) { return Vec3(rate * centred_displacement(world, mat)); });
}

Vec3 Leapfrog::velocity(const WorldState& world, std::uint32_t mat) const noexcept {
  if (!world.mats.is_mass(mat)) return Integrator::velocity(world, mat);
  return (world.mats.position(mat) - extrapolated(mat)) / world.network->step();
}

void Leapfrog::serialize(Archive& archive) {
  FullStepIntegrator::serialize(archive);
  if (!archive.hashes()) return;
  for (std::size_t i = 0; i < velocity_.size() / 4; ++i) {
    const Vec3 of_mat = extrapolated(i);
    archive.hash(std::array{of_mat.x(), of_mat.y(), of_mat.z(), 0.0});
  }
  if (damping_) archive.hash({last_kick(), velocity_.size() + 2});
}

}  // namespace cordis::engine
