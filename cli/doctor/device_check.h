// cli/doctor/device_check.h -- serial lines.
#pragma once

#include <functional>
#include <string>

#include "cli/doctor/finding.h"
#include "node/machine/system_files.h"

namespace cordis::cli {

/// device.ports: serial lines.
/// @param may_use  whether this user may read and write a file
Finding check_devices(const machine::SystemFiles& files,
                      const std::function<bool(const std::string&)>& may_use);

}  // namespace cordis::cli
