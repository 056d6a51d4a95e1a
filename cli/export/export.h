// cli/export/export.h -- the numbers of a take as files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/table/table_options.h"
#include "record_node/mcap/reader.h"

namespace cordis::cli {

/// What a person asks of `cordis export`; the rows are tick, frame, step or a span of time.
struct ExportOptions : TableOptions {
  std::size_t scene = 1;    ///< number of a scene in the take
  double start_s = 0.0;     ///< start, in the time of the scene
  double duration_s = 0.0;  ///< 0: to its end
};

/// What came of it.
struct ExportResult {
  std::string scene_name;
  std::size_t scene_count = 0;  ///< in the take
  std::uint64_t row_count = 0;
  std::uint64_t event_count = 0;
  double sound_s = 0.0;
  double sound_peak = 0.0;            ///< 1 is full scale
  std::vector<std::string> notes;     ///< a sentence each
  std::vector<std::string> warnings;  ///< likewise, of what was asked: for stderr
  std::vector<std::string> losses;    ///< what is not in the files, a sentence each
};

/// Writes the files. @throws UsageError for what is wrong with words or files, before a file is replaced;
///         std::runtime_error when a file takes no more.
ExportResult export_take(const mcap::Reader& take, const ExportOptions& options);

}  // namespace cordis::cli
