// sim_node/engine/integrators/leapfrog.h -- the scheme of the paper with dampers of second order.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/integrators/damping_sweeps.h"
#include "sim_node/engine/integrators/full_step_integrator.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/stiff_friction.h"

namespace cordis::engine {

/// Leapfrog: positions at the steps, velocities between them, as `cordis`; but dampers, conditions
/// and the medium see the velocity of the moment of x(n), extrapolated, 1.5 v(n-1/2) - 0.5
/// v(n-3/2). With it every viscosity, of links, of states, of sets, is of second order. Stable
/// while 4 M - dt^2 K - 4 dt Z > 0.
///
/// Where linear links or the medium are too viscous for that (damps_in_sweeps), their viscosities
/// act in DampingSweeps between the two halves of the push by all other forces:
/// 4 M - dt^2 K > 0 is enough then. Where the viscosity of state links is (friction, bows), they
/// are solved one by one (StiffFriction), with the same limit. Sets are always extrapolated.
///
/// Ports are given, so their velocity is that of the last period; Maxwell elements answer to the
/// growth in the last period. The account belongs to the moment of the last forces: kinetic energy
/// of the centred velocity (x(n+1) - x(n-1)) / 2 dt, all else in closed form; what finite steps do
/// to it is the residual, of second order.
class Leapfrog final : public FullStepIntegrator {
 public:
  explicit Leapfrog(const NetworkDescription& network);

  void start(WorldState& world) noexcept override;
  Moved step(WorldState& world) noexcept override;
  void adopt(WorldState& world) noexcept override;
  Energy energy(WorldState& world) const noexcept override;
  Vec3 velocity(const WorldState& world, std::uint32_t mat) const noexcept override;

  void add_to(StateHash& hash) const noexcept override;

 private:
  double correct_forces(WorldState& world) noexcept override;
  double stop_what_rests(WorldState& world) noexcept;
  void feel_ports(const WorldState& world) noexcept;
  std::uint32_t advance_in_sweeps(WorldState& world, StepEnergy& energy) noexcept;
  Vec3 centred_displacement(const WorldState& world, std::uint32_t mat) const noexcept;

  AlignedVector<double>& felt_ = memory_;  // x(n) - dt v(n) [m]
  std::unique_ptr<DampingSweeps> sweeps_;  // none: dampers see the extrapolated velocity
  StiffFriction stiff_friction_;
  AlignedVector<double> velocity_;  // of the step in progress, of sweeps [m/s]
};

}  // namespace cordis::engine
