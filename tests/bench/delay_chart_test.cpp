// tests/bench/delay_chart_test.cpp
#include "tests/bench/delay_chart.h"

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::test {
namespace {

std::string file_named(const std::string& name) {
  return testing::TempDir() + name;
}

TEST(DelayChart, ReadsTheAgesOfThePlayedCommands) {
  const std::string trace = file_named("delay_chart_trace.csv");
  std::ofstream(trace) << "time_nsec,commanded_0,sensed_0,age_s\n"
                          "1000000000,0,0,inf\n"
                          "1001000000,0.5,-0.01,0.00012\n"
                          "1002000000,0.5,-0.01,0.0005\n"
                          "1502500001,0.1,-0.01,0.4\n"
                          "1502600000,0,0,0\n";

  EXPECT_EQ(read_ages(trace), (std::vector<double>{0.00012, 0.0005}));
}

TEST(DelayChart, ReadsNothingWhereNoCommandWas) {
  const std::string trace = file_named("delay_chart_empty.csv");
  std::ofstream(trace) << "time_nsec,commanded_0,sensed_0,age_s\n";

  EXPECT_TRUE(read_ages(trace).empty());
}

// 1 of 4 delays in the bin from 100 us on, 1 of 4 in that from 105 us on, half of them longer than the scale
TEST(DelayChart, CountsShares) {
  const std::string table = table_of_delays({100e-6, 105e-6, 1e-3, 7.0});

  EXPECT_NE(table.find("\n102.5 25\n"), std::string::npos) << table;
  EXPECT_NE(table.find("\n107.5 25\n"), std::string::npos) << table;
  EXPECT_NE(table.find("\n1002.5 50\n"), std::string::npos) << table;
  EXPECT_NE(table.find("\n97.5 NaN\n"), std::string::npos) << table;
}

TEST(DelayChart, DrawsEachCurve) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::string svg = file_named("delay_chart.svg");

  ASSERT_TRUE(draw_delays({{"first run", {1e-4, 2e-4}}, {"second run", {3e-4}}}, svg));

  std::ostringstream text;
  text << std::ifstream(svg).rdbuf();
  EXPECT_NE(text.str().find("first run"), std::string::npos);
  EXPECT_NE(text.str().find("second run"), std::string::npos);
  EXPECT_NE(text.str().find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace cordis::test
