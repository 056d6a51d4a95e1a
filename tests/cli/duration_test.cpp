// tests/cli/duration_test.cpp
#include "cli/duration.h"

#include <gtest/gtest.h>

#include "cli/command_line.h"

namespace cordis::cli {
namespace {

using std::chrono::nanoseconds;

TEST(Duration, IsANumberAndAUnit) {
  EXPECT_EQ(parse_duration("500ms"), nanoseconds(500'000'000));
  EXPECT_EQ(parse_duration("10s"), nanoseconds(10'000'000'000));
  EXPECT_EQ(parse_duration("1.5s"), nanoseconds(1'500'000'000));
  EXPECT_EQ(parse_duration("2min"), nanoseconds(120'000'000'000));
  EXPECT_EQ(parse_duration("1h"), nanoseconds(3'600'000'000'000));
}

TEST(Duration, RefusesEverythingElse) {
  for (const char* text :
       {"", "10", "s", "-1s", "+1s", "0s", "1e3s", "nans", "infs", "10 s", "10sec", "10S", "1s2",
        "0.0000000001s", "10001h", "99999999999999999999999h"}) {
    EXPECT_THROW(parse_duration(text), UsageError) << text;
  }
}

TEST(Duration, OfAnOffsetMayBeZero) {
  EXPECT_EQ(parse_offset("0"), nanoseconds(0));
  EXPECT_EQ(parse_offset("0s"), nanoseconds(0));
  EXPECT_EQ(parse_offset("0ms"), nanoseconds(0));
  EXPECT_EQ(parse_offset("1.5s"), nanoseconds(1'500'000'000));
  for (const char* text : {"", "-1s", "-0.5ms", "1", "0 s", "nans", "s", "10001h"})
    EXPECT_THROW(parse_offset(text), UsageError) << text;
}

TEST(Duration, SaysWhatToWriteInstead) {
  try {
    parse_duration("10");
    FAIL() << "a number without unit was taken";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "'10' is not a duration: write a number and ms, s, min or h, like 10s");
  }
}

TEST(Duration, IsWrittenInSecondsWithoutLoss) {
  EXPECT_EQ(in_seconds(parse_duration("10s")), "10");
  EXPECT_EQ(in_seconds(parse_duration("250ms")), "0.25");
  EXPECT_EQ(in_seconds(parse_duration("0.1s")), "0.1");
}

}  // namespace
}  // namespace cordis::cli
