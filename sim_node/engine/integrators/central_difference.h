// sim_node/engine/integrators/central_difference.h -- the scheme of the paper.
#pragma once

#include "sim_node/engine/integrators/integrator.h"

namespace cordis::engine {

/// All forces from the present positions, then all positions from these forces,
/// x(n+1) = 2 x(n) - x(n-1) + (dt^2 / m) f(n). The delayed positions at step 0 are those of the
/// half-step velocity v0 - a0 dt / 2, which keeps the start of second order.
/// [Luc90 III Calculability]
class CentralDifference final : public Integrator {
 public:
  void start(WorldState& world) noexcept override;
  Moved step(WorldState& world) noexcept override;
  Energy energy(WorldState& world) const noexcept override;
};

}  // namespace cordis::engine
