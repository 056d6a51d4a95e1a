// tests/cli/captured_run.h -- the program within the test: its code, and what it says.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/command_line.h"

namespace cordis::cli {

/// @return the exit code
inline int run_captured(CommandLine& line, const std::vector<std::string>& words, std::string& out,
                        std::string& error) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = line.run(words);
  out = testing::internal::GetCapturedStdout();
  error = testing::internal::GetCapturedStderr();
  return code;
}

}  // namespace cordis::cli
