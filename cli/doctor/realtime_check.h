// cli/doctor/realtime_check.h -- what a process is permitted.
#pragma once

#include <string>

#include "cli/doctor/finding.h"

namespace cordis::cli {

/// What a process is permitted.
struct Permissions {
  bool fifo = false;           ///< SCHED_FIFO at the priority of the loops
  bool memory_lock = false;    ///< as much memory as a node reserves
  std::string priority_limit;  ///< RLIMIT_RTPRIO as text
  std::string memory_limit;    ///< RLIMIT_MEMLOCK as text
};
/// Tries it in a thread of its own; locks no memory that is in use.
Permissions try_permissions();
/// realtime.priority
Finding check_priority(const Permissions& permissions);
/// realtime.memory
Finding check_memory_lock(const Permissions& permissions);

}  // namespace cordis::cli
