// cli/export/export_verb.h -- `cordis export`.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_export_verb(CommandLine& line);

}  // namespace cordis::cli
