// cli/run/node_check.cpp
#include "cli/run/node_check.h"

#include <chrono>
#include <cstdio>
#include <string>

#include "cli/exit_code.h"
#include "cli/programs.h"
#include "cli/run/output_watcher.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

constexpr std::chrono::seconds kLongestCheck{30};

/// What a node said, without the problems that are known.
std::string without_known(std::string text, const std::vector<config::Problem>& known) {
  for (const config::Problem& problem : known) {
    const std::string block = problem.text() + "\n";
    const std::size_t begin = text.find(block);
    if (begin != std::string::npos) text.erase(begin, block.size());
  }
  return text;
}

std::optional<int> check_nodes_beside(const RunPlan& plan, StopSignals& signals,
                                      const std::vector<config::Problem>& known) {
  std::vector<Command> commands;
  for (const PlannedNode& node : plan.nodes) {
    commands.push_back(node.command);
    commands.back().words.emplace_back("--check");
  }
  OutputWatcher watcher(commands.size(), kLongestCheck);
  const std::vector<Ending> endings = supervise(commands, watcher, signals);
  if (watcher.is_interrupted()) return kSuccess;

  std::optional<int> result;
  if (watcher.is_late()) {
    std::fputs("cordis: the nodes check their files for too long\n", stderr);
    result = kFailure;
  }
  for (std::size_t i = 0; i < endings.size(); ++i) {
    if (endings[i].exit_code() == kSuccess) continue;
    node::print_text(stderr, without_known(watcher.output(i), known));
    if (endings[i].exit_code() == kBadInput) {
      result = result.value_or(kBadInput);
    } else {
      result = kFailure;
      std::fprintf(stderr, "cordis: %s could not check its files: %s\n", plan.nodes[i].name.c_str(),
                   endings[i].text().c_str());
    }
  }
  return result;
}

}  // namespace

std::optional<int> check_nodes(const RunPlan& plan, StopSignals& signals) {
  return check_nodes_beside(plan, signals, {});
}

void check_faulty_launch(const std::string& launch_file, const std::vector<std::string>& overrides,
                         const std::vector<config::Problem>& known, bool with_sim) {
  config::Problems already_known;
  config::Launch launch = config::load_launch(launch_file, overrides, already_known);
  std::erase_if(launch.nodes, [with_sim](const config::LaunchNode& node) {
    return node.program.empty() || (node.program == "sim_node" && !with_sim);
  });
  if (launch.nodes.empty()) return;
  RunOptions options;
  options.launch_file = launch_file;
  options.overrides = overrides;
  StopSignals signals;
  check_nodes_beside(plan_run(launch, options, program_directory()), signals, known);
}

}  // namespace cordis::cli
