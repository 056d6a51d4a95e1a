// cli/mat_words.h -- the words of --mat.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim_node/scene/scene.h"

namespace cordis::cli {

/// A MAT that a person picked, and what its columns are called.
struct PickedMat {
  std::string name;  ///< string[3], or the name alone where it has one MAT
  std::uint32_t index = 0;
};

/// The MATs of one word: `string`, `string[3]`, `string[2..5]`.
/// @param matter  the names that the scene has
/// @throws UsageError for a word that fits no MAT.
std::vector<PickedMat> pick_mats(const std::vector<scene::NamedRange>& matter,
                                 const std::string& word);

/// ".x", ".y" or ".z". Precondition: axis is 0, 1 or 2.
const char* axis_suffix(int axis) noexcept;

}  // namespace cordis::cli
