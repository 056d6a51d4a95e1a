// sim_node/engine/matter/mat_blocks.h -- neighbouring MATs that one thread of a team takes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"

namespace cordis::engine {

/// The MATs of a network in blocks of neighbours (domain decomposition).
///
/// First come the links within each block, then those from a block to the next, then all others. So each MAT
/// sums its forces in an order that depends on the network alone, not on how many threads there are.
class MatBlocks {
 public:
  /// Links, below which there is one block: linear ones, those with states, Maxwell elements, bends.
  static constexpr std::size_t kMinLinks = 16384;
  /// Links of a block, on average at least.
  static constexpr std::size_t kLinksOfBlock = 1024;
  static constexpr std::size_t kMaxBlocks = 128;
  /// Balls of a set that count like as many links.
  static constexpr std::size_t kMinBalls = 4096;
  static constexpr std::size_t kBallsOfBlock = 256;

  /// As many blocks as leave no more than 1 % of the links to the others, with as much work
  /// in each as that lets them have. There is one block where the network has few links and
  /// no large set, or links that join MATs of any two places.
  explicit MatBlocks(const NetworkDescription& description);

  std::size_t count() const noexcept { return first_.size() - 1; }
  std::uint32_t first(std::size_t block) const noexcept { return first_[block]; }
  std::uint32_t last(std::size_t block) const noexcept {
    return first_[block + 1];
  }  ///< one past it
  std::size_t block_of(std::uint32_t mat) const noexcept;

  /// Links come in groups: count() within a block, count() - 1 from one to the next, one of all others; of one
  /// block alone, one of all.
  std::size_t group_count() const noexcept { return group_of_others() + 1; }
  std::size_t group_of(std::uint32_t mat_a, std::uint32_t mat_b) const noexcept;
  /// From this block to the next: those from even blocks come before those from odd ones, for no two of
  /// either join one MAT.
  std::size_t group_between(std::size_t block) const noexcept {
    return count() + block / 2 + (block % 2 == 0 ? 0 : count() / 2);
  }
  std::size_t group_of_others() const noexcept { return count() > 1 ? 2 * count() - 1 : 0; }
  /// The MATs [first, last) that the links of a group join, at most.
  struct Mats {
    std::uint32_t first;
    std::uint32_t last;
  };
  Mats mats_of_group(std::size_t group) const noexcept;

 private:
  std::vector<std::uint32_t> first_;  // MAT of each block, then the number of MATs
};

}  // namespace cordis::engine
