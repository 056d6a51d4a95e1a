// sim_node/engine/links/link_groups.h -- links in the groups of the MatBlocks, which a team shares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/matter/mat_blocks.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// Calls a loop for each group, and sums the works.
class LinkGroups {
 public:
  explicit LinkGroups(const MatBlocks& blocks) : blocks_(blocks), works_(blocks.group_count()) {}

  const MatBlocks& blocks() const noexcept { return blocks_; }
  bool are_one() const noexcept { return blocks_.group_count() == 1; }

  /// Calls add_group(group) once for each group. Those that run at the same time join no MAT in common.
  /// Real time: no allocation, O(groups) beside the calls.
  template <class AddGroup>
  void run(ThreadTeam& team, const AddGroup& add_group) const noexcept {
    const std::size_t block_count = blocks_.count();
    const auto share_groups = [&](std::size_t member) noexcept {
      const ThreadTeam::Share blocks = team.share(member, block_count);
      for (std::size_t block = blocks.first; block < blocks.last; ++block) add_group(block);
      for (const std::size_t parity : {0U, 1U}) {
        team.meet();
        for (std::size_t block = blocks.first; block < blocks.last; ++block) {
          if (block % 2 == parity && block + 1 < block_count)
            add_group(blocks_.group_between(block));
        }
      }
    };
    if (block_count > 1) team.run(share_groups);
    add_group(blocks_.group_of_others());
  }

  /// Likewise add_group(group, work). @return the works of all, summed in the order of the groups
  template <class AddGroup>
  LinkWork add(ThreadTeam& team, const AddGroup& add_group) noexcept {
    run(team, [&](std::size_t group) noexcept {
      works_[group] = {};
      add_group(group, works_[group]);
    });
    LinkWork sum;
    for (const LinkWork& work : works_) {
      for (std::size_t place = 0; place < kLinkBatch; ++place) {
        sum.elastic[place] += work.elastic[place];
        sum.dissipated[place] += work.dissipated[place];
      }
    }
    return sum;
  }

 private:
  MatBlocks blocks_;
  AlignedVector<LinkWork> works_;  // of each group in this step
};

/// Links by groups, within one in link order.
struct GroupedOrder {
  std::vector<std::uint32_t> links;  ///< by place
  std::vector<std::size_t> first;    ///< place of each group; and one more, which ends the last
};

/// @param group_of_link  group of each link
GroupedOrder by_group(const std::vector<std::size_t>& group_of_link, std::size_t group_count);

/// Rows for links, in whole batches group by group. A row of padding joins a MAT of its group to itself.
struct GroupedRows {
  static constexpr std::uint32_t kPadding = 0xFFFFFFFFU;

  /// @param batch  rows that a loop takes at once
  /// @param column_a, column_b  become 4 * MAT index of the ends of each row
  template <class Links>
  GroupedRows(const Links& links, const MatBlocks& blocks, std::size_t batch,
              AlignedVector<std::uint32_t>& column_a, AlignedVector<std::uint32_t>& column_b);

  std::size_t count() const noexcept { return link_of_row.size(); }
  std::size_t count(std::size_t group) const noexcept { return first[group + 1] - first[group]; }
  bool is_padding(std::size_t row) const noexcept { return link_of_row[row] == kPadding; }

  std::vector<std::uint32_t> link_of_row;  ///< index of the link, or kPadding
  std::vector<std::uint32_t> row_of_link;
  std::vector<std::size_t> first;         ///< row of each group; and one more, which ends the last
  std::vector<std::size_t> links_before;  ///< number of links in the groups before each group

 private:
  /// @return MATs of the rows of padding, in the order of the rows
  std::vector<std::uint32_t> fill(const std::vector<std::size_t>& group_of_link,
                                  const MatBlocks& blocks, std::size_t batch);
};

template <class Links>
GroupedRows::GroupedRows(const Links& links, const MatBlocks& blocks, std::size_t batch,
                         AlignedVector<std::uint32_t>& column_a,
                         AlignedVector<std::uint32_t>& column_b) {
  std::vector<std::size_t> group;
  group.reserve(links.size());
  for (const auto& link : links) group.push_back(blocks.group_of(link.mat_a, link.mat_b));
  const std::vector<std::uint32_t> padding_mats = fill(group, blocks, batch);
  column_a.resize(count());
  column_b.resize(count());
  auto padding_mat = padding_mats.begin();
  for (std::size_t row = 0; row < count(); ++row) {
    if (is_padding(row)) {
      column_a[row] = column_b[row] = 4 * *padding_mat++;
    } else {
      column_a[row] = 4 * links[link_of_row[row]].mat_a;
      column_b[row] = 4 * links[link_of_row[row]].mat_b;
    }
  }
}

}  // namespace cordis::engine
