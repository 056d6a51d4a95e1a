// cli/lab/lab_report.h -- the table of `cordis lab`.
#pragma once

#include <string>

#include "cli/lab/lab.h"

namespace cordis::cli {

/// A table for a person.
std::string text_of(const LabReport& report);

}  // namespace cordis::cli
