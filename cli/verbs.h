// cli/verbs.h -- the verbs of the `cordis` program; each has a folder of its own, named after it.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

/// Every verb, in the order of the help, and the examples of the program itself.
void add_verbs(CommandLine& line);

}  // namespace cordis::cli
