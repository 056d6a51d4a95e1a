// sim_node/engine/integrators/implicit_euler.h -- for very stiff cables.
#pragma once

#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/integrators/full_step_integrator.h"
#include "sim_node/engine/integrators/stiffness_matrix.h"

namespace cordis::engine {

/// Linearly implicit Euler: linear links and the medium as they will be at the end of the step, by
/// their tangents at its beginning,
///
///     (M + dt Z + dt^2 K) (v(n+1) - v(n)) = dt (f(n) - dt K v(n)),   x(n+1) = x(n) + dt v(n+1)
///
/// and all else, states, sets, Maxwell elements, forces from outside, as `cordis` takes it. No
/// linear link is too stiff or too viscous for it; the explicit part alone limits the step. Of
/// first order; it damps: a vibration w as if its viscosity were w^2 dt m more. A compressed link
/// counts as if it had no stiffness across, for the matrix must stay positive. A port rests while a
/// step is solved.
///
/// The account belongs to the moment of the last forces, with the velocity that led there; the
/// residual is what the scheme has taken. What linear dampers take in a period is (v + v+) dt Z v+ / 2, by the
/// directions at its beginning, by which the scheme resists: so a damper that turns takes nothing. In the first
/// eight, in which velocities of the start die away and creeps begin, it is more by
///
///     (v+ - v) dt^2 Z (M + dt Z + dt^2 K)^-1 f / 2,     f = M (v+ - v) / dt + Z v+
///
/// The sum is exact for decay, and for creep with heavy dampers.
/// Source: Baraff, Witkin, Large steps in cloth simulation, 1998.
class ImplicitEuler final : public FullStepIntegrator {
 public:
  explicit ImplicitEuler(const NetworkDescription& network);

  void start(WorldState& world) noexcept override;
  Moved step(WorldState& world) noexcept override;
  Energy energy(WorldState& world) const noexcept override;

 private:
  double loss_of_creep(const WorldState& world) noexcept;
  double work_of_change_at_ports(const WorldState& world) noexcept;

  StiffnessMatrix matrix_;
  AlignedVector<double> change_;   // of the displacement of a period, then what it is solved for
  AlignedVector<double> carried_;  // of the first steps
  AlignedVector<double>& before_ = memory_;  // dt v that led to the moment of the last forces [m]
};

}  // namespace cordis::engine
