// cli/number.cpp
#include "cli/number.h"

#include <charconv>

#include "cli/command_line.h"
#include "node/config/mapping_reader.h"

namespace cordis::cli {
namespace {

template <typename Number>
Number parse(const std::string& option, const std::string& text, Number lowest, Number highest,
             const std::string& what) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || !(number >= lowest) || !(number <= highest)) {
    throw UsageError(option + " must be " + what + " from " + config::number_text(lowest) + " to " +
                     config::number_text(highest) + ", got '" + text + "'");
  }
  return number;
}

}  // namespace

double parse_number(const std::string& option, const std::string& text, double lowest,
                    double highest) {
  return parse(option, text, lowest, highest, "a number");
}

int parse_whole_number(const std::string& option, const std::string& text, int lowest,
                       int highest) {
  return parse(option, text, lowest, highest, "a whole number");
}

}  // namespace cordis::cli
