// sim_node/plan/stability/step_bound.h -- steps that are stable whatever the scene does.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/liaison_graph.h"

namespace cordis::plan {

/// The largest step that is surely stable, and what keeps it from being larger.
struct StepBound {
  double step = std::numeric_limits<double>::infinity();  ///< [s]; infinite where nothing pulls
  std::uint32_t mat = 0;             ///< the mass that is driven the hardest for its weight
  std::optional<LiaisonId> liaison;  ///< the strongest one at it; none: the medium
};

/// Stable is what keeps every eigenvalue of M^-1 (dt^2 K + 2 dt Z) below 4: exactly the limit of
/// the centred difference, and with LimitWeights that of the other integrators. A bound from above
/// on the eigenvalues is one from below on the step.

/// Edge bound of the centred difference: d_a / m_a + d_b / m_b over the liaisons, d the sum of a
/// MAT's slopes. O(liaisons).
StepBound edge_bound(const LiaisonGraph& graph);

/// The better of the edge bound and of 24 row bounds, max over i of (B x)_i / x_i, which hold for
/// any x > 0 (B the graph's matrix with all its entries positive; Collatz); x from power iteration.
/// Both hold in every pose and every combination of states, for the integrator of the network.
/// O(liaisons). Derived in docs/stability.md.
StepBound certified_bound(const engine::NetworkDescription& network, const LiaisonGraph& graph);

/// A row bound at a step.
struct RowWeights {
  std::vector<double> weight;  ///< x, per MAT; 0 where nothing moves
  double number = 0.0;         ///< max over i of (B x)_i / x_i: no eigenvalue is above it
};

/// The one of these row bounds that bounds the eigenvalues best at this step. O(liaisons).
/// @param enough  the first one whose number is below it is taken
RowWeights row_weights(const LiaisonGraph& graph, double step, double enough = 0.0);

/// The step at which dt^2 stiffness + 2 dt viscosity = 4, both for unit mass; infinite for 0 and 0.
double limit_step(double stiffness, double viscosity) noexcept;

}  // namespace cordis::plan
