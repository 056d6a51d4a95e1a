// record_node/mcap/stored_summary.h -- the summary that a file says it has.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "record_node/mcap/summary.h"

namespace cordis::mcap {

/// What read_stored_summary() says of a file that was made without one.
inline constexpr const char* kNoSummary = "it has no summary";

/// What it says of one that does not say where all messages are. What it describes is sound.
inline constexpr const char* kIncompleteSummary = "its summary is incomplete";

/// Reads the summary at the end of a file. @return why there is none that can be used; empty: read
std::string read_stored_summary(std::span<const std::byte> file, Summary& summary);

}  // namespace cordis::mcap
