// node/machine/processor_quota.h -- how many processors this process may use at once.
#pragma once

#include <cstddef>
#include <optional>

#include "node/machine/system_files.h"

namespace cordis::machine {

/// Processors that the control groups of this process grant at most, in processor time per time: the
/// smallest quota of its group and of those around it, of version 2 (`cpu.max`) and 1
/// (`cpu.cfs_quota_us`). Nothing where there is none.
std::optional<double> processor_quota(const SystemFiles& files);

/// How many threads of this process can compute at once: the cores on which it may run, no more than
/// whole processors of its quota, at least 1.
std::size_t usable_processors(const SystemFiles& files = SystemFiles());

}  // namespace cordis::machine
