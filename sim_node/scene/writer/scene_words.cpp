#include "sim_node/scene/writer/scene_words.h"

#include <algorithm>
#include <utility>

namespace cordis::scene {

std::string in_brackets(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return "[" + text + "]";
}

SceneWords::SceneWords(const Scene& scene) : mats_(scene.network.mats.size()) {
  std::set<std::uint32_t> of_ports;
  for (const Port& port : scene.ports) {
    taken_.insert(port.name);
    of_ports.insert({port.mat, port.tool});
  }
  for (const NamedRange& range : scene.matter) {
    // a port keeps its name, and name.handle
    const std::string name = of_ports.count(range.first) > 0 ? range.name : own_name(range.name);
    for (std::uint32_t i = 0; i < range.count; ++i) {
      mats_[range.first + i] = {name, i, range.count};
    }
  }
}

std::string SceneWords::own_name(std::string name) {
  for (char& c : name) {
    if (c == '.' || c == '[' || c == ']') c = '_';
  }
  while (!taken_.insert(name).second) name += "_";
  return name;
}

std::string SceneWords::selection(const std::vector<std::uint32_t>& mats) const {
  std::vector<std::string> picked;
  for (std::size_t i = 0; i < mats.size();) {
    const MatWord& first = mats_[mats[i]];
    std::size_t end = i + 1;
    while (end < mats.size() && mats[end] == mats[end - 1] + 1 &&
           mats_[mats[end]].name == first.name) {
      ++end;
    }
    const std::size_t count = end - i;
    if (count == first.count) {
      picked.push_back(first.name);
    } else {
      const std::string index = std::to_string(first.index);
      const std::string last = std::to_string(first.index + count - 1);
      picked.push_back("\"" + first.name + "[" + index + (count > 1 ? ".." + last : "") + "]\"");
    }
    i = end;
  }
  return picked.size() == 1 ? picked.front() : in_brackets(picked);
}

}  // namespace cordis::scene
