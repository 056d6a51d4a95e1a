// sim_node/scene/writer/scene_words.h -- the names by which a scene that is written down calls its parts.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// Items in brackets, as YAML.
std::string in_brackets(const std::vector<std::string>& items);

/// Names of matter, ports and links, none of which stands for two things: those of the scene, with
/// '_' for the dots and brackets of parts.
class SceneWords {
 public:
  explicit SceneWords(const Scene& scene);

  /// A name for something new: this one, or one like it that nothing else bears.
  std::string own_name(std::string name);
  /// Of the matter that the MAT belongs to, or of its port.
  const std::string& name_of(std::uint32_t mat) const noexcept { return mats_[mat].name; }
  /// A selection that picks these MATs in this order.
  std::string selection(const std::vector<std::uint32_t>& mats) const;

 private:
  struct MatWord {
    std::string name;
    std::uint32_t index = 0;
    std::uint32_t count = 0;  // of all MATs of that name
  };

  std::set<std::string> taken_;
  std::vector<MatWord> mats_;
};

}  // namespace cordis::scene
