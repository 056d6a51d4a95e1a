// cli/test/test_words.h -- what the words of `cordis test` ask of ctest.
#pragma once

#include <string>
#include <vector>

namespace cordis::cli {

/// What is started.
struct TestWords {
  std::vector<std::string> ctest;  ///< options of ctest
  double soak_s = 0.0;             ///< how long a session of a campaign lasts [s]; 0 without --long
};

/// `--long` stands for the campaigns alone, one after the other; `--hours N` for how long their sessions last (0.5). All
/// else is ctest's.
/// @throws UsageError for `--hours` without `--long`, and for a number that is not from 0.001 to 1000
TestWords test_words(const std::vector<std::string>& words);

}  // namespace cordis::cli
