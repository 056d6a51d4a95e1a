// sim_node/engine/links/link_runs.h -- links whose ends ascend together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_layout.h"

namespace cordis::engine {

/// Rows of links, whole batches. In a run, row i joins MAT first_a + i to MAT first_b + i, so that
/// neither indices nor gathers are needed.
struct LinkRun {
  std::size_t first_row = 0;
  std::size_t row_count = 0;
  std::uint32_t first_a = 0;
  std::uint32_t first_b = 0;
  bool is_gathered = false;  ///< no run: any links, in their order
};

/// Links in rows for the step, in the order of order_in_runs(). Each MAT sums its forces in that order,
/// in runs or not.
///
/// A chain, the rows of a grid and what joins them come as runs of consecutive index pairs, the lower MAT
/// first. A run goes on over up to kLargestGap pairs that no link joins: their rows stay empty, as do
/// those that complete the last batch. Less than kShortestRun links make no run, nor do links in less
/// than half of its rows.
struct LinkArrangement {
  static constexpr std::uint32_t kEmpty = 0xFFFFFFFFU;
  static constexpr std::uint32_t kLargestGap = 3;
  static constexpr std::size_t kShortestRun = 8;

  std::vector<std::uint32_t> link_of_row;  ///< index of the link, or kEmpty
  std::vector<std::uint8_t> used_rows;     ///< used rows of each batch: bit i for its row i
  std::vector<LinkRun> runs;
};

/// An order of links.
struct LinkOrder {
  std::vector<std::uint32_t> links;  ///< indices of the links, the first to be computed first
  std::size_t in_runs = 0;           ///< how many of them come in runs
};

/// Orders links so that most of them come in runs. An order that has nearly all in runs stays, and so does
/// one that cannot be improved.
///
/// Else links are sorted by tiles of neighbouring MATs, then by the distance of their indices, then by the
/// lower index. Those in runs come first, the others behind them as they were. The order depends on
/// which MATs are joined, on no parameter.
LinkOrder order_in_runs(std::span<const Link> links);

/// Returns the link with its lower MAT first. Its forces have the same bits.
Link ascending(Link link, int dimension) noexcept;

/// Appends rows to an arrangement, in runs of their own.
/// @param links  each ascending, in the order of the rows  @param first_link  the index of the first
/// @param with_runs  else all are gathered
/// @param last_mat  one past the MATs whose forces the rows may add to, empty ones included: links of a run
/// that would go beyond are gathered
void arrange_links(std::span<const Link> links, std::uint32_t first_link, bool with_runs,
                   std::size_t last_mat, LinkArrangement& rows);

/// By axis where nothing but linear links reads the arrays of the MATs, and most links are in runs: a
/// world of `cordis` or `leapfrog` without states, sets, Maxwell elements, bends and freezing. By MAT
/// else. It depends on the structure of the network, on no parameter.
MatLayout layout_of(const NetworkDescription& description);

}  // namespace cordis::engine
