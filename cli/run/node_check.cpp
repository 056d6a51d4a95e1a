// cli/run/node_check.cpp
#include "cli/run/node_check.h"

#include <chrono>
#include <cstdio>

#include "cli/exit_code.h"
#include "cli/run/output_watcher.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

constexpr std::chrono::seconds kLongestCheck{30};

}  // namespace

std::optional<int> check_nodes(const RunPlan& plan, StopSignals& signals) {
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
    node::print_text(stderr, watcher.output(i));
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

}  // namespace cordis::cli
