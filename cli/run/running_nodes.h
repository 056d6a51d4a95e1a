// cli/run/running_nodes.h -- nodes of the session that other users of this host run.
#pragma once

#include <string>

#include "cli/run/run_plan.h"

namespace cordis::cli {

/// The registry of sessions has those of one user. Each node locks its name for all users of the
/// host. @throws std::runtime_error when a node of the plan runs in the session already
void refuse_running_nodes(const RunPlan& plan, const std::string& session, int domain);

}  // namespace cordis::cli
