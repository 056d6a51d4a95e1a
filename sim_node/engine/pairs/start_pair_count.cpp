// sim_node/engine/pairs/start_pair_count.cpp
#include "sim_node/engine/pairs/start_pair_count.h"

#include <algorithm>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/vector_width.h"
#include "sim_node/engine/pairs/cell_grid.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

namespace {

StartPairCount count_at_surfaces(const NetworkDescription& network, const SetLiaison& set,
                                 const StartPairCount& limits) {
  StartPairCount count;
  for (const std::uint32_t of_surface : set.set_p) {
    const Surface& surface = *surface_of(network, of_surface);
    for (const std::uint32_t mat : set.set_q) {
      const Vec3& place = network.mats[mat].position;
      const SurfaceDistance from = distance_from(surface, network.mats[of_surface].position, place);
      if (from.distance < set.range && !from.is_beyond) ++count.in_range;
    }
    count.examined += set.set_q.size();
    if (count.in_range > limits.in_range || count.examined > limits.examined) break;
  }
  return count;
}

}  // namespace

StartPairCount count_start_pairs(const NetworkDescription& network, const SetLiaison& set,
                                 const StartPairCount& limits) {
  if (acts_on_surfaces(network, set)) return count_at_surfaces(network, set, limits);
  constexpr double kReach = 1.5;  // in ranges: with the largest skin of a neighbour list
  const std::size_t count_p = set.set_p.size();
  AlignedVector<double> position;
  position.reserve(4 * (count_p + set.set_q.size()));
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      const Vec3& place = network.mats[mat].position;
      position.insert(position.end(), {place.x(), place.y(), place.z(), 0.0});
    }
  }
  CellGrid grid(count_p, network.dimension);
  grid.fill(position.data(), count_p, kReach * set.range);
  const CellTable table = grid.table();
  const PairKernel& kernel = pair_kernel(best_vector_width());
  std::vector<std::uint32_t> found(count_p + kPairBatch);

  StartPairCount count;
  for (std::size_t b = set.set_q.empty() ? 0 : count_p; b < position.size() / 4; ++b) {
    const double* point = position.data() + 4 * b;
    if (!is_finite_point(point)) continue;
    const std::size_t last = std::min(b, count_p);
    const NearQuery query{
        point[0], point[1], point[2], set.range * set.range, 0.0, static_cast<double>(last)};
    const CellGrid::NeighbourCells around = grid.around(point, last);
    for (std::size_t r = 0; r < around.count; ++r) {
      const CellGrid::Run run = around.runs[r];
      count.examined += run.end - run.begin;
      count.in_range += kernel.find_near(table, run.begin, run.end, query, found.data());
    }
    if (count.in_range > limits.in_range || count.examined > limits.examined) break;
  }
  return count;
}

}  // namespace cordis::engine
