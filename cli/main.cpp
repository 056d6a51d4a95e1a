// cli/main.cpp -- the `cordis` program.
#include "cli/live_output.h"
#include "cli/verbs.h"

int main(int argc, char** argv) {
  cordis::cli::hold_place_of_output();
  cordis::cli::CommandLine line(
      "cordis", "Physical objects that you can build from parts, touch and see.", CORDIS_VERSION);
  cordis::cli::add_verbs(line);
  return cordis::cli::end_output("cordis", line.run({argv + 1, argv + argc}));
}
