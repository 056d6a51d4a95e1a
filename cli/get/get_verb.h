// cli/get/get_verb.h -- cordis get: asks a running session for its parameters.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_get_verb(CommandLine& line);

}  // namespace cordis::cli
