// node/disjoint_sets.h -- which of some members are joined, directly or by others.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "node/assert.h"

namespace cordis::node {

/// A union-find structure over members 0 to count - 1. The root of a set is its lowest member.
class DisjointSets {
 public:
  /// Every member is a set of its own. Allocates.
  explicit DisjointSets(std::size_t count = 0) : parent_(count) { separate(); }

  std::size_t count() const noexcept { return parent_.size(); }

  /// Makes every member a set of its own again. Real time: O(members), no allocation.
  void separate() noexcept { std::iota(parent_.begin(), parent_.end(), 0U); }

  /// Makes one set of those of two members. Real time: about O(1), no allocation.
  void join(std::uint32_t a, std::uint32_t b) noexcept {
    const std::uint32_t root_a = root_of(a);
    const std::uint32_t root_b = root_of(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

  /// The lowest member of the set of a member. It makes the way there shorter. Real time: about O(1), no allocation.
  std::uint32_t root_of(std::uint32_t member) noexcept {
    CORDIS_ASSERT(member < parent_.size());
    while (parent_[member] != member) {
      parent_[member] = parent_[parent_[member]];
      member = parent_[member];
    }
    return member;
  }

 private:
  std::vector<std::uint32_t> parent_;  // a lower member of the same set, or itself
};

}  // namespace cordis::node
