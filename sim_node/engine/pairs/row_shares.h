// sim_node/engine/pairs/row_shares.h -- how the threads of a team share the pairs of a set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/pairs/pair_block.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// The members of a set in shares of neighbours, one of each thread.
///
/// A thread computes all pairs of its members, and gives forces to them alone. So a pair of two shares is computed
/// twice. First come the pairs with members of earlier shares, row by row, then the own rows. Each member sums its
/// forces in the order that one thread has, and the bits do not depend on the shares. These follow the work: as long
/// as members stand in space about as they are numbered, few pairs are of two shares.
class RowShares {
 public:
  /// Members, below which a set is not shared.
  static constexpr std::size_t kMinMembers = 4096;
  /// Rows with more neighbours are not shared.
  static constexpr std::size_t kMaxRow = 1024;

  /// The share of one thread.
  struct alignas(64) Share {
    explicit Share(std::size_t room_for_earlier);

    std::size_t first = 0;  // member
    std::size_t last = 0;   // one past the last
    /// Parts of rows of earlier shares: the neighbours in this one.
    std::vector<PartOfRow> earlier;
    std::size_t earlier_wanted = 0;  // parts there were, though there may be no room for all
    std::size_t earlier_work = 0;    // that they take
    bool has_long_rows = false;
    std::uint32_t largest_partners = 0;
    PairBlock block;
  };

  RowShares() = default;
  /// @param unit  members that are not divided
  RowShares(std::size_t member_count, std::size_t unit);

  /// True if the set may be shared.
  bool exist() const noexcept { return member_count_ > 0; }
  /// Makes room for a team, and for what the last division lacked. Allocates.
  void make_room(std::size_t team_size);
  bool lacks_room(std::size_t team_size) const noexcept;
  std::size_t room() const noexcept { return shares_.size(); }

  /// Divides the members. @return true if the shares are fit for use
  /// @param list_number  of the list of rows: the same number, the same list
  bool divide(const NeighbourRows& rows, std::size_t list_number, ThreadTeam& team) noexcept;
  Share& share(std::size_t member) noexcept { return shares_[member]; }
  void forget() noexcept { team_size_ = 0; }

 private:
  void choose_members(const NeighbourRows& rows, std::size_t team_size) noexcept;
  void find_earlier(const NeighbourRows& rows, Share& share) const noexcept;

  std::size_t member_count_ = 0;
  std::size_t unit_ = 1;
  std::vector<Share> shares_;
  std::size_t team_size_ = 0;  // of the last division; 0: none
  std::size_t list_number_ = 0;
  bool is_fit_ = false;
};

}  // namespace cordis::engine
