// cli/check/check_verb.cpp -- cordis check: says before the run what it promises, and where it
// would fail.
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "cli/check/check_report.h"
#include "cli/check/scene_check.h"
#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/programs.h"
#include "cli/run/node_check.h"
#include "cli/run/run_plan.h"
#include "cli/run/stop_signals.h"
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

/// Lets the nodes beside sim_node check their files, as a run does before it begins.
int check_other_nodes(const config::Launch& launch, const std::vector<std::string>& overrides) {
  RunOptions options;
  options.launch_file = launch.file;
  options.overrides = overrides;
  RunPlan plan = plan_run(launch, options, program_directory());
  std::erase_if(plan.nodes, [](const PlannedNode& node) { return node.program == "sim_node"; });
  StopSignals signals;
  return check_nodes(plan, signals).value_or(kSuccess);
}

int run(const CheckOptions& options) {
  const SceneCheck check = check_scene(options);
  if (options.json_file != "-") std::fputs(text_of(check).c_str(), stdout);
  if (!options.json_file.empty()) write_json(check);
  const std::string problems = check.problems.text();
  std::fflush(stdout);
  if (!problems.empty()) std::fprintf(stderr, "%s\n", problems.c_str());
  const int others = check.launch ? check_other_nodes(*check.launch, options.overrides) : kSuccess;
  return check.problems.has_errors() ? kBadInput : others;
}

}  // namespace

void add_check_verb(CommandLine& line) {
  struct CheckWords {
    CheckOptions options;
    std::string band;
  };
  auto words = std::make_shared<CheckWords>();
  CheckOptions& options = words->options;
  Verb& verb = line.verb("check", "SCENE|LAUNCH [words] [options]",
                         "Say what a scene promises before it runs, and where it would fail");
  verb.required_word("SCENE|LAUNCH", options.file,
                     "A scene, or a launch file: then with its devices and clock");
  verb.more_words("words", options.overrides,
                  "Change a launch file, as for `cordis run`: name.key=value");
  verb.option("--json", "FILE", options.json_file, "Also write it for a program; - for stdout");
  verb.option("--band", "HZ", words->band,
              "Where pitch and decay are evaluated [that of the scene, or 100]");
  verb.flag("--force", options.force,
            "Warn of a scene that is unstable, as sim_node does with force=true");
  verb.examples(
      "Stable means that the step is below the limit in every pose and every combination of\n"
      "states (docs/stability.md). A scene with `accuracy` and without a rate gets its rate here.\n"
      "What `cordis run` would refuse or warn of stands below the report, in the same words.\n"
      "Exit code: 0 `cordis run` plays it, 1 a check failed itself, 2 `cordis run` refuses it.\n\n"
      "Examples:\n"
      "  cordis check launch_configs/plasticine.yaml\n"
      "  cordis check launch_configs/scenes/plucked_string.yaml\n"
      "  cordis check launch_configs/scenes/membrane.yaml --band 40\n");
  verb.action([words] {
    CheckOptions& asked = words->options;
    if (!words->band.empty()) asked.band_hz = parse_number("--band", words->band, 1e-3, 1e6);
    return run(asked);
  });
}

}  // namespace cordis::cli
