// cli/keys/keys_verb.h -- `cordis keys`.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_keys_verb(CommandLine& line);

}  // namespace cordis::cli
