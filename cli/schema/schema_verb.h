// cli/schema/schema_verb.h -- `cordis schema`.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

/// Adds the verb to a command line.
void add_schema_verb(CommandLine& line);

}  // namespace cordis::cli
