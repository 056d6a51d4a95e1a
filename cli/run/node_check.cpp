// cli/run/node_check.cpp
#include "cli/run/node_check.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <string>

#include "cli/exit_code.h"
#include "cli/programs.h"
#include "cli/run/output_watcher.h"

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

NodeCheck check_nodes_beside(const RunPlan& plan, StopSignals& signals,
                             const std::vector<config::Problem>& known) {
  std::vector<Command> commands;
  for (const PlannedNode& node : plan.nodes) {
    commands.push_back(node.command);
    commands.back().words.emplace_back("--check");
  }
  OutputWatcher watcher(commands.size(), kLongestCheck);
  const std::vector<Ending> endings = supervise(commands, watcher, signals);
  NodeCheck check;
  if (watcher.is_interrupted()) {
    check.refused = kSuccess;
    return check;
  }
  const auto fail = [&check](const std::string& why) {
    check.refused = kFailure;
    check.said += "cordis: " + why + "\n";
    check.problems.emplace_back().message = why;
  };
  if (watcher.is_late()) fail("the nodes check their files for too long");
  for (std::size_t i = 0; i < endings.size(); ++i) {
    if (endings[i].exit_code() == kSuccess) continue;
    const std::string said = without_known(watcher.output(i), known);
    check.said += said;
    std::ranges::move(config::problems_in(said), std::back_inserter(check.problems));
    if (endings[i].exit_code() == kBadInput) {
      check.refused = check.refused.value_or(kBadInput);
    } else {
      fail(plan.nodes[i].name + " could not check its files: " + endings[i].text());
    }
  }
  return check;
}

}  // namespace

NodeCheck check_nodes(const RunPlan& plan, StopSignals& signals) {
  return check_nodes_beside(plan, signals, {});
}

std::string check_faulty_launch(const std::string& launch_file,
                                const std::vector<std::string>& overrides,
                                const std::vector<config::Problem>& known, bool with_sim) {
  config::Problems already_known;
  config::Launch launch = config::load_launch(launch_file, overrides, already_known);
  std::erase_if(launch.nodes, [with_sim](const config::LaunchNode& node) {
    return node.program.empty() || (node.program == "sim_node" && !with_sim);
  });
  if (launch.nodes.empty()) return {};
  RunOptions options;
  options.launch_file = launch_file;
  options.overrides = overrides;
  StopSignals signals;
  return check_nodes_beside(plan_run(launch, options, program_directory()), signals, known).said;
}

}  // namespace cordis::cli
