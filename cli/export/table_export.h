// cli/export/table_export.h -- the table of a take.
#pragma once

#include "cli/export/export.h"
#include "cli/export/message_source.h"
#include "cli/export/take_scene.h"

namespace cordis::cli {

/// Writes the table of a scene to its files, and adds to the result what a person has to know.
/// @throws as export_take()
void export_table(const mcap::Reader& take, const TakeScene& scene, const ExportOptions& options,
                  ReadLoss& loss, ExportResult& result);

}  // namespace cordis::cli
