// sim_node/checks/limit_watch.h -- how near a scene comes to the limit of its step while it is
// played.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/world.h"

namespace cordis::sim {

/// Keeps the largest K' + 2 Z' that the scene has had, over the liaisons in the states they were
/// in. For masses on each other it is the largest eigenvalue of M^-1 (dt^2 K + 2 dt Z). The rows of
/// plan::row_weights bound that from above, as in `cordis check`. Below 4 nothing diverges. It has
/// what viscosities count for in the limit of the other integrators (plan::LimitWeights). Liaisons
/// count with the largest slopes of their states; a member of a set with as many partners as
/// plan::partner_bounds() says, or as it has where these are more.
class LimitWatch {
 public:
  explicit LimitWatch(const engine::NetworkDescription& network);

  /// Looks at the present states and partners. Real time: O(MATs + links + members of sets), no
  /// allocation.
  void update(const engine::World& world) noexcept;
  double largest() const noexcept { return largest_; }

 private:
  struct StateLink {
    std::uint32_t mat_a;
    std::uint32_t mat_b;
    std::uint32_t first;  // its states, in slopes_
    double both;          // weights of its ends
  };

  struct Member {
    std::uint32_t set;
    std::uint32_t member;  // of the set, those of its first half first
    std::uint32_t mat;
    double partners;  // that count at least
    double number;    // of one partner
  };

  std::vector<double> share_;   // per MAT: 1 / m over its weight, or 0
  std::vector<double> steady_;  // per MAT: sum over liaisons without states
  std::vector<double> sum_;     // per MAT, at the last update
  std::vector<StateLink> links_;
  std::vector<Member> members_;
  std::vector<double> slopes_;  // K dt^2 + 2 Z dt of the states of a state machine, for each link
  double largest_ = 0.0;
};

}  // namespace cordis::sim
