// cli/test/test_verb.h -- cordis test: hands over to CTest.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_test_verb(CommandLine& line);

}  // namespace cordis::cli
