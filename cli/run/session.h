// cli/run/session.h -- one run of all nodes of a launch file.
#pragma once

#include "cli/run/run_plan.h"
#include "cli/run/stop_signals.h"
#include "node/dds/network.h"
#include "node/dds/security.h"
#include "node/session_registry.h"

namespace cordis::cli {

/// Starts the nodes of the plan in the domain of the registration. It shows their lines and the
/// address of the page, and starts those again that die. It stops all of them when one that is
/// required ends for good, when the duration is over, or when a signal says so. At the end it
/// prints the table of their last statuses.
/// @return kSuccess, or the exit code of the first required node that failed for good (128 + signal
/// when one killed it); when all nodes end by themselves, of the first that failed
/// @throws std::runtime_error when DDS refuses, a program cannot be started or a log cannot be
/// written.
int run_session(const config::Launch& launch, const RunPlan& plan, const RunOptions& options,
                node::SessionRegistration& registration, const dds::Network& network,
                const dds::Security& security, StopSignals& signals);

}  // namespace cordis::cli
