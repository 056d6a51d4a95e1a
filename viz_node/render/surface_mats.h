// viz_node/render/surface_mats.h -- which MATs say where the surfaces of a scene are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "idl/scene.h"

namespace cordis::viz {

/// The MAT of each surface; of an older take, which does not say it, that of its name. NO_INDEX where
/// there is none. Precondition: the description is sound (fault_of).
inline std::vector<std::uint32_t> mats_of_surfaces(const msg::SceneDescription& description) {
  if (!description.surface_mat().empty()) return description.surface_mat();
  std::map<std::string, std::uint32_t> known;  // of each name: a polyline has several
  std::vector<std::uint32_t> mats;
  for (const msg::SurfaceDescription& surface : description.surfaces()) {
    const auto named = std::ranges::find_if(
        description.matter(),
        [&surface](const msg::NamedRange& range) { return range.name() == surface.name(); });
    const std::uint32_t number = known[surface.name()]++;
    const bool has_mat = named != description.matter().end() && number < named->count();
    mats.push_back(has_mat ? named->first() + number : msg::NO_INDEX);
  }
  return mats;
}

}  // namespace cordis::viz
