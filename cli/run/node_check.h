// cli/run/node_check.h -- lets every node check its own files before any of them starts.
#pragma once

#include <optional>

#include "cli/run/run_plan.h"
#include "cli/run/stop_signals.h"

namespace cordis::cli {

/// Runs every node of the plan with --check, all at once, and prints on stderr what those that
/// object have to say.
/// @return nothing when the run can begin, else the exit code of a run that cannot: kBadInput when
/// a file is wrong,
///         kFailure when a check itself failed, kSuccess when a signal wanted the end
std::optional<int> check_nodes(const RunPlan& plan, StopSignals& signals);

}  // namespace cordis::cli
