// cli/ctl/ctl_verb.h -- cordis ctl: changes a session while it runs.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_ctl_verb(CommandLine& line);

}  // namespace cordis::cli
