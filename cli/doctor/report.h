// cli/doctor/report.h -- the findings of `cordis doctor`, for persons and for programs.
#pragma once

#include <string>
#include <vector>

#include "cli/doctor/finding.h"

namespace cordis::cli {

/// False when a check says that a force loop at 1 kHz cannot work.
bool force_loop_works(const std::vector<Finding>& findings);

/// A line per check, what to do below it, and a sentence about the whole; no line of prose is
/// longer than 100 columns. Ends with a newline.
std::string report_text(const std::vector<Finding>& findings, bool coloured);

/// The findings as one JSON object; its keys are explained in `cordis doctor --help`.
std::string report_json(const std::vector<Finding>& findings);

}  // namespace cordis::cli
