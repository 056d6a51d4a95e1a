// viz_node/render/surface_mats.h -- which MATs say where the surfaces of a scene are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "idl/scene.h"
#include "node/assert.h"

namespace cordis::viz {

/// The MAT of each surface, NO_INDEX where there is none. An older take does not say it: there it is
/// the MAT of its name. Precondition: `surface_mat` is empty, or has a MAT that exists for each surface.
inline std::vector<std::uint32_t> mats_of_surfaces(const msg::SceneDescription& description) {
  if (!description.surface_mat().empty()) {
    CORDIS_ASSERT(description.surface_mat().size() == description.surfaces().size());
    CORDIS_ASSERT(std::ranges::max(description.surface_mat()) < description.mat_kind().size());
    return description.surface_mat();
  }
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
