// cli/number.cpp
#include "cli/number.h"

#include <charconv>

#include "cli/command_line.h"
#include "node/config/mapping_reader.h"

namespace cordis::cli {

double parse_number(const std::string& option, const std::string& text, double lowest,
                    double highest) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || !(number >= lowest) || !(number <= highest)) {
    throw UsageError(option + " must be a number from " + config::number_text(lowest) + " to " +
                     config::number_text(highest) + ", got '" + text + "'");
  }
  return number;
}

}  // namespace cordis::cli
