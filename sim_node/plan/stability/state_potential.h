// sim_node/plan/stability/state_potential.h -- what a state stores over the elongation.
#pragma once

#include <cstddef>
#include <vector>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/program_enclosure.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// The potential of a state at rest, within its limits, summed up over cells of elongations: 0 at the elongation 0.
class StatePotential {
 public:
  /// @param cells  they touch each other, one begins at 0, and the first and the last one have no end
  /// @param share  of the force between the weakest and the strongest that any masses of the reach have, 0 to 1
  StatePotential(const engine::LinkState& state, double rest_length,
                 const std::vector<Interval>& cells, double share, const Reach& reach);

  double tension(double elongation) const;  ///< [N]; 0 where it is no finite number
  double at(double elongation) const;       ///< [J]; finite elongations alone
  /// The least potential in a part [J]; -infinity where it falls without an end.
  double least(const Interval& part) const;
  const std::vector<double>& edges() const noexcept { return edges_; }  ///< finite, ascending [m]

 private:
  /// The tension at an elongation.
  struct Sample {
    double elongation = 0.0;  // [m]
    double tension = 0.0;     // [N]
  };
  static constexpr int kHalvings = 10;

  double sum(double from, double to) const;
  Sample sample(double elongation) const { return {elongation, tension(elongation)}; }
  double sum_of_part(const Sample& from, const Sample& middle, const Sample& to,
                     int halvings) const;

  const engine::LinkState& state_;
  double rest_length_;
  double share_;
  const Reach& reach_;
  std::vector<double> edges_;
  std::vector<double> at_edge_;
  double size_ = 0.0;  // the largest at an edge, either way
};

}  // namespace cordis::plan
