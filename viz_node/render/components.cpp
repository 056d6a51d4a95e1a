// viz_node/render/components.cpp
#include "viz_node/render/components.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "node/assert.h"

namespace cordis::viz {
namespace {

/// The lowest MAT that one is joined to. The way there becomes short.
std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t mat) noexcept {
  std::uint32_t root = mat;
  while (parents[root] != root) root = parents[root];
  while (mat != root) {
    const std::uint32_t above = parents[mat];
    parents[mat] = root;
    mat = above;
  }
  return root;
}

}  // namespace

void Components::update(std::size_t mat_count, const std::vector<std::uint32_t>& ends,
                        const std::vector<bool>& acts) {
  CORDIS_ASSERT(ends.size() == 2 * acts.size());
  std::vector<std::uint32_t> parents(mat_count);
  std::iota(parents.begin(), parents.end(), 0u);
  for (std::size_t link = 0; link < acts.size(); ++link) {
    if (!acts[link]) continue;
    const std::uint32_t a = root_of(parents, ends[2 * link]);
    const std::uint32_t b = root_of(parents, ends[2 * link + 1]);
    parents[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::size_t> sizes(mat_count, 0);
  for (std::uint32_t mat = 0; mat < mat_count; ++mat) ++sizes[root_of(parents, mat)];
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
  for (std::uint32_t mat = 0; mat < mat_count; ++mat)
    colours_[mat] = colours_[root_of(parents, mat)];
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
