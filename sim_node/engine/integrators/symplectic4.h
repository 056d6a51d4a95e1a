// sim_node/engine/integrators/symplectic4.h -- the fourth order for scenes without viscosity.
#pragma once

#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/integrators/integrator.h"

namespace cordis::engine {

/// Six evaluations of the forces a step, between seven pushes and six drifts, symmetric in time and
/// symplectic: order 4, no drift of the energy. For scenes that conserve it; what has viscosity,
/// states, a port or a Maxwell element is refused (refusal_of). An undamped vibration w is stable
/// while w dt < kSymplectic4Limit. Contacts that come and go between two evaluations take the order
/// away, but no more energy than they do with other integrators.
///
/// Velocities are those of the moments x(n), and so is the account; the residual is what finite
/// steps have done. The delayed positions are x(n) - dt v(n).
/// Source: Blanes, Moan, Practical symplectic partitioned Runge-Kutta and Runge-Kutta-Nystrom
/// methods, 2002 (order 4, 6 stages, b).
class Symplectic4 final : public Integrator {
 public:
  explicit Symplectic4(const NetworkDescription& network);

  void start(WorldState& world) noexcept override;
  Moved step(WorldState& world) noexcept override;
  void adopt(WorldState& world) noexcept override;
  Energy energy(WorldState& world) const noexcept override;
  Vec3 velocity(const WorldState& world, std::uint32_t mat) const noexcept override;

  void serialize(Archive& archive) override;

 private:
  static void find_forces(WorldState& world) noexcept;
  static void add_forces(WorldState& world) noexcept;

  AlignedVector<double> velocity_;  // v(n) [m/s], 4 x N
};

}  // namespace cordis::engine
