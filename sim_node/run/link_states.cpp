// sim_node/run/link_states.cpp
#include "sim_node/run/link_states.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "node/config/count_text.h"
#include "node/config/nearest_word.h"
#include "node/config/problem.h"
#include "sim_node/scene/selection.h"

namespace cordis::sim {
namespace {

const scene::NamedRange* named(const scene::Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.links, name, &scene::NamedRange::name);
  return found == scene.links.end() ? nullptr : &*found;
}

[[noreturn]] void refuse_name(const scene::Scene& scene, const std::string& name) {
  if (std::ranges::find(scene.set_names, name) != scene.set_names.end())
    throw std::invalid_argument("'" + name +
                                "' joins sets, whose pairs cannot be put into a state");
  std::vector<std::string> words;
  for (const scene::NamedRange& range : scene.links) words.push_back(range.name);
  const std::string near = config::did_you_mean(name, words);
  throw std::invalid_argument("no links are named '" + name + "'" +
                              (near.empty() ? "" : ", " + near));
}

/// Numbers of links in the row of all kinds.
scene::IndexRange find_links(const scene::Scene& scene, const std::string& links) {
  if (const scene::NamedRange* whole = named(scene, links))
    return {whole->first, whole->first + whole->count - 1};
  const std::size_t bracket = links.ends_with(']') ? links.rfind('[') : std::string::npos;
  const std::string name = links.substr(0, bracket);
  const scene::NamedRange* range = named(scene, name);
  if (range == nullptr) refuse_name(scene, name);
  const std::string_view inside =
      std::string_view(links).substr(bracket + 1, links.size() - bracket - 2);
  const std::optional<scene::IndexRange> picked = scene::read_index_range(inside);
  if (!picked)
    throw std::invalid_argument("'" + links + "' is not of the form name, name[3] or name[2..5]");
  if (picked->last >= range->count) {
    throw std::invalid_argument(
        "'" + name + "' has " + config::count_text(range->count, "link") +
        (range->count == 1 ? ": 0" : ", from 0 to " + std::to_string(range->count - 1)));
  }
  return {range->first + picked->first, range->first + picked->last};
}

std::uint32_t find_state(const engine::StateMachine& state_machine, const std::string& state) {
  std::vector<std::string> words;
  for (const engine::LinkState& known : state_machine.states) {
    if (known.name == state) return static_cast<std::uint32_t>(words.size());
    words.push_back(known.name);
  }
  const std::string near = config::did_you_mean(state, words);
  throw std::invalid_argument("the liaison '" + state_machine.name + "' has no state '" + state +
                              "'" + (near.empty() ? "" : ", " + near));
}

}  // namespace

std::vector<Request::ForcedState> find_states(const scene::Scene& scene, const std::string& links,
                                              const std::string& state) {
  const scene::IndexRange range = find_links(scene, links);
  const std::size_t before = scene.network.links.size();
  std::vector<Request::ForcedState> forced;
  for (std::size_t link = range.first; link <= range.last; ++link) {
    if (link >= scene.link_count()) {
      const auto bend = static_cast<std::uint32_t>(link - scene.link_count());
      if (!scene.network.bends[bend].has_states())
        throw std::invalid_argument("'" + links + "' has no states");
      const std::uint32_t machine = scene.network.bends[bend].state_machine;
      forced.push_back({bend, find_state(scene.network.state_machines[machine], state), true});
      continue;
    }
    if (link < before || link - before >= scene.network.state_links.size())
      throw std::invalid_argument("'" + links + "' has no states");
    const auto index = static_cast<std::uint32_t>(link - before);
    const std::uint32_t state_machine = scene.network.state_links[index].state_machine;
    forced.push_back({index, find_state(scene.network.state_machines[state_machine], state)});
  }
  return forced;
}

}  // namespace cordis::sim
