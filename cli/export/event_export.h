// cli/export/event_export.h -- the changes of state in a take.
#pragma once

#include "cli/export/export.h"
#include "cli/export/message_source.h"
#include "cli/export/take_scene.h"

namespace cordis::cli {

/// Writes the table of events of a scene, and adds to the result what a person has to know.
/// @throws as export_take()
void export_events(const mcap::Reader& take, const TakeScene& scene, const ExportOptions& options,
                   ReadLoss& loss, ExportResult& result);

}  // namespace cordis::cli
