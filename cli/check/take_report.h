// cli/check/take_report.h -- `cordis check` of a take: what is wrong with it, and where.
#pragma once

#include <string>

namespace cordis::cli {

/// What was found out about a take.
struct TakeReport {
  std::string text;  ///< for a person
  std::string json;  ///< for a program
  bool whole = false;
};

/// Checks a take. @throws UsageError when it cannot be read
TakeReport check_take_file(const std::string& file);

}  // namespace cordis::cli
