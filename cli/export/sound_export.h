// cli/export/sound_export.h -- the sounds in a take.
#pragma once

#include "cli/export/export.h"
#include "cli/export/message_source.h"
#include "cli/export/take_scene.h"

namespace cordis::cli {

/// True if a signal of the scene is a sound.
bool has_sound(const TakeScene& scene) noexcept;

/// Writes the sounds of a scene, with silence where steps are missing, and adds to the result what a
/// person has to know. Precondition: it has one. @throws as export_take()
void export_sound(const mcap::Reader& take, const TakeScene& scene, const ExportOptions& options,
                  ReadLoss& loss, ExportResult& result);

}  // namespace cordis::cli
