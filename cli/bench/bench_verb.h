// cli/bench/bench_verb.h -- `cordis bench`.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_bench_verb(CommandLine& line);

}  // namespace cordis::cli
