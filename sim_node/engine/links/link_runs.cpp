// sim_node/engine/links/link_runs.cpp
#include "sim_node/engine/links/link_runs.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {
namespace {

/// Neighbouring MATs whose links are sorted together: what a core reads of them stays in its cache.
constexpr std::uint32_t kTile = 1024;

/// The MATs that a link joins.
struct LinkEnds {
  std::uint32_t low;
  std::uint32_t high;

  std::uint32_t distance() const noexcept { return high - low; }
};

std::vector<LinkEnds> ends_of(std::span<const Link> links) {
  std::vector<LinkEnds> ends;
  ends.reserve(links.size());
  for (const Link& link : links)
    ends.push_back({std::min(link.mat_a, link.mat_b), std::max(link.mat_a, link.mat_b)});
  return ends;
}

/// How many links from `first` on ascend together.
std::size_t run_length(std::span<const LinkEnds> links, std::size_t first) noexcept {
  std::size_t last = first;
  for (; last + 1 < links.size(); ++last) {
    const LinkEnds& now = links[last];
    const LinkEnds& next = links[last + 1];
    if (next.distance() != now.distance() || next.low <= now.low) break;
    if (next.low - now.low > LinkArrangement::kLargestGap + 1) break;
  }
  return last + 1 - first;
}

/// True if the rows of a run cost less than gathering its links.
bool is_worth_rows(std::span<const LinkEnds> run) noexcept {
  return run.size() >= LinkArrangement::kShortestRun &&
         2 * run.size() > run.back().low - run.front().low;
}

/// How many of the links of a run, whole batches of rows, add to the forces of no MAT from last_mat on.
std::size_t fitting_length(std::span<const LinkEnds> run, std::size_t last_mat) noexcept {
  const std::size_t rows = (last_mat - run[0].high) / kLinkBatch * kLinkBatch;
  std::size_t length = run.size();
  while (length > 0 && run[length - 1].low - run[0].low >= rows) --length;
  return length;
}

/// Calls visit(first, length, is_run) for one stretch of links after the other.
template <class Visit>
void for_each_run(std::span<const LinkEnds> links, const Visit& visit) {
  for (std::size_t l = 0; l < links.size();) {
    const std::size_t length = run_length(links, l);
    visit(l, length, is_worth_rows(links.subspan(l, length)));
    l += length;
  }
}

std::size_t count_in_runs(std::span<const LinkEnds> links) {
  std::size_t in_runs = 0;
  for_each_run(links, [&](std::size_t, std::size_t length, bool is_run) {
    if (is_run) in_runs += length;
  });
  return in_runs;
}

/// Sorts the links of a tile by distance, then by the lower MAT. Behind the links of a distance come those
/// that join two MATs again.
void sort_tile(std::span<const LinkEnds> ends, std::span<std::uint32_t> tile) {
  const auto key = [&](std::uint32_t link) {
    return std::uint64_t{ends[link].distance()} << 32U | ends[link].low;
  };
  std::sort(tile.begin(), tile.end(), [&](std::uint32_t first, std::uint32_t second) {
    return key(first) != key(second) ? key(first) < key(second) : first < second;
  });
  std::vector<std::uint32_t> again;
  for (auto place = tile.begin(); place != tile.end();) {
    const std::uint32_t distance = ends[*place].distance();
    const auto last = std::find_if(
        place, tile.end(), [&](std::uint32_t link) { return ends[link].distance() != distance; });
    again.clear();
    auto kept = place;
    for (auto link = place; link != last; ++link) {
      const bool is_again = kept != place && ends[*(kept - 1)].low == ends[*link].low;
      if (is_again) {
        again.push_back(*link);
      } else {
        *kept++ = *link;
      }
    }
    place = std::copy(again.begin(), again.end(), kept);
  }
}

/// Sorts the links of each tile, one tile after the other.
std::vector<std::uint32_t> sorted_links(std::span<const LinkEnds> ends) {
  std::vector<std::size_t> first(1, 0);
  for (const LinkEnds& link : ends) {
    const std::size_t tile = link.low / kTile;
    if (first.size() < tile + 2) first.resize(tile + 2, 0);
    ++first[tile + 1];
  }
  for (std::size_t tile = 1; tile < first.size(); ++tile) first[tile] += first[tile - 1];
  std::vector<std::size_t> place(first.begin(), first.end() - 1);
  std::vector<std::uint32_t> links(ends.size());
  for (std::uint32_t link = 0; link < ends.size(); ++link)
    links[place[ends[link].low / kTile]++] = link;
  for (std::size_t tile = 0; tile + 1 < first.size(); ++tile)
    sort_tile(ends, std::span(links).subspan(first[tile], first[tile + 1] - first[tile]));
  return links;
}

/// Takes the links in runs first, as sorted, then the others, as the network has them.
LinkOrder runs_first(std::span<const LinkEnds> ends, const std::vector<std::uint32_t>& sorted) {
  std::vector<LinkEnds> ends_in_order;
  ends_in_order.reserve(sorted.size());
  for (const std::uint32_t link : sorted) ends_in_order.push_back(ends[link]);
  LinkOrder order;
  order.links.reserve(sorted.size());
  std::vector<bool> is_taken(ends.size(), false);
  for_each_run(ends_in_order, [&](std::size_t first, std::size_t length, bool is_run) {
    if (!is_run) return;
    for (std::size_t l = first; l < first + length; ++l) {
      order.links.push_back(sorted[l]);
      is_taken[sorted[l]] = true;
    }
  });
  order.in_runs = order.links.size();
  for (std::uint32_t link = 0; link < ends.size(); ++link) {
    if (!is_taken[link]) order.links.push_back(link);
  }
  return order;
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

}  // namespace

LinkOrder order_in_runs(std::span<const Link> links) {
  const std::vector<LinkEnds> ends = ends_of(links);
  LinkOrder written{std::vector<std::uint32_t>(links.size()), count_in_runs(ends)};
  std::iota(written.links.begin(), written.links.end(), 0U);
  const std::size_t nearly_all = links.size() - links.size() / 16;
  if (written.in_runs >= nearly_all) return written;
  LinkOrder sorted = runs_first(ends, sorted_links(ends));
  return sorted.in_runs > written.in_runs ? sorted : written;
}

Link ascending(Link link, int dimension) noexcept {
  if (link.mat_a < link.mat_b) return link;
  std::swap(link.mat_a, link.mat_b);
  if (dimension == 1) link.rest_length = -link.rest_length;
  return link;
}

void arrange_links(std::span<const Link> links, std::uint32_t first_link, bool with_runs,
                   std::size_t last_mat, LinkArrangement& rows) {
  const std::vector<LinkEnds> ends = ends_of(links);
  Arranger arranger(rows);
  for (std::size_t l = 0; l < links.size();) {
    const std::size_t length = with_runs ? run_length(ends, l) : 1;
    const std::size_t fitting = fitting_length(std::span(ends).subspan(l, length), last_mat);
    const bool is_run = fitting > 0 && is_worth_rows(std::span(ends).subspan(l, fitting));
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
  const std::size_t in_runs = order_in_runs(description.links).in_runs;
  const bool most = in_runs > 0 && 4 * in_runs >= 3 * description.links.size();
  return most ? MatLayout::by_axis(description.mats.size()) : MatLayout{};
}

}  // namespace cordis::engine
