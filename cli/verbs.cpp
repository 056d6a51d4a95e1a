// cli/verbs.cpp
#include "cli/verbs.h"

namespace cordis::cli {

void add_verbs(CommandLine& line) {
  add_run_verb(line);
  add_ctl_verb(line);
  add_check_verb(line);
  add_doctor_verb(line);
  add_lab_verb(line);
  add_test_verb(line);
  line.examples(
      "`cordis VERB --help` explains a verb.\n\n"
      "Examples:\n"
      "  cordis run launch_configs/plucked_string.yaml\n"
      "  cordis ctl launch_configs/plucked_string.yaml pause\n"
      "  cordis check launch_configs/scenes/plucked_string.yaml\n"
      "  cordis doctor\n"
      "  cordis lab launch_configs/scenes/plucked_string.yaml --quick\n"
      "  cordis test\n");
}

}  // namespace cordis::cli
