// cli/session.h -- one run of all nodes of a launch file.
#pragma once

#include "cli/run_plan.h"
#include "cli/stop_signals.h"

namespace cordis::cli {

/// Starts the nodes of the plan, shows their lines and the address of the page, stops all of them
/// when one that is required ends, when the duration is over or when a signal says so, and prints
/// the table of their last statuses.
/// @return kSuccess, or the exit code of the first required node that failed (128 + signal when one
/// killed it)
/// @throws std::runtime_error when DDS refuses, a program cannot be started or a log cannot be
/// written.
int run_session(const config::Launch& launch, const RunPlan& plan, const RunOptions& options,
                StopSignals& signals);

}  // namespace cordis::cli
