// cli/info/info_verb.h -- cordis info: what a take holds.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_info_verb(CommandLine& line);

}  // namespace cordis::cli
