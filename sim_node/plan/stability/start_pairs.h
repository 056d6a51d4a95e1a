// sim_node/plan/stability/start_pairs.h -- the pairs of a set in the pose of its start.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// A pair of members; members are numbered from 0, those of the second set after those of the
/// first.
struct StartPair {
  std::uint32_t member_a;
  std::uint32_t member_b;
  double distance;  ///< [m], > 0 but of a surface, where it may be below, and of at_one_point()
};

/// The pairs of a set nearer than its range at the start, by the engine's neighbour search: O(members
/// + pairs); with surfaces O(members x surfaces).
class StartPairs {
 public:
  /// So many pairs are kept; where there are more they are counted alone.
  static constexpr std::size_t kMaxPairs = std::size_t{1} << 20;

  StartPairs(const engine::NetworkDescription& network, const engine::SetLiaison& set);

  bool are_kept() const noexcept { return kept_; }
  const std::vector<StartPair>& pairs() const noexcept { return pairs_; }  ///< none unless kept
  /// Two members, not both fixed, that are at one point: no pair, for it exerts no force. Its first two.
  const std::optional<StartPair>& at_one_point() const noexcept { return at_one_point_; }
  /// By member: how many others are in range.
  const std::vector<std::uint32_t>& counts() const noexcept { return counts_; }

 private:
  void measure_surfaces(const engine::NetworkDescription& network, const engine::SetLiaison& set);

  std::vector<StartPair> pairs_;
  std::vector<std::uint32_t> counts_;
  bool kept_ = true;
  std::optional<StartPair> at_one_point_;
};

/// Rest length of a pair of a set [m].
double rest_length_of(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                      std::uint32_t mat_a, std::uint32_t mat_b);

/// True if one of two MATs is no fixed point.
inline bool any_moves(const engine::NetworkDescription& network, std::uint32_t mat_a,
                      std::uint32_t mat_b) {
  return network.mats[mat_a].kind != engine::MatKind::kFixed ||
         network.mats[mat_b].kind != engine::MatKind::kFixed;
}

/// The MAT of a member.
inline std::uint32_t mat_of(const engine::SetLiaison& set, std::uint32_t member) {
  const std::size_t count_p = set.set_p.size();
  return member < count_p ? set.set_p[member] : set.set_q[member - count_p];
}

}  // namespace cordis::plan
