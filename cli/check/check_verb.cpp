// cli/check/check_verb.cpp -- cordis check: says before the run what it promises, and where it
// would fail.
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "cli/check/scene_check.h"
#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/verbs.h"

namespace cordis::cli {
namespace {

void write_json(const SceneCheck& check) {
  const std::string json = json_of(check);
  if (check.options.json_file == "-") {
    std::fputs(json.c_str(), stdout);
    return;
  }
  std::ofstream file(check.options.json_file);
  file << json << std::flush;
  if (!file) throw std::runtime_error("cannot write " + check.options.json_file);
}

int run(const CheckOptions& options) {
  const SceneCheck check = check_scene(options);
  if (options.json_file != "-") std::fputs(text_of(check).c_str(), stdout);
  if (!options.json_file.empty()) write_json(check);
  if (!check.plan.stability.diverges()) return kSuccess;
  if (options.force) return kSuccess;
  std::fprintf(stderr, "cordis check: %s is unstable at %g Hz\n", options.scene_file.c_str(),
               check.scene.step_rate_hz);
  return kFailure;
}

struct CheckWords {
  CheckOptions options;
  std::string band;
  std::string delay = "1";
  std::string device_viscosity = "0";
};

}  // namespace

void add_check_verb(CommandLine& line) {
  auto words = std::make_shared<CheckWords>();
  CheckOptions& options = words->options;
  Verb& verb = line.verb("check", "SCENE [options]",
                         "Say what a scene promises before it runs, and where it would fail");
  verb.required_word("SCENE", options.scene_file, "The scene file");
  verb.option("--json", "FILE", options.json_file, "Also write it for a program; - for stdout");
  verb.option("--band", "HZ", words->band,
              "Where pitch and decay are evaluated [that of the scene, or 100]");
  verb.option("--delay", "PERIODS", words->delay,
              "Of the loop through a device: from a sample to its answer [1]");
  verb.option("--device-viscosity", "N_S_PER_M", words->device_viscosity,
              "Of the device itself: tells how stiff its ports may be");
  verb.flag("--force", options.force, "Exit code 0 even when it is unstable");
  verb.examples(
      "Stable means that the step is below the limit in every pose and every combination of\n"
      "states (docs/stability.md). A scene with `accuracy` and without a rate gets its rate here.\n"
      "Exit code: 0 stable or not certain, 1 unstable, 2 bad file or command line.\n\n"
      "Examples:\n"
      "  cordis check launch_configs/scenes/plucked_string.yaml\n"
      "  cordis check launch_configs/scenes/membrane.yaml --band 40 --device-viscosity 1\n");
  verb.action([words] {
    CheckOptions& asked = words->options;
    if (!words->band.empty()) asked.band_hz = parse_number("--band", words->band, 1e-3, 1e6);
    asked.delay_periods = parse_whole_number("--delay", words->delay, 0, 1000);
    asked.device_viscosity = parse_number("--device-viscosity", words->device_viscosity, 0.0, 1e6);
    return run(asked);
  });
}

}  // namespace cordis::cli
