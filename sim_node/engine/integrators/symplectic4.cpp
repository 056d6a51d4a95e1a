// sim_node/engine/integrators/symplectic4.cpp
#include "sim_node/engine/integrators/symplectic4.h"

#include <algorithm>
#include <array>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {
namespace {

// Parts of a period: kick, drift, kick, ... ; the second half runs backward.
constexpr double kKick1 = 0.0829844064174052;
constexpr double kKick2 = 0.396309801498368;
constexpr double kKick3 = -0.0390563049223486;
constexpr double kKick4 = 1.0 - 2.0 * (kKick1 + kKick2 + kKick3);
constexpr double kDrift1 = 0.245298957184271;
constexpr double kDrift2 = 0.604872665711080;
constexpr double kDrift3 = 0.5 - (kDrift1 + kDrift2);

struct Stage {
  double kick;
  double drift;  // at the velocity after the kick
};
constexpr std::array<Stage, 6> kStages{{{kKick1, kDrift1},
                                        {kKick2, kDrift2},
                                        {kKick3, kDrift3},
                                        {kKick4, kDrift3},
                                        {kKick3, kDrift2},
                                        {kKick2, kDrift1}}};

}  // namespace

double symplectic4_trace(double stiffness) noexcept {
  double trace = 0.0;
  for (const bool displaced : {true, false}) {  // 1 m away, or 1 m a period fast
    double place = displaced ? 1.0 : 0.0;
    double moved = displaced ? 0.0 : 1.0;
    for (const Stage& stage : kStages) {
      moved -= stage.kick * stiffness * place;
      place += stage.drift * moved;
    }
    moved -= kKick1 * stiffness * place;
    trace += displaced ? place : moved;
  }
  return trace;
}

Symplectic4::Symplectic4(const NetworkDescription& network)
    : velocity_(4 * network.mats.size(), 0.0) {
  for (std::size_t i = 0; i < network.mats.size(); ++i) {
    std::copy_n(network.mats[i].velocity.data(), 3, velocity_.data() + 4 * i);
  }
}

void Symplectic4::start(WorldState& world) noexcept {
  world.mats.set_forces_are_present(true);
  find_forces(world);
  world.account.open(energy(world).total());
}

void Symplectic4::adopt(WorldState& world) noexcept {
  find_forces(world);
}

Moved Symplectic4::step(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  Moved moved;
  if (world.port_inputs.held_count() > 0) mats.delay();  // for the work of the held forces
  for (const Stage& stage : kStages) {
    world.port_inputs.kick(mats);
    mats.kick_and_drift(world.kernel, stage.kick, stage.drift, velocity_);
    add_forces(world);
  }
  world.port_inputs.kick(mats);
  mats.kick(world.kernel, kKick1, velocity_);
  moved.energy.port_work = 2.0 * world.port_inputs.release(mats);  // over the way from x(n)
  moved.non_finite_mats = mats.delay_by(world.kernel, velocity_);
  return moved;
}

void Symplectic4::find_forces(WorldState& world) noexcept {
  world.mats.clear_forces(*world.team);
  add_forces(world);
}

/// Adds the forces without viscosity, which depend on positions alone.
void Symplectic4::add_forces(WorldState& world) noexcept {
  ForceColumns at_rest = world.mats.force_columns();
  at_rest.delayed = at_rest.position;
  world.links.add_forces_at_full_step(world.kernel, at_rest, *world.team);
  world.vector_springs.add_forces_at_full_step(world.kernel, at_rest, *world.team);
  world.state_links.add_forces_before_start(world.state_machines, world.table, at_rest);
  world.bends.add_forces(world.table, at_rest, *world.team);
  PairStep pairs = world.pair_step(true);
  pairs.sums_contacts = true;  // those of the last stage stay
  world.sets.add_forces(pairs, at_rest, world.team.get());
}

Energy Symplectic4::energy(WorldState& world) const noexcept {
  return world.energy_at_full_step([this](std::uint32_t mat) {
    return Vec3(Vec3::Map(velocity_.data() + 4 * std::size_t{mat}));
  });
}

Vec3 Symplectic4::velocity(const WorldState&, std::uint32_t mat) const noexcept {
  return Vec3::Map(velocity_.data() + 4 * std::size_t{mat});
}

/// The forces of the last step are part of the state of the MATs, and always present.
void Symplectic4::serialize(Archive& archive) {
  archive.reals(velocity_);
  archive.hash(velocity_);
}

}  // namespace cordis::engine
