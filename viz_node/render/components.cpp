// viz_node/render/components.cpp
#include "viz_node/render/components.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "node/assert.h"
#include "node/disjoint_sets.h"

namespace cordis::viz {
void Components::update(std::size_t mat_count, const std::vector<std::uint32_t>& ends,
                        const std::vector<bool>& acts) {
  CORDIS_ASSERT(ends.size() == 2 * acts.size());
  node::DisjointSets joined(mat_count);
  for (std::size_t link = 0; link < acts.size(); ++link) {
    if (acts[link]) joined.join(ends[2 * link], ends[2 * link + 1]);
  }
  std::vector<std::size_t> sizes(mat_count, 0);
  for (std::uint32_t mat = 0; mat < mat_count; ++mat) ++sizes[joined.root_of(mat)];
  std::vector<Component> found;
  for (std::uint32_t mat = 0; mat < mat_count; ++mat)
    if (sizes[mat] > 1) found.push_back({mat, sizes[mat], std::nullopt});
  std::ranges::sort(found, [](const Component& a, const Component& b) {
    return std::tuple(b.size, a.root) < std::tuple(a.size, b.root);
  });
  give_colours(found);
  list_ = std::move(found);
  colours_.assign(mat_count, std::nullopt);
  for (const Component& component : list_) colours_[component.root] = component.colour;
  for (std::uint32_t mat = 0; mat < mat_count; ++mat) colours_[mat] = colours_[joined.root_of(mat)];
}

void Components::give_colours(std::vector<Component>& found) const {
  std::map<std::uint32_t, std::size_t> before;
  for (const Component& component : list_)
    if (component.colour) before[component.root] = *component.colour;
  const std::size_t count = std::min(found.size(), kMaxColoured);
  std::vector<bool> taken(kMaxColoured, false);
  for (std::size_t i = 0; i < count; ++i) {
    const auto known = before.find(found[i].root);
    if (known == before.end()) continue;
    found[i].colour = known->second;
    taken[known->second] = true;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (found[i].colour) continue;
    const auto next = std::ranges::find(taken, false);
    found[i].colour = static_cast<std::size_t>(next - taken.begin());
    *next = true;
  }
}

}  // namespace cordis::viz
