// sim_node/checks/pair_watch.h -- how hard two balls of a set may meet in a run.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/plan/reach_limit.h"

namespace cordis::sim {

/// Holds the motion of the two fastest members of a set against the energy at which Lennard-Jones is too stiff for
/// the step: plan::stable_pairs(). Balls that are away have it before they meet. What a pair stores at the start
/// shows when it parts.
class PairWatch {
 public:
  explicit PairWatch(const engine::NetworkDescription& network);

  /// After each step. A set of 64 n members or more is looked at in one of n + 1 steps, so that it takes a few percent
  /// of the time of its forces. Real time: O(members), no allocation.
  void update(const engine::World& world) noexcept;

  /// True once two members of a set had more.
  bool is_passed() const noexcept { return passed_; }

 private:
  std::vector<plan::PairLimit> limits_;
  std::vector<std::uint64_t> stride_;  // of each limit: looked at in one of so many steps
  bool passed_ = false;
};

}  // namespace cordis::sim
