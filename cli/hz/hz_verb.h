// cli/hz/hz_verb.h -- cordis hz: measures how often topics are written.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_hz_verb(CommandLine& line);

}  // namespace cordis::cli
