// tests/cli/output_watcher_test.cpp
#include "cli/run/output_watcher.h"

#include <string>

#include <gtest/gtest.h>

namespace cordis::cli {
namespace {

Command shell(const char* text) {
  return {{"/bin/sh", "-c", text}};
}

TEST(OutputWatcher, KeepsTheLinesOfEachProcess) {
  StopSignals signals;
  OutputWatcher watcher(2, std::chrono::hours(1));
  supervise({shell("echo one; echo two >&2"), shell("echo three")}, watcher, signals);

  const std::string& both = watcher.output(0);
  EXPECT_NE(both.find("one\n"), std::string::npos);
  EXPECT_NE(both.find("two\n"), std::string::npos);
  EXPECT_EQ(watcher.output(1), "three\n");
  EXPECT_FALSE(watcher.is_late());
}

TEST(OutputWatcher, EndsProcessesThatTakeTooLong) {
  StopSignals signals;
  OutputWatcher watcher(1, std::chrono::seconds(0));
  supervise({shell("exec sleep 10000")}, watcher, signals);  // else longer than any test may take

  EXPECT_TRUE(watcher.is_late());
}

}  // namespace
}  // namespace cordis::cli
