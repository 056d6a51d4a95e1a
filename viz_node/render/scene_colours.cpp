// viz_node/render/scene_colours.cpp
#include "viz_node/render/scene_colours.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace cordis::viz {

SceneColours::SceneColours(const msg::SceneDescription& description, const Palette& palette) {
  if (description.colours().empty()) return;
  wanted_.assign(description.mat_kind().size(), kNone);
  for (const msg::ColouredRange& range : description.colours()) {
    const auto begin = wanted_.begin() + range.first();
    std::fill(begin, begin + range.count(), static_cast<std::uint32_t>(colours_.size()));
    colours_.push_back(readable({range.red(), range.green(), range.blue()}, palette));
  }
}

void SceneColours::split(const msg::SceneDescription& description, const std::vector<bool>& is_mass,
                         std::vector<std::uint32_t>& body, std::vector<Body>& bodies) const {
  struct Part {
    std::uint32_t body;
    Colour colour;
    std::uint32_t first_mat;
  };
  std::vector<Part> parts;  // in the order of their first MATs
  std::map<std::tuple<std::uint32_t, std::uint8_t, std::uint8_t, std::uint8_t>, std::uint32_t>
      numbers;
  std::vector<std::size_t> part_count(bodies.size(), 0);
  for (std::uint32_t mat = 0; mat < body.size(); ++mat) {
    if (!is_mass[mat]) continue;
    const Colour colour = wanted(mat).value_or(bodies[body[mat]].colour);
    const auto [found, is_new] =
        numbers.try_emplace({body[mat], colour.red, colour.green, colour.blue},
                            static_cast<std::uint32_t>(parts.size()));
    if (is_new) {
      parts.push_back({body[mat], colour, mat});
      ++part_count[body[mat]];
    }
    body[mat] = found->second;
  }
  if (parts.empty()) return;
  std::vector<Body> split;
  for (const Part& part : parts) {
    const bool is_whole = part_count[part.body] == 1;
    split.push_back(
        {is_whole ? bodies[part.body].name : kind_name(description, part.first_mat), part.colour});
  }
  bodies = std::move(split);
}

std::string body_name(const std::string& name) {
  return name.substr(0, name.find_first_of(".["));
}

std::string kind_name(const msg::SceneDescription& description, std::uint32_t mat) {
  const msg::NamedRange* nearest = nullptr;
  for (const msg::NamedRange& range : description.matter()) {
    if (mat < range.first() || mat - range.first() >= range.count()) continue;
    if (nearest == nullptr || range.count() < nearest->count()) nearest = &range;
  }
  std::string name;
  bool is_number = false;
  for (const char letter : nearest == nullptr ? std::string() : nearest->name()) {
    if (letter == '[') is_number = true;
    if (!is_number) name += letter;
    if (letter == ']') is_number = false;
  }
  return name;
}

}  // namespace cordis::viz
