// cli/list/list_verb.h -- cordis list: prints the sessions that run.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_list_verb(CommandLine& line);

}  // namespace cordis::cli
