// cli/merge/merge_verb.h -- cordis merge: several takes become one.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_merge_verb(CommandLine& line);

}  // namespace cordis::cli
