// cli/play/play_verb.h -- cordis play: plays a take on DDS.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_play_verb(CommandLine& line);

}  // namespace cordis::cli
