// sim_node/scene/naming.h -- what the parts of a scene are called, and where they are described.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// A MAT or a link as a selection writes it, string[3], and its place in the scene file.
struct Called {
  std::string name;
  config::Place place;
};

/// Name and place of a MAT; one that no name stands for is "MAT 7", without a place. O(names).
Called call_mat(const Scene& scene, std::uint32_t mat);
/// Name and place of a liaison; without one it is the viscosity of the medium. O(names).
Called call_liaison(const Scene& scene, std::optional<engine::LiaisonId> liaison);

/// How large it is: "3 MATs, 1 link, 0 sets, 2-D".
std::string size_text(const Scene& scene);

/// file:line of a place, or the file alone.
std::string place_text(const config::Place& place);

}  // namespace cordis::scene
