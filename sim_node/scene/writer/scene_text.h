// sim_node/scene/writer/scene_text.h -- a scene written in its language again, MAT by MAT and link by
// link.
#pragma once

#include <string>

#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// A scene file that loads as this scene does: its MATs in their order, its links, those of
/// couplings first. What generators, parts and included files said is written out; names within
/// parts get a '_' for each '.', links without a signal keep the names of their own. Reductions
/// that were made are not asked for again.
/// @param headline  a comment in its first line; empty: none
std::string scene_text(const Scene& scene, const std::string& headline);

}  // namespace cordis::scene
