// cli/check/check_verb.cpp
#include "cli/check/check_verb.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "cli/check/check_report.h"
#include "cli/check/scene_check.h"
#include "cli/check/take_report.h"
#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/programs.h"
#include "cli/run/node_check.h"
#include "cli/run/run_plan.h"
#include "cli/run/stop_signals.h"
#include "cli/table/output_file.h"
#include "cli/table/table_options.h"
#include "node/config/regular_file.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

/// Takes the report of a file for a program.
using PutJson = std::function<void(const std::string& json)>;

/// Lets the nodes beside sim_node check their files, as a run does before it begins.
NodeCheck check_other_nodes(const config::Launch& launch,
                            const std::vector<std::string>& overrides) {
  RunOptions options;
  options.launch_file = launch.file;
  options.overrides = overrides;
  RunPlan plan = plan_run(launch, options, program_directory());
  std::erase_if(plan.nodes, [](const PlannedNode& node) { return node.program == "sim_node"; });
  StopSignals signals;
  return check_nodes(plan, signals);
}

/// A file that cannot be checked, for a person and for a program.
int report_failure(const std::string& file, const std::string& reason, int code,
                   const PutJson& put_json) {
  std::fflush(stdout);
  node::print_text(stderr, reason + "\n");
  put_json(nlohmann::json{{"file", file}, {"error", reason}}.dump(
               2, ' ', false, nlohmann::json::error_handler_t::replace) +
           "\n");
  return code;
}

int check_take(const CheckOptions& options, const PutJson& put_json) {
  const TakeReport report = check_take_file(options.file);
  if (options.json_file != "-") node::print_text(stdout, report.text);
  put_json(report.json);
  return report.whole ? kSuccess : kBadInput;
}

/// @throws UsageError with all that is wrong in the files of all nodes
SceneCheck check_scene_and_nodes(const CheckOptions& options) {
  try {
    return check_scene(options);
  } catch (const config::ConfigError& error) {
    if (options.plan_alone || options.text) throw;
    const std::string others =
        check_faulty_launch(options.file, options.overrides, error.problems(), /*with_sim=*/false);
    throw UsageError(others + error.what());
  }
}

int check_scene_file(const CheckOptions& options, const PutJson& put_json) {
  const SceneCheck check = check_scene_and_nodes(options);
  if (options.json_file != "-") {
    node::print_text(stdout, text_of(check));
    if (check.launch && options.text && !options.plan_alone)
      std::puts("nodes       not asked: the files of devices are checked with a launch FILE alone");
  }
  const std::string problems = check.problems.text();
  std::fflush(stdout);
  if (!problems.empty()) node::print_text(stderr, problems + "\n");
  const bool asks_others = check.launch && !options.plan_alone && !options.text;
  NodeCheck others;
  if (asks_others) others = check_other_nodes(*check.launch, options.overrides);
  node::print_text(stderr, others.said);
  put_json(json_of(check, others.problems));
  return check.problems.has_errors() ? kBadInput : others.refused.value_or(kSuccess);
}

/// What is wrong with the file stands in the report too.
int check_file(const CheckOptions& options, const PutJson& put_json) {
  try {
    if (!options.text && config::is_take_file(options.file)) return check_take(options, put_json);
    return check_scene_file(options, put_json);
  } catch (const config::ConfigError& error) {
    return report_failure(options.file, error.what(), kBadInput, put_json);
  } catch (const UsageError& error) {
    return report_failure(options.file, error.what(), kBadInput, put_json);
  } catch (const std::exception& error) {
    return report_failure(options.file, error.what(), kFailure, put_json);
  }
}

/// One report per file; what is wrong with one hinders no other. @return the highest exit code
int check_files(const std::vector<CheckOptions>& files) {
  const std::string& json_file = files.front().json_file;
  std::optional<OutputFile> output;
  if (!json_file.empty()) output.emplace(json_file);
  std::string reports;
  const PutJson put_json = [&reports](const std::string& json) {
    reports += (reports.empty() ? "" : ",\n") + json.substr(0, json.size() - 1);
  };
  int worst = kSuccess;
  for (const CheckOptions& options : files) {
    if (&options != &files.front() && json_file != "-") std::puts("");
    worst = std::max(worst, check_file(options, put_json));
  }
  if (output) {
    output->write(files.size() > 1 ? "[\n" + reports + "\n]\n" : reports + "\n");
    output->flush();
  }
  return worst;
}

