// cli/lab/lab_verb.h -- cordis lab: charts what accuracy costs.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_lab_verb(CommandLine& line);

}  // namespace cordis::cli
