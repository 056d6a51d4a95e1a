// sim_node/engine/links/link_runs.cpp
#include "sim_node/engine/links/link_runs.h"

#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {
namespace {

/// How many links from `first` on make a run.
std::size_t run_length(std::span<const Link> links, std::size_t first) noexcept {
  if (links[first].mat_a == links[first].mat_b) return 1;
  std::size_t last = first;
  while (last + 1 < links.size()) {
    const Link& now = links[last];
    const Link& next = links[last + 1];
    if (next.mat_a <= now.mat_a || next.mat_a - now.mat_a > LinkArrangement::kLargestGap + 1) break;
    if (next.mat_b <= now.mat_b || next.mat_b - now.mat_b != next.mat_a - now.mat_a) break;
    ++last;
  }
  return last + 1 - first;
}

/// Fills the rows of an arrangement, one link after the other.
class Arranger {
 public:
  explicit Arranger(LinkArrangement& rows) : rows_(rows) {}

  /// @param row  of the run or of the gathered rows, ascending
  void put(std::uint32_t link, std::size_t row) {
    const std::size_t place = rows_.runs.back().first_row + row;
    if (place >= rows_.link_of_row.size()) {
      rows_.link_of_row.resize(padded(place + 1, kLinkBatch), LinkArrangement::kEmpty);
      rows_.used_rows.resize(rows_.link_of_row.size() / kLinkBatch, 0);
    }
    rows_.link_of_row[place] = link;
    rows_.used_rows[place / kLinkBatch] =
        static_cast<std::uint8_t>(rows_.used_rows[place / kLinkBatch] | 1U << place % kLinkBatch);
    rows_.runs.back().row_count = rows_.link_of_row.size() - rows_.runs.back().first_row;
  }
  void begin(const Link& link, bool is_gathered) {
    rows_.runs.push_back({rows_.link_of_row.size(), 0, link.mat_a, link.mat_b, is_gathered});
  }
  void gather(std::uint32_t index, const Link& link) {
    if (rows_.runs.empty() || !rows_.runs.back().is_gathered) {
      begin(link, true);
      gathered_ = 0;
    }
    put(index, gathered_++);
  }

 private:
  LinkArrangement& rows_;
  std::size_t gathered_ = 0;  // links since the last run
};

std::size_t linear_links_in_runs(std::span<const Link> links) noexcept {
  std::size_t in_runs = 0;
  for (std::size_t l = 0; l < links.size();) {
    const std::size_t length = run_length(links, l);
    if (length >= LinkArrangement::kShortestRun) in_runs += length;
    l += length;
  }
  return in_runs;
}

}  // namespace

LinkArrangement arrange_links(std::span<const Link> links, bool with_runs) {
  LinkArrangement rows;
  rows.link_of_row.reserve(padded(links.size(), kLinkBatch));
  Arranger arranger(rows);
  for (std::size_t l = 0; l < links.size();) {
    const std::size_t length = with_runs ? run_length(links, l) : 1;
    const bool is_run = length >= LinkArrangement::kShortestRun;
    if (is_run) arranger.begin(links[l], false);
    for (const std::size_t first = l; l < first + length; ++l) {
      const auto index = static_cast<std::uint32_t>(l);
      if (is_run) {
        arranger.put(index, links[l].mat_a - links[first].mat_a);
      } else {
        arranger.gather(index, links[l]);
      }
    }
  }
  return rows;
}

MatLayout layout_of(const NetworkDescription& description) {
  const bool reads_columns =
      description.integrator != IntegratorKind::kCordis || description.freeze_tolerance > 0.0 ||
      !description.state_links.empty() || !description.maxwell_links.empty() ||
      !description.bends.empty() || !description.sets.empty();
  if (reads_columns) return {};
  const std::size_t in_runs = linear_links_in_runs(description.links);
  const bool most = in_runs > 0 && 4 * in_runs >= 3 * description.links.size();
  return most ? MatLayout::by_axis(description.mats.size()) : MatLayout{};
}

}  // namespace cordis::engine
