// cli/info/take_info.h -- what a take holds, for a person and for a program.
#pragma once

#include <string>

#include "record_node/mcap/reader.h"
#include "record_node/missed_messages.h"

namespace cordis::cli {

/// Messages that a recorder missed, as its take says; 0 where it says nothing.
record::MissedMessages missed_in(const mcap::Reader& take);

/// Lines for a person.
std::string take_text(const mcap::Reader& take);
/// JSON for a program; keys carry their unit.
std::string take_json(const mcap::Reader& take);

}  // namespace cordis::cli
