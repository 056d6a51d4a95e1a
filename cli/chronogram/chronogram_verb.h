// cli/chronogram/chronogram_verb.h -- `cordis chronogram`
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_chronogram_verb(CommandLine& line);

}  // namespace cordis::cli
