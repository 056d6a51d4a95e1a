// cli/run/run_verb.h -- cordis run: starts the nodes of a launch file and ends them together.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_run_verb(CommandLine& line);

}  // namespace cordis::cli
