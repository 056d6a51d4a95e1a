// cli/recover/recover_verb.h -- cordis recover: makes a torn take whole.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_recover_verb(CommandLine& line);

}  // namespace cordis::cli
