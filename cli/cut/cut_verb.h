// cli/cut/cut_verb.h -- cordis cut: a part of a take, as a take.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_cut_verb(CommandLine& line);

}  // namespace cordis::cli
