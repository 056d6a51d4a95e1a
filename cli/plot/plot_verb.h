// cli/plot/plot_verb.h -- `cordis plot`
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_plot_verb(CommandLine& line);

}  // namespace cordis::cli
