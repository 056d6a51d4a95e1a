// cli/session_launch.h -- the launch file of a running session, as it was started.
#pragma once

#include "cli/session_address.h"
#include "node/config/launch.h"
#include "node/config/problem.h"

namespace cordis::cli {

/// Loads the launch file of a session, with the clock that the command line of one of its processes
/// on this host names. A session that is played has a take in its place: only the name of the
/// session is filled in then. Errors of the file go to `problems`.
config::Launch running_launch(const SessionAddress& address, config::Problems& problems);

}  // namespace cordis::cli
