// sim_node/plan/stability/condition_map.h -- at which elongations exits may hold.
#pragma once

#include <cstddef>
#include <vector>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// One exit, for each cell of elongations.
struct Holding {
  std::vector<bool> may_hold;
  std::vector<bool> may_fail;
  /// Likewise where the ends come nearer, and where they part.
  std::vector<bool> may_fail_shortening;
  std::vector<bool> may_fail_lengthening;
};

/// Elongations side by side, fine near 0, at thresholds of the conditions and at the corners of tables.
class ConditionMap {
 public:
  /// O(exits), some hundred enclosures each.
  /// @param rest_length  at the start [m]
  /// @param step         how far a step goes at most: conditions ask for the force of the step before [m]
  ConditionMap(const engine::StateMachine& machine, double rest_length, double step,
               const Reach& reach);

  /// They touch each other; the first and the last one have no end.
  const std::vector<Interval>& cells() const noexcept { return cells_; }
  const Holding& of_exit(std::size_t exit) const { return exits_[exit]; }
  /// False once exits on the ways to a state moved the rest length, but for one to the same number.
  bool knows_rest(std::size_t state) const { return rests_[state].size() == 1; }
  /// The rest length in a state where it is known, else that of the start [m].
  double rest(std::size_t state) const {
    return knows_rest(state) ? rests_[state].front() : rest_length_;
  }
  double scale() const noexcept { return scale_; }  ///< [m]

  static constexpr double kAtRest = 1e-6;  ///< the narrowest cell at 0, in scales

 private:
  void find_known_rests();
  void refine();
  double far_away() const;
  std::vector<double> edges() const;
  Interval force_before(std::size_t state, const Interval& cell) const;
  Interval truth(std::size_t state, const engine::Transition& exit, const Interval& cell,
                 const Interval& speed) const;
  Holding holding_of(std::size_t state, const engine::Transition& exit) const;

  const engine::StateMachine& machine_;
  double rest_length_;
  double step_;  // [m]
  const Reach& reach_;
  double scale_;
  std::vector<std::vector<double>> rests_;  // of each state: two or none stand for any
  std::vector<Interval> cells_;
  std::vector<Holding> exits_;
};

}  // namespace cordis::plan
