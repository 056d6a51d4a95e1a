// cli/simulate/simulate_verb.h -- `cordis simulate`.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_simulate_verb(CommandLine& line);

}  // namespace cordis::cli
