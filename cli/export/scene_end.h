// cli/export/scene_end.h -- the end of a scene in a take.
#pragma once

#include "cli/export/take_scene.h"
#include "record_node/mcap/reader.h"

namespace cordis::cli {

/// Refuses a start that is beyond the last step that the take has of the scene. Reads the take up to that start.
/// @param start_s  time of the scene, >= 0
/// @throws UsageError that names the end
void refuse_start_beyond_end(const mcap::Reader& take, const TakeScene& scene, double start_s);

}  // namespace cordis::cli
