// sim_node/plan/stability/start_pairs.cpp
#include "sim_node/plan/stability/start_pairs.h"

#include <algorithm>

#include "sim_node/engine/core/vector_width.h"
#include "sim_node/engine/pairs/neighbour_list.h"

namespace cordis::plan {
namespace {

constexpr std::size_t kFirstPerMember = 16;  // room for pairs, before more is made

std::size_t pairs_of_all(const engine::SetLiaison& set) {
  const std::size_t p = set.set_p.size();
  return set.set_q.empty() ? p * (p - 1) / 2 : p * set.set_q.size();
}

/// True if no two MATs can be out of range of each other.
bool reaches_all(const engine::NetworkDescription& network, const engine::SetLiaison& set) {
  engine::Vec3 lowest = network.mats[set.set_p[0]].position;
  engine::Vec3 highest = lowest;
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      lowest = lowest.cwiseMin(network.mats[mat].position);
      highest = highest.cwiseMax(network.mats[mat].position);
    }
  }
  return (highest - lowest).norm() < set.range;
}

}  // namespace

void StartPairs::measure_surfaces(const engine::NetworkDescription& network,
                                  const engine::SetLiaison& set) {
  const std::size_t count_p = set.set_p.size();
  counts_.assign(count_p + set.set_q.size(), 0U);
  for (std::size_t s = 0; s < count_p; ++s) {
    const engine::Surface& surface = *engine::surface_of(network, set.set_p[s]);
    const engine::Vec3& centre = network.mats[surface.mat].position;
    for (std::size_t m = 0; m < set.set_q.size(); ++m) {
      const engine::SurfaceDistance from =
          engine::distance_from(surface, centre, network.mats[set.set_q[m]].position);
      if (!(from.distance < set.range) || from.is_beyond) continue;
      const auto first = static_cast<std::uint32_t>(s);
      const auto second = static_cast<std::uint32_t>(count_p + m);
      pairs_.push_back({first, second, from.distance});
      ++counts_[first];
      ++counts_[second];
    }
  }
}

StartPairs::StartPairs(const engine::NetworkDescription& network, const engine::SetLiaison& set) {
  if (engine::acts_on_surfaces(network, set)) {
    measure_surfaces(network, set);
    return;
  }
  const std::size_t count_p = set.set_p.size();
  const std::size_t count_q = set.set_q.size();
  const std::size_t all = pairs_of_all(set);
  if (all > kMaxPairs && reaches_all(network, set)) {
    const std::size_t others_of_p = count_q > 0 ? count_q : count_p - 1;
    counts_.assign(count_p, static_cast<std::uint32_t>(others_of_p));
    counts_.insert(counts_.end(), count_q, static_cast<std::uint32_t>(count_p));
    kept_ = false;
    return;
  }
  engine::NeighbourList list(count_p, count_q, network.dimension, set.range,
                             std::min({all, kMaxPairs, kFirstPerMember * (count_p + count_q)}),
                             engine::pair_kernel(engine::best_vector_width()));
  list.hold_skin(0.0);
  engine::AlignedVector<double> position;
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      const engine::Vec3& place = network.mats[mat].position;
      position.insert(position.end(), {place.x(), place.y(), place.z(), 0.0});
    }
  }
  position.resize(4 * engine::padded(count_p + count_q, engine::kPairBatch), 0.0);
  list.refresh(position.data());
  if (!list.is_whole() && list.entry_count() <= kMaxPairs) {
    list.make_room(std::min(all, kMaxPairs));
    list.refresh(position.data());
  }
  kept_ = list.is_whole();
  for (std::size_t m = 0; m < count_p + count_q; ++m) counts_.push_back(list.pair_count(m));
  if (!kept_) return;
  const engine::NeighbourRows rows = list.first_rows(position.data());
  for (std::size_t a = rows.first; a < rows.last; ++a) {
    for (std::size_t i = rows.start[a]; i < rows.start[a + 1]; ++i) {
      const auto first = static_cast<std::uint32_t>(a);
      const std::uint32_t second = rows.neighbour[i - rows.origin] / 4;
      const double distance =
          (network.mats[mat_of(set, second)].position - network.mats[mat_of(set, first)].position)
              .norm();
      if (distance > 0.0 && distance < set.range) pairs_.push_back({first, second, distance});
      if (!at_one_point_ && distance == 0.0 && mat_of(set, first) != mat_of(set, second) &&
          any_moves(network, mat_of(set, first), mat_of(set, second)))
        at_one_point_ = StartPair{first, second, distance};
    }
  }
}

double rest_length_of(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                      std::uint32_t mat_a, std::uint32_t mat_b) {
  return set.rest_length >= 0.0 ? set.rest_length : network.radius[mat_a] + network.radius[mat_b];
}

}  // namespace cordis::plan
