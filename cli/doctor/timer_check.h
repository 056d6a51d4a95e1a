// cli/doctor/timer_check.h -- how exactly threads wake.
#pragma once

#include <vector>

#include "cli/doctor/finding.h"
#include "node/machine/wakeups.h"

namespace cordis::cli {

/// timer.resolution of CLOCK_MONOTONIC
Finding check_resolution(long resolution_nsec);
/// timer.slack of a thread, now and after asking for 1 ns
Finding check_slack(long before_nsec, long after_nsec);
/// timer.wakeups: reports whether a 1 kHz loop can work.
/// @param duration_s  of the measurement
Finding check_wakeups(const std::vector<machine::CoreWakeups>& cores, double duration_s);

}  // namespace cordis::cli
