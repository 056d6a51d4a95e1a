// cli/test/test_words.cpp
#include "cli/test/test_words.h"

#include "cli/command_line.h"
#include "cli/number.h"

namespace cordis::cli {

TestWords test_words(const std::vector<std::string>& words) {
  TestWords asked;
  std::string hours;
  bool is_long = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--long") {
      is_long = true;
    } else if (words[i] == "--hours") {
      if (++i == words.size()) throw UsageError("--hours needs a number");
      hours = words[i];
    } else {
      asked.ctest.push_back(words[i]);
    }
  }
  if (!is_long && !hours.empty()) throw UsageError("--hours is for --long");
  if (!is_long) return asked;
  constexpr double kSecondsPerHour = 3600.0;
  asked.soak_s =
      kSecondsPerHour * (hours.empty() ? 0.5 : parse_number("--hours", hours, 0.001, 1000.0));
  const std::vector<std::string> campaigns{"-C", "Long", "-L", "campaign", "-j1"};
  asked.ctest.insert(asked.ctest.begin(), campaigns.begin(), campaigns.end());
  return asked;
}

}  // namespace cordis::cli
