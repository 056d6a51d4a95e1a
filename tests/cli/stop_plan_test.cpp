// tests/cli/stop_plan_test.cpp
#include "cli/run/stop_plan.h"

#include <string>

#include <gtest/gtest.h>

namespace cordis::cli {
namespace {

using std::chrono::milliseconds;

/// Processes that end when asked, when killed, or not even then, on a clock that only the test
/// moves.
class Rehearsal {
 public:
  enum Manner { kStops, kIgnores };

  Rehearsal(const std::vector<int>& stages, std::vector<Manner> manners,
            const std::vector<bool>& drives_motors = {})
      : plan_(stages, drives_motors), manners_(std::move(manners)), running_(stages.size(), true) {}

  void begin() { plan_.begin(now_); }
  void hurry() { plan_.hurry(now_); }
  void end(std::size_t process) { running_[process] = false; }

  /// What the plan does at this moment, as "ask 1, kill 2"; processes end as they do.
  std::string act() {
    std::string report;
    for (const auto& [process, kill] : plan_.due(now_, running_)) {
      report += (report.empty() ? "" : ", ") + std::string(kill ? "kill " : "ask ") +
                std::to_string(process);
      if (kill || manners_[process] == kStops) running_[process] = false;
    }
    return report;
  }

  void pass(milliseconds time) { now_ += time; }
  milliseconds time_left() const {
    return std::chrono::duration_cast<milliseconds>(*plan_.deadline() - now_);
  }

 private:
  StopPlan plan_;
  std::vector<Manner> manners_;
  std::vector<bool> running_;
  StopPlan::Time now_{std::chrono::hours(1)};
};

constexpr auto kStops = Rehearsal::kStops;
constexpr auto kIgnores = Rehearsal::kIgnores;

TEST(StopPlan, DoesNothingBeforeItBegins) {
  Rehearsal rehearsal({0, 1}, {kStops, kStops});
  EXPECT_EQ(rehearsal.act(), "");
}

TEST(StopPlan, AsksStageAfterStage) {
  Rehearsal rehearsal({2, 0, 1, 3, 0}, {kStops, kStops, kStops, kStops, kStops});
  rehearsal.begin();
  EXPECT_EQ(rehearsal.act(), "ask 1, ask 4");
  EXPECT_EQ(rehearsal.act(), "ask 2");
  EXPECT_EQ(rehearsal.act(), "ask 0");
  EXPECT_EQ(rehearsal.act(), "ask 3");
  EXPECT_EQ(rehearsal.act(), "");
}

TEST(StopPlan, WaitsForAllOfAStageAndKillsThemAfterTwoSeconds) {
  Rehearsal rehearsal({0, 0, 1}, {kIgnores, kStops, kStops});
  rehearsal.begin();
  EXPECT_EQ(rehearsal.act(), "ask 0, ask 1");
  EXPECT_EQ(rehearsal.time_left(), milliseconds(2000));
  rehearsal.pass(milliseconds(1999));
  EXPECT_EQ(rehearsal.act(), "");
  rehearsal.pass(milliseconds(1));
  EXPECT_EQ(rehearsal.act(), "kill 0");
  EXPECT_EQ(rehearsal.act(), "ask 2");
}

TEST(StopPlan, EndsWithinFiveSecondsEvenWhenNobodyListens) {
  Rehearsal rehearsal({0, 1, 2, 3}, {kIgnores, kIgnores, kIgnores, kIgnores});
  rehearsal.begin();
  milliseconds passed{0};
  for (int process = 0; process < 4; ++process) {
    ASSERT_EQ(rehearsal.act(), "ask " + std::to_string(process));
    const milliseconds left = rehearsal.time_left();
    EXPECT_GE(left, milliseconds(500)) << "for process " << process;
    rehearsal.pass(left);
    passed += left;
    ASSERT_EQ(rehearsal.act(), "kill " + std::to_string(process));
  }
  EXPECT_LT(passed, milliseconds(5000));
}

TEST(StopPlan, InAHurryLeavesMotorsHalfASecondToLetGo) {
  Rehearsal rehearsal({2, 0, 0, 1}, {kIgnores, kIgnores, kStops, kIgnores},
                      {false, true, true, false});
  rehearsal.begin();
  EXPECT_EQ(rehearsal.act(), "ask 1, ask 2");
  rehearsal.pass(milliseconds(300));
  rehearsal.hurry();
  EXPECT_EQ(rehearsal.act(), "kill 0, ask 1, kill 3");
  EXPECT_EQ(rehearsal.time_left(), milliseconds(500));
  rehearsal.hurry();
  rehearsal.pass(milliseconds(499));
  EXPECT_EQ(rehearsal.act(), "");
  rehearsal.pass(milliseconds(1));
  EXPECT_EQ(rehearsal.act(), "kill 1");
  EXPECT_EQ(rehearsal.act(), "");
}

TEST(StopPlan, SkipsStagesThatHaveEnded) {
  Rehearsal rehearsal({0, 1, 2}, {kStops, kStops, kStops});
  rehearsal.end(0);
  rehearsal.end(1);
  rehearsal.begin();
  EXPECT_EQ(rehearsal.act(), "ask 2");
}

}  // namespace
}  // namespace cordis::cli
