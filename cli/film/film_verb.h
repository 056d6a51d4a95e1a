// cli/film/film_verb.h -- `cordis film`
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_film_verb(CommandLine& line);

}  // namespace cordis::cli
