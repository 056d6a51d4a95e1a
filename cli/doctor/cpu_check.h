// cli/doctor/cpu_check.h -- speed and theft of the cores.
#pragma once

#include <optional>

#include "cli/doctor/finding.h"
#include "node/machine/system_files.h"

namespace cordis::cli {

/// cpu.governor: whether the cores stay at full speed.
Finding check_governor(const machine::SystemFiles& files);
/// cpu.steal, over the measurement
Finding check_steal(std::optional<double> stolen_share);

}  // namespace cordis::cli
