#include "sim_node/plan/reduction/parallel.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "sim_node/plan/reduction/held.h"
#include "sim_node/plan/reduction/take_out.h"

namespace cordis::plan {
namespace {

using engine::Link;

std::pair<std::uint32_t, std::uint32_t> ends_of(const Link& link) {
  return std::minmax(link.mat_a, link.mat_b);
}

/// The rest length of a link as seen from the first end of another; in 1-D it has a sign.
double rest_seen_from(const Link& first, const Link& link, int dimension) {
  return dimension == 1 && link.mat_a != first.mat_a ? -link.rest_length : link.rest_length;
}

void merge(const Link& link, int dimension, Link& into) {
  const double rest = rest_seen_from(into, link, dimension);
  const double stiffness = into.stiffness + link.stiffness;
  if (link.stiffness > 0.0 && rest != into.rest_length) {  // else it stays to the bit
    into.rest_length = (into.stiffness * into.rest_length + link.stiffness * rest) / stiffness;
  }
  into.stiffness = stiffness;
  into.viscosity += link.viscosity;
}

/// Whether the energy at rest is that of both links.
bool keeps_energy(const Link& first, const Link& link, int dimension) {
  return first.stiffness == 0.0 || link.stiffness == 0.0 ||
         rest_seen_from(first, link, dimension) == first.rest_length;
}

}  // namespace

std::size_t merge_parallel(scene::Scene& scene) {
  std::vector<Link>& links = scene.network.links;
  const int dimension = scene.network.dimension;
  const Held held = held_in(scene);
  const auto may_merge = [&](std::uint32_t first, std::uint32_t link) {
    return !held.energy || keeps_energy(links[first], links[link], dimension);
  };
  std::vector<std::uint32_t> order(links.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return ends_of(links[a]) < ends_of(links[b]);
  });
  std::vector<bool> gone(links.size());
  std::size_t merged = 0;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    std::optional<std::uint32_t> first;
    for (; end < order.size() && ends_of(links[order[end]]) == ends_of(links[order[i]]); ++end) {
      const std::uint32_t link = order[end];
      if (held.links[link] || links[link].isotropic) continue;
      if (!first) {
        first = link;
      } else if (may_merge(*first, link)) {
        merge(links[link], dimension, links[*first]);
        gone[link] = true;
        ++merged;
      }
    }
    i = end;
  }
  if (merged == 0) return 0;
  take_out(std::vector<bool>(scene.network.mats.size()), gone, scene);
  return merged;
}

}  // namespace cordis::plan
