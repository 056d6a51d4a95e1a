// sim_node/engine/links/link_runs.cpp
#include "sim_node/engine/links/link_runs.h"

#include <algorithm>

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

/// How many of the links of a run, whole batches of rows, add to the forces of no MAT from last_mat on.
std::size_t fitting_length(std::span<const Link> run, std::size_t last_mat) noexcept {
  const std::size_t higher = std::max(run[0].mat_a, run[0].mat_b);
  const std::size_t rows = (last_mat - higher) / kLinkBatch * kLinkBatch;
  std::size_t length = run.size();
  while (length > 0 && run[length - 1].mat_a - run[0].mat_a >= rows) --length;
  return length;
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
    is_gathering_ = is_gathered;
  }
  void gather(std::uint32_t index, const Link& link) {
    if (!is_gathering_) {
      begin(link, true);
      gathered_ = 0;
    }
    put(index, gathered_++);
  }

 private:
  LinkArrangement& rows_;
  bool is_gathering_ = false;
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

void arrange_links(std::span<const Link> links, std::uint32_t first_link, bool with_runs,
                   std::size_t last_mat, LinkArrangement& rows) {
  Arranger arranger(rows);
  for (std::size_t l = 0; l < links.size();) {
    const std::size_t length = with_runs ? run_length(links, l) : 1;
    const std::size_t fitting = fitting_length(links.subspan(l, length), last_mat);
    const bool is_run = fitting >= LinkArrangement::kShortestRun;
    if (is_run) arranger.begin(links[l], false);
    for (const std::size_t first = l; l < first + (is_run ? fitting : length); ++l) {
      const auto index = static_cast<std::uint32_t>(first_link + l);
      if (is_run) {
        arranger.put(index, links[l].mat_a - links[first].mat_a);
      } else {
        arranger.gather(index, links[l]);
      }
    }
  }
}

MatLayout layout_of(const NetworkDescription& description) {
  const bool moves_by_axis = description.integrator == IntegratorKind::kCordis ||
                             description.integrator == IntegratorKind::kLeapfrog;
  const bool reads_columns =
      !moves_by_axis || description.freeze_tolerance > 0.0 || !description.state_links.empty() ||
      !description.maxwell_links.empty() || !description.bends.empty() || !description.sets.empty();
  if (reads_columns) return {};
  const std::size_t in_runs = linear_links_in_runs(description.links);
  const bool most = in_runs > 0 && 4 * in_runs >= 3 * description.links.size();
  return most ? MatLayout::by_axis(description.mats.size()) : MatLayout{};
}

}  // namespace cordis::engine
