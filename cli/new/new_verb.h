// cli/new/new_verb.h -- `cordis new`.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

/// Adds the verb to a command line.
void add_new_verb(CommandLine& line);

}  // namespace cordis::cli
