// cli/mat_words.cpp
#include "cli/mat_words.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "cli/command_line.h"
#include "node/assert.h"
#include "node/config/nearest_word.h"
#include "sim_node/scene/selection.h"

namespace cordis::cli {

std::vector<PickedMat> pick_mats(const std::vector<scene::NamedRange>& matter,
                                 const std::string& word) {
  const std::size_t bracket = word.ends_with("]") ? word.rfind('[') : std::string::npos;
  const std::string name = word.substr(0, bracket);
  std::vector<std::string> names;
  for (const scene::NamedRange& range : matter) names.push_back(range.name);
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    const std::string hint = config::did_you_mean(name, names);
    throw UsageError("--mat: the scene has no MATs '" + name + "'" +
                     (hint.empty() ? "" : "; " + hint));
  }
  const scene::NamedRange& range = matter[static_cast<std::size_t>(found - names.begin())];
  scene::IndexRange picked{0, range.count - 1};
  if (bracket != std::string::npos) {
    const auto indices = scene::read_index_range(
        std::string_view(word).substr(bracket + 1, word.size() - bracket - 2));
    if (!indices || indices->last >= range.count) {
      throw UsageError("--mat: '" + word + "' picks none of the MATs " + name + "[0.." +
                       std::to_string(range.count - 1) + "]");
    }
    picked = *indices;
  }
  std::vector<PickedMat> mats;
  for (std::uint32_t i = picked.first; i <= picked.last; ++i) {
    mats.push_back(
        {range.count == 1 ? name : name + "[" + std::to_string(i) + "]", range.first + i});
  }
  return mats;
}

const char* axis_suffix(int axis) noexcept {
  constexpr std::array<const char*, 3> kSuffixes{".x", ".y", ".z"};
  CORDIS_ASSERT(axis >= 0 && axis < 3);
  return kSuffixes[static_cast<std::size_t>(axis)];
}

}  // namespace cordis::cli
