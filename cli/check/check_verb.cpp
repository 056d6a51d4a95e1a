// cli/check/check_verb.cpp
#include "cli/check/check_verb.h"

#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "cli/check/check_report.h"
#include "cli/check/scene_check.h"
#include "cli/check/take_report.h"
#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/programs.h"
#include "cli/run/node_check.h"
#include "cli/run/run_plan.h"
#include "cli/run/stop_signals.h"
#include "cli/take_file.h"
#include "node/terminal_text.h"

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
  if (options.json_file != "-") node::print_text(stdout, text_of(check));
  if (!options.json_file.empty()) write_json(check);
  const std::string problems = check.problems.text();
  std::fflush(stdout);
  if (!problems.empty()) node::print_text(stderr, problems + "\n");
  const bool asks_others = check.launch && !options.plan_alone;
  const int others = asks_others ? check_other_nodes(*check.launch, options.overrides) : kSuccess;
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
  Verb& verb = line.verb("check", "SCENE|LAUNCH|TAKE [words] [options]",
                         "Say what a scene promises before it runs, and where it would fail; or "
                         "whether a take is whole");
  verb.required_word("SCENE|LAUNCH|TAKE", options.file,
                     "A scene; a launch file: then with its devices and clock; or a take");
  verb.more_words("words", options.overrides,
                  "Change a launch file, as for `cordis run`: name.key=value");
  verb.option("--json", "FILE", options.json_file, "Also write it for a program; - for stdout");
  verb.option("--band", "HZ", words->band,
              "Where pitch and decay are evaluated [that of the scene, or 100]");
  verb.flag("--plan", options.plan_alone,
            "The plan alone: no load, which is measured, and no other nodes");
  verb.flag("--force", options.force,
            "Warn of a scene that is unstable, as sim_node does with force=true");
  verb.examples(
      "Stable means that the step is below the limit in every pose and every combination of\n"
      "states (docs/stability.md). A scene with `accuracy` and without a rate gets its rate here.\n"
      "What `cordis run` would refuse or warn of stands below the report, in the same words.\n"
      "Of a take every CRC, index and count is checked; it says at which byte what is wrong.\n"
      "Exit code: 0 `cordis run` plays it, or the take is whole, 1 a check failed itself,\n"
      "2 `cordis run` refuses it, or the take is damaged.\n\n"
      "Examples:\n"
      "  cordis check launch_configs/plasticine.yaml\n"
      "  cordis check launch_configs/scenes/plucked_string.yaml\n"
      "  cordis check launch_configs/scenes/membrane.yaml --band 40\n"
      "  cordis check take.mcap\n");
  verb.action([words] {
    CheckOptions& asked = words->options;
    if (is_take(asked.file)) return check_take_file(asked.file, asked.json_file);
    if (!words->band.empty()) asked.band_hz = parse_number("--band", words->band, 1e-3, 1e6);
    return run(asked);
  });
}

}  // namespace cordis::cli
