// cli/main.cpp -- the `cordis` program.
#include "cli/verbs.h"

int main(int argc, char** argv) {
  cordis::cli::CommandLine line(
      "cordis", "Physical objects that you can build from parts, touch and see.", CORDIS_VERSION);
  cordis::cli::add_run_verb(line);
  cordis::cli::add_ctl_verb(line);
  cordis::cli::add_check_verb(line);
  cordis::cli::add_doctor_verb(line);
  cordis::cli::add_lab_verb(line);
  cordis::cli::add_test_verb(line);
  line.examples(
      "`cordis VERB --help` explains a verb.\n\n"
      "Examples:\n"
      "  cordis run launch_configs/plucked_string.yaml\n"
      "  cordis ctl launch_configs/plucked_string.yaml pause\n"
      "  cordis check launch_configs/scenes/plucked_string.yaml\n"
      "  cordis doctor\n"
      "  cordis lab launch_configs/scenes/plucked_string.yaml --quick\n"
      "  cordis test\n");
  return line.run({argv + 1, argv + argc});
}
