// cli/doctor/version_check.h -- versions.
#pragma once

#include <string>

#include "cli/doctor/finding.h"

namespace cordis::cli {

/// versions of Cordis and of what it is built from
Finding check_versions(const std::string& release);

}  // namespace cordis::cli
