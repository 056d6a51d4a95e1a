// sim_node/engine/matter/mat_blocks.cpp
#include "sim_node/engine/matter/mat_blocks.h"

#include <algorithm>

#include "node/assert.h"
#include "sim_node/engine/core/vector_width.h"

namespace cordis::engine {
namespace {

/// The MATs that a link joins.
struct Ends {
  std::uint32_t low;
  std::uint32_t high;
};

/// All links that the blocks take apart.
std::vector<Ends> ends_of(const NetworkDescription& description) {
  std::vector<Ends> ends;
  ends.reserve(description.links.size() + description.state_links.size() +
               description.maxwell_links.size() + description.bends.size());
  const auto add = [&ends](const auto& links) {
    for (const auto& link : links)
      ends.push_back({std::min(link.mat_a, link.mat_b), std::max(link.mat_a, link.mat_b)});
  };
  add(description.links);
  add(description.state_links);
  add(description.maxwell_links);
  for (const Bend& bend : description.bends) {
    const auto [low, high] = std::minmax({bend.mat_a, bend.mat_b, bend.mat_c});
    ends.push_back({low, high});
  }
  return ends;
}

/// How many MATs a link goes over; 1 % go farther.
std::size_t reach_of(const std::vector<Ends>& links) {
  std::vector<std::uint32_t> reach;
  reach.reserve(links.size());
  for (const Ends& link : links) reach.push_back(link.high - link.low);
  const auto place =
      reach.begin() + static_cast<std::ptrdiff_t>(reach.size() - reach.size() / 100 - 1);
  std::nth_element(reach.begin(), place, reach.end());
  return std::max<std::size_t>(1, *place);
}

std::size_t largest_set(const NetworkDescription& description) {
  std::size_t balls = 0;
  for (const SetLiaison& set : description.sets)
    balls = std::max(balls, set.set_p.size() + set.set_q.size());
  return balls;
}

/// Blocks, as far as the work lets there be.
std::size_t block_count(const NetworkDescription& description, std::size_t links) {
  const std::size_t balls = largest_set(description);
  const std::size_t by_links = links < MatBlocks::kMinLinks ? 1 : links / MatBlocks::kLinksOfBlock;
  const std::size_t by_balls = balls < MatBlocks::kMinBalls ? 1 : balls / MatBlocks::kBallsOfBlock;
  return std::min(std::max(by_links, by_balls), MatBlocks::kMaxBlocks);
}

}  // namespace

MatBlocks::MatBlocks(const NetworkDescription& description) : first_{0} {
  const std::size_t mat_count = description.mats.size();
  const std::vector<Ends> links = ends_of(description);
  const std::size_t by_work = block_count(description, links.size());
  const std::size_t reach = by_work == 1 || links.empty() ? 0 : reach_of(links);
  const std::size_t count = std::clamp<std::size_t>(mat_count / (kBatchRows + reach), 1, by_work);
  // The work of a MAT: itself, and the links that begin at it.
  std::vector<std::uint32_t> work(count > 1 ? mat_count : 0, 1);
  if (count > 1) {
    for (const Ends& link : links) ++work[link.low];
  }
  const std::size_t whole = mat_count + links.size();
  std::size_t done = 0;
  for (std::uint32_t i = 0; i < work.size(); ++i) {
    done += work[i];
    const std::size_t least = first_.back() + std::max<std::size_t>(kBatchRows, reach);
    if (i + 1 >= least && (i + 1) % kBatchRows == 0 && i + 1 + kBatchRows <= mat_count &&
        done >= whole * first_.size() / count) {
      first_.push_back(i + 1);
    }
  }
  first_.push_back(static_cast<std::uint32_t>(mat_count));
}

std::size_t MatBlocks::block_of(std::uint32_t mat) const noexcept {
  CORDIS_ASSERT(mat < first_.back());
  return static_cast<std::size_t>(std::upper_bound(first_.begin() + 1, first_.end(), mat) -
                                  (first_.begin() + 1));
}

std::size_t MatBlocks::group_of(std::uint32_t mat_a, std::uint32_t mat_b) const noexcept {
  if (count() == 1) return group_of_others();
  const std::size_t low = block_of(std::min(mat_a, mat_b));
  const std::size_t high = block_of(std::max(mat_a, mat_b));
  if (low == high) return low;
  return high == low + 1 ? group_between(low) : group_of_others();
}

MatBlocks::Mats MatBlocks::mats_of_group(std::size_t group) const noexcept {
  CORDIS_ASSERT(group < group_count());
  if (group == group_of_others()) return {0, first_.back()};
  if (group < count()) return {first(group), last(group)};
  const std::size_t place = group - count();
  const std::size_t even = count() / 2;  // groups from even blocks
  const std::size_t block = place < even ? 2 * place : 2 * (place - even) + 1;
  return {first(block), last(block + 1)};
}

}  // namespace cordis::engine
