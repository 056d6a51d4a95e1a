// cli/verbs.h -- the verbs of the `cordis` program; each has a file of its own, named after it.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_ctl_verb(CommandLine& line);
void add_check_verb(CommandLine& line);
void add_doctor_verb(CommandLine& line);
void add_lab_verb(CommandLine& line);
void add_run_verb(CommandLine& line);
void add_test_verb(CommandLine& line);

/// Every verb, in the order of the help, and the examples of the program itself.
void add_verbs(CommandLine& line);

}  // namespace cordis::cli
