// sim_node/limit_watch.h -- how near a scene comes to the limit of its step while it is played.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/world.h"

namespace cordis::sim {

/// Keeps the largest K' + 2 Z' that a mass has had, over the liaisons that pulled at it in the
/// states they were in: 2 sum (K dt^2 + 2 Z dt) / m, as if its neighbours moved against it. Below 4
/// nothing diverges; what they count for in the limit of the other integrators is in it
/// (plan::LimitWeights). Liaisons count with the largest slopes of their states; sets, whose pairs
/// come and go, with as many contacts as there is room for.
class LimitWatch {
 public:
  explicit LimitWatch(const engine::NetworkDescription& network);

  /// Looks at the present states. Real time: O(MATs + links), no allocation.
  void look(const engine::World& world) noexcept;
  double largest() const noexcept { return largest_; }

 private:
  struct StateLink {
    std::uint32_t mat_a;
    std::uint32_t mat_b;
    std::uint32_t first;  // its states, in slopes_
  };

  std::vector<double> share_;   // per MAT: 2 / m, or 0
  std::vector<double> steady_;  // per MAT: sum over liaisons without states
  std::vector<double> sum_;     // per MAT, at the last look
  std::vector<StateLink> links_;
  std::vector<double> slopes_;  // K dt^2 + 2 Z dt of the states of a behaviour, for each link
  double largest_ = 0.0;
};

}  // namespace cordis::sim
