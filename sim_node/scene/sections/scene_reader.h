// sim_node/scene/sections/scene_reader.h -- reads scene files.
#pragma once

#include <string>

#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// Reads a scene file and all it includes. Whatever is wrong becomes a problem of its place, all in
/// one go. The language is described in docs/language.md.
/// @param referrer  where a person wrote the path, if in a file
/// @return what could be read; to be used only when `problems` has no errors. Then engine::Network
/// takes it.
Scene load_scene(const std::string& path, config::Problems& problems,
                 const config::Place& referrer = {});

/// Reads the text of a scene in memory; `name` stands for its path, and includes start in its
/// folder.
Scene load_scene_text(const std::string& text, const std::string& name, config::Problems& problems);

}  // namespace cordis::scene