void refuse_overwritten_files(const std::vector<CheckOptions>& files) {
  std::vector<NamedFile> read;
  for (const CheckOptions& options : files) {
    if (!options.text) read.push_back({"its own file", options.file});
  }
  refuse_overwriting({{"--json", files.front().json_file}}, read);
}

std::string standard_input() {
  constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
  std::string text;
  std::array<char, 65536> block{};
  for (std::size_t count = 1; count > 0 && text.size() <= kMaxBytes;) {
    count = std::fread(block.data(), 1, block.size(), stdin);
    text.append(block.data(), count);
  }
  if (text.size() > kMaxBytes) throw UsageError("standard input is larger than 16 MiB");
  return text;
}

/// Splits the words into files and changes of launch files.
std::vector<CheckOptions> files_of(const CheckOptions& common,
                                   const std::vector<std::string>& words) {
  std::vector<std::string> names{common.file};
  CheckOptions options = common;
  for (const std::string& word : words) {
    const bool changes = word.find('=') != std::string::npos && !std::filesystem::exists(word);
    (changes ? options.overrides : names).push_back(word);
  }
  if (std::ranges::count(names, "-") > 1) throw UsageError("standard input, -, can be read once");
  std::vector<CheckOptions> files;
  for (const std::string& name : names) {
    options.file = name;
    options.text.reset();
    if (name == "-") options.text = standard_input();
    files.push_back(options);
  }
  return files;
}

}  // namespace

void add_check_verb(CommandLine& line) {
  struct CheckWords {
    CheckOptions options;
    std::string band;
    std::vector<std::string> more;
  };
  auto words = std::make_shared<CheckWords>();
  CheckOptions& options = words->options;
  Verb& verb = line.verb("check", "SCENE|LAUNCH|TAKE ... [words] [options]",
                         "Say what a scene promises before it runs, and where it would fail; or "
                         "whether a take is whole");
  verb.required_word("SCENE|LAUNCH|TAKE", options.file,
                     "A scene; a launch file: then with its devices and clock; a take; or - for "
                     "standard input");
  verb.more_words("words", words->more,
                  "More files; or changes of a launch file, as for `cordis run`: name.key=value");
  verb.option("--json", "FILE", options.json_file,
              "Also write it for a program; - for stdout. Of several files it is a list");
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
      "Every CRC, index and count of a take is checked; it says at which byte what is wrong.\n"
      "Paths in a file on standard input begin in the present folder. Of a launch file there the\n"
      "scene is checked with what its ports ask of devices; the nodes check no file of theirs.\n"
      "Exit code: 0 `cordis run` plays it, in lockstep once all its devices have joined, or the\n"
      "take is whole, 1 a check failed itself,\n"
      "2 `cordis run` refuses it, the take is damaged, or bad command line; of several files\n"
      "the highest.\n\n"
      "Examples:\n"
      "  cordis check launch_configs/plasticine.yaml\n"
      "  cordis check launch_configs/scenes/plucked_string.yaml\n"
      "  cordis check launch_configs/scenes/membrane.yaml --band 40\n"
      "  cordis check launch_configs/plucked_string.yaml launch_configs/bowed_string.yaml --json "
      "-\n"
      "  cordis check - < launch_configs/scenes/hanging_chain.yaml\n"
      "  cordis check take.mcap\n");
  verb.action([words] {
    CheckOptions& asked = words->options;
    if (!words->band.empty()) asked.band_hz = parse_number("--band", words->band, 1e-3, 1e6);
    const std::vector<CheckOptions> files = files_of(asked, words->more);
    refuse_overwritten_files(files);
    return check_files(files);
  });
}

}  // namespace cordis::cli
