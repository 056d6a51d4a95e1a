// cli/number.h -- a number as a person types it.
#pragma once

#include <string>

namespace cordis::cli {

/// @throws UsageError unless the text is a number within the range
double parse_number(const std::string& option, const std::string& text, double lowest,
                    double highest);
/// Reads a whole number. @throws UsageError unless the text is one within the range
int parse_whole_number(const std::string& option, const std::string& text, int lowest, int highest);

}  // namespace cordis::cli
