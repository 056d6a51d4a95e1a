// cli/check/check_verb.h -- cordis check: says before the run what it
// promises, and where it would fail.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_check_verb(CommandLine& line);

}  // namespace cordis::cli
