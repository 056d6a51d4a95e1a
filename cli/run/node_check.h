// cli/run/node_check.h -- lets every node check its own files before any of them starts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/run/run_plan.h"
#include "cli/run/stop_signals.h"
#include "node/config/problem.h"

namespace cordis::cli {

/// What the nodes object to.
struct NodeCheck {
  /// Nothing when the run can begin, else the exit code of a run that cannot: kBadInput when a file
  /// is wrong, kFailure when a check itself failed, kSuccess when a signal wanted the end.
  std::optional<int> refused;
  std::string said;                       ///< for a person: lines, empty when there is nothing
  std::vector<config::Problem> problems;  ///< what a program reads of it
};

/// Runs every node of the plan with --check, all at once.
NodeCheck check_nodes(const RunPlan& plan, StopSignals& signals);

/// Lets the nodes of a launch file that has problems check their own files too, so that a person
/// sees all problems at once. Does nothing for a file without nodes.
/// @param known     problems of the file, which are not said again
/// @param with_sim  the sim_node too
/// @return what they said, as lines
std::string check_faulty_launch(const std::string& launch_file,
                                const std::vector<std::string>& overrides,
                                const std::vector<config::Problem>& known, bool with_sim);

}  // namespace cordis::cli
