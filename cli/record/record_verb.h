// cli/record/record_verb.h -- cordis record: stores a session in a file.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_record_verb(CommandLine& line);

}  // namespace cordis::cli
