// cli/check/take_report.h -- `cordis check` of a take: what is wrong with it, and where.
#pragma once

#include <string>

namespace cordis::cli {

/// Checks a take and says what was found. @param json_file  empty: none; "-": instead of the text
/// @return the exit code
int check_take_file(const std::string& file, const std::string& json_file);

}  // namespace cordis::cli
