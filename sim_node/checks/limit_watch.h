// sim_node/checks/limit_watch.h -- how near a scene comes to the limit of its step while it is
// played.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/plan/stability/liaison_graph.h"

namespace cordis::sim {

/// Keeps the largest K' + 2 Z' that the scene has had, over the liaisons in the states they were
/// in. For masses on each other it is the largest eigenvalue of M^-1 (dt^2 K + 2 dt Z). The rows of
/// plan::row_weights bound that from above, as in `cordis check`. Below 4 nothing diverges. Where they
/// certify nothing they are the weights of states that the scene may never enter. Then the rows of the weights
/// 1 / sqrt(m) bound it as well, and the smaller of the two counts. It has
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
  };

  struct Member {
    std::uint32_t set;
    std::uint32_t member;  // of the set, those of its first half first
    std::uint32_t mat;
    double partners;  // that count at least
  };

  /// What a vector of weights makes of the rows.
  struct Bound {
    std::vector<double> share;   // per MAT: 1 / m over its weight, or 0
    std::vector<double> steady;  // per MAT: sum over liaisons without states
    std::vector<double> both;    // per link with states: weights of its ends
    std::vector<double> number;  // per member: of one partner
  };

  Bound bound_of(const plan::LiaisonGraph& graph, const std::vector<double>& weight) const;
  double number_with(const Bound& bound, const engine::World& world) noexcept;

  double dt_;
  std::vector<StateLink> links_;
  std::vector<Member> members_;
  std::vector<double> slopes_;  // K dt^2 + 2 Z dt of the states of a state machine, for each link
  std::vector<Bound> bounds_;   // one or two
  std::vector<double> sum_;     // per MAT, room for update()
  double largest_ = 0.0;
};

}  // namespace cordis::sim
