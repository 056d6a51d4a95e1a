// sim_node/engine/integrators/leapfrog.h -- the scheme of the paper with dampers of second order.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/integrators/full_step_integrator.h"
#include "sim_node/engine/integrators/implicit_damping.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/stiff_friction.h"
#include "sim_node/engine/matter/mat_layout.h"

namespace cordis::engine {

/// Leapfrog: positions at the steps, velocities between them, as `cordis`; but dampers, conditions
/// and the medium see the velocity of the moment of x(n), extrapolated, 1.5 v(n-1/2) - 0.5
/// v(n-3/2). With it every viscosity, of links, of states, of sets, is of second order. Stable
/// while 4 M - dt^2 K - 4 dt Z > 0.
///
/// Where linear links or the medium are too viscous for that (damps_implicitly), ImplicitDamping
/// solves them, and 3.852 M - dt^2 K > 0 is enough. Where the viscosity of state links is
/// (friction, bows), they are solved one by one (StiffFriction), with the same limit. Sets are always
/// extrapolated.
///
/// The velocity of driven ports is centred, as their next place is known. That of other ports is that
/// of the last period. Maxwell elements answer to the elongation increment. The account belongs to
/// the moment of the last forces, all but the kinetic energy in closed form. That is the energy of the centred velocity (x(n+1) - x(n-1)) / 2 dt. With
/// implicit dampers it is the mean of those of the two velocities. What finite steps do to it is
/// the residual, of second order; implicit dampers, and all dampers beside them, whose work is that
/// of their forces, leave none.
class Leapfrog final : public FullStepIntegrator {
 public:
  explicit Leapfrog(const NetworkDescription& network);

  void start(WorldState& world) noexcept override;
  Moved step(WorldState& world) noexcept override;
  void adopt(WorldState& world) noexcept override;
  Energy energy(WorldState& world) const noexcept override;
  Vec3 velocity(const WorldState& world, std::uint32_t mat) const noexcept override;

  void serialize(Archive& archive) override;

 private:
  double correct_forces(WorldState& world) noexcept override;
  double stop_what_rests(WorldState& world) noexcept;
  void feel_ports(const WorldState& world) noexcept;
  void begin_damping(WorldState& world) noexcept;
  std::uint32_t advance_damped(WorldState& world, StepEnergy& energy) noexcept;
  Vec3 extrapolated(std::size_t mat) const noexcept {
    return layout_.vector(extrapolated_.data(), mat);
  }
  void set_extrapolated(std::size_t mat, const Vec3& position) noexcept {
    layout_.set_vector(extrapolated_.data(), mat, position);
  }
  double* last_kick() noexcept { return memory_.data() + memory_.size() - 2 - velocity_.size(); }
  double& last_kick_count() noexcept { return memory_[memory_.size() - 2]; }
  bool has_last_kick() const noexcept { return memory_[memory_.size() - 2] != 0.0; }
  Vec3 centred_displacement(const WorldState& world, std::uint32_t mat) const noexcept;

  // memory_: extrapolated, stored as the MATs are; then of implicit dampers the kick of the last step, 4 x N,
  // 1 if there is one, and the kinetic energy of the moment of the last forces [J].
  AlignedVector<double>& extrapolated_ = memory_;  // x(n) - dt v(n) [m]
  std::unique_ptr<ImplicitDamping> damping_;       // none: dampers see the extrapolated velocity
  StiffFriction stiff_friction_;
  MatLayout layout_;
  AlignedVector<double> velocity_;  // dt v(n-1/2), 4 x N [m]
  AlignedVector<double>
      losses_;  // explicit forces that store no energy, 4 x N [N]; empty without any
};

}  // namespace cordis::engine
