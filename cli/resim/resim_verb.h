// cli/resim/resim_verb.h -- cordis resim: computes a recorded session again.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_resim_verb(CommandLine& line);

}  // namespace cordis::cli
