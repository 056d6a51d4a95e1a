// cli/doctor/kernel_check.h -- what the kernel is built for.
#pragma once

#include <string>

#include "cli/doctor/finding.h"
#include "node/machine/system_files.h"

namespace cordis::cli {

/// kernel.preemption: whether the kernel lets a loop interrupt its own work.
/// @param release  of the kernel, as `uname -r` prints it
/// @param version  of its build, as `uname -v` prints it
Finding check_preemption(const machine::SystemFiles& files, const std::string& release,
                         const std::string& version);

}  // namespace cordis::cli
