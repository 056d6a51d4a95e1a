// cli/echo/echo_verb.h -- cordis echo: prints the messages of a session.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_echo_verb(CommandLine& line);

}  // namespace cordis::cli
