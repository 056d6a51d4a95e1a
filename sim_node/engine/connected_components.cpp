// sim_node/engine/connected_components.cpp
#include "sim_node/engine/connected_components.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "node/assert.h"
#include "sim_node/engine/core/vector_width.h"
#include "sim_node/engine/idle_state.h"

namespace cordis::engine {
namespace {

constexpr std::size_t kKeptPerMember = 64;  // pairs that there is room for
constexpr std::uint32_t kNoMember = std::numeric_limits<std::uint32_t>::max();

const SetLiaison& set_of(const NetworkDescription& network, std::size_t set) {
  if (set >= network.sets.size()) {
    throw std::invalid_argument("set " + std::to_string(set) + " does not exist");
  }
  return network.sets[set];
}

}  // namespace

ConnectedComponents::ConnectedComponents(const Network& network, std::size_t set)
    : ConnectedComponents(network.description(), set) {}

ConnectedComponents::ConnectedComponents(const NetworkDescription& network, std::size_t set)
    : ConnectedComponents(network, set_of(network, set).set_p, set_of(network, set).set_q) {}

ConnectedComponents::ConnectedComponents(const NetworkDescription& network,
                                         const std::vector<std::uint32_t>& mats)
    : ConnectedComponents(network, mats, {}) {}

ConnectedComponents::ConnectedComponents(const NetworkDescription& network,
                                         const std::vector<std::uint32_t>& set_p,
                                         const std::vector<std::uint32_t>& set_q)
    : count_p_(set_p.size()),
      across_(!set_q.empty()),
      dimension_(network.dimension),
      kernel_(&pair_kernel(best_vector_width())),
      grid_(count_p_, network.dimension),
      member_(network.mats.size(), kNoMember) {
  for (const auto* half : {&set_p, &set_q}) {
    for (const std::uint32_t mat : *half) {
      if (mat >= member_.size() || member_[mat] != kNoMember) {
        throw std::invalid_argument("MAT " + std::to_string(mat) + " does not exist, or twice");
      }
      member_[mat] = static_cast<std::uint32_t>(mat_.size());
      mat_.push_back(mat);
    }
  }
  joined_ = node::DisjointSets(mat_.size());
  component_.resize(mat_.size());
  found_.resize(count_p_ + kPairBatch);
  position_.resize(4 * (mat_.size() + kPairBatch), 0.0);
}

void ConnectedComponents::keep_near(double distance) {
  CORDIS_ASSERT(distance > 0.0);
  const std::size_t members = mat_.size();
  const std::size_t all = across_ ? count_p_ * (members - count_p_) : members * (members - 1) / 2;
  kept_.emplace(count_p_, members - count_p_, dimension_, distance,
                std::min(all, kKeptPerMember * members), *kernel_);
  kept_distance_ = distance;
}

std::size_t ConnectedComponents::find_near(const Columns& positions, double distance) noexcept {
  CORDIS_ASSERT(distance > 0.0);
  joined_.separate();
  for (std::size_t m = 0; m < mat_.size(); ++m) {
    std::copy_n(positions.col(mat_[m]).data(), 4, position_.data() + 4 * m);
  }
  if (kept_ && distance == kept_distance_) {
    join_kept(distance);
  } else {
    join_found(distance);
  }
  return number_components();
}

void ConnectedComponents::join_kept(double distance) noexcept {
  const double* position = position_.data();
  kept_->refresh(position);
  for (NeighbourRows rows = kept_->first_rows(position); rows.first < rows.last;
       rows = kept_->rows_after(rows, position)) {
    for (std::size_t a = rows.first; a < rows.last; ++a) {
      const double* position_a = position + 4 * a;
      for (std::size_t i = rows.start[a]; i < rows.start[a + 1]; ++i) {
        const std::uint32_t column = rows.neighbour[i - rows.origin];
        const double x = position[column] - position_a[0];
        const double y = position[column + 1] - position_a[1];
        const double z = position[column + 2] - position_a[2];
        if (!(x * x + y * y + z * z < distance * distance)) continue;
        joined_.join(static_cast<std::uint32_t>(a), column / 4);
      }
    }
  }
}

void ConnectedComponents::join_found(double distance) noexcept {
  grid_.fill(position_.data(), count_p_, distance);
  const CellTable table = grid_.table();
  for (std::size_t b = across_ ? count_p_ : 0; b < mat_.size(); ++b) {
    const double* point = position_.data() + 4 * b;
    if (!std::isfinite(point[0] + point[1] + point[2])) continue;
    const std::size_t last = std::min(b, count_p_);
    const NearQuery query{
        point[0], point[1], point[2], distance * distance, 0.0, static_cast<double>(last)};
    const CellGrid::NeighbourCells around = grid_.around(point, last);
    for (std::size_t r = 0; r < around.count; ++r) {
      const CellGrid::Run run = around.runs[r];
      const std::size_t count = kernel_->find_near(table, run.begin, run.end, query, found_.data());
      for (std::size_t i = 0; i < count; ++i)
        joined_.join(found_[i], static_cast<std::uint32_t>(b));
    }
  }
}

std::size_t ConnectedComponents::find_bound(std::span<const BoundPair> pairs) noexcept {
  joined_.separate();
  for (const BoundPair& pair : pairs) join(pair);
  return number_components();
}

std::size_t ConnectedComponents::find_bound(const World& world, std::size_t set) noexcept {
  joined_.separate();
  join_bound(world, set);
  return number_components();
}

void ConnectedComponents::join_bound(const World& world, std::size_t set) noexcept {
  const VisitBoundPair add = [](void* owner, const BoundPair& pair) {
    static_cast<ConnectedComponents*>(owner)->join(pair);
  };
  world.visit_bound_pairs(set, add, this);
}

std::size_t ConnectedComponents::find_joined(const World& world,
                                             std::span<const std::uint32_t> sets,
                                             std::span<const std::uint32_t> state_links) noexcept {
  joined_.separate();
  for (const std::uint32_t set : sets) join_bound(world, set);
  const std::vector<StateLink>& links = world.network().description().state_links;
  for (const std::uint32_t link : state_links) {
    CORDIS_ASSERT(link < links.size());
    if (!is_idle(world, link)) join(BoundPair{links[link].mat_a, links[link].mat_b});
  }
  return number_components();
}

void ConnectedComponents::join(const BoundPair& pair) noexcept {
  CORDIS_ASSERT(pair.mat_a < member_.size() && pair.mat_b < member_.size());
  const std::uint32_t a = member_[pair.mat_a];
  const std::uint32_t b = member_[pair.mat_b];
  if (a != kNoMember && b != kNoMember) joined_.join(a, b);
}

/// The root of a component is its first member, so that its number is known to all later ones.
std::size_t ConnectedComponents::number_components() noexcept {
  std::uint32_t count = 0;
  for (std::uint32_t m = 0; m < component_.size(); ++m) {
    const std::uint32_t root = joined_.root_of(m);
    component_[m] = root == m ? count++ : component_[root];
  }
  return count;
}

}  // namespace cordis::engine
