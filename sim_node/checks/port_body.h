// sim_node/checks/port_body.h -- what a device moves at a port: one MAT, or the masses of a body.
#pragma once

#include "sim_node/engine/world.h"
#include "sim_node/plan/stability/port_limit.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Mass of the MAT, or of the body [kg]; 0 of a MAT that the device holds itself.
double mass_of(const scene::Scene& scene, const scene::Port& port);

/// What hangs on a port, at most or at least, as of plan::port_load(). Of a body: the viscosity is
/// what damps its centre, that of liaisons to what does not belong to it, and of the medium: at
/// least, what no motion within the body escapes, 0 where a mass has none itself. The stiffness is
/// so large that no mass of the body comes nearer to the limit of the step than the body seems to.
/// A spring at the centre of mass is never stiffer than one of its share at each mass.
plan::PortLoad max_load_of(const plan::LiaisonGraph& graph, const scene::Scene& scene,
                           const scene::Port& port);
plan::PortLoad min_load_of(const plan::LiaisonGraph& graph, const scene::Scene& scene,
                           const scene::Port& port);

/// Position [m] and velocity [m/s] of the MAT, or of the centre of mass. Real time: O(masses), no allocation.
engine::Vec3 position_of(const engine::World& world, const scene::Port& port) noexcept;
engine::Vec3 velocity_of(const engine::World& world, const scene::Port& port) noexcept;
/// Puts a force on the MAT, or on each mass of the body its share. Real time: O(masses), no allocation.
/// @param force  [N]
/// Precondition: role liaison.
void apply_force(engine::World& world, const scene::Port& port, const engine::Vec3& force) noexcept;

}  // namespace cordis::sim
