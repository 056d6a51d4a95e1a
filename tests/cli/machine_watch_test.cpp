// tests/cli/machine_watch_test.cpp
#include "cli/run/machine_watch.h"

#include <gtest/gtest.h>

namespace cordis::cli {
namespace {

machine::TimerFigures figures_of(double late_share, double worst_s) {
  return {10.0, late_share, worst_s, 0.0, 0.5, 2};
}

class MachineWatchTest : public testing::Test {
 protected:
  machine::TimerFigures figures_ = figures_of(0.04, 0.255);
  MachineWatch watch_{[this] { return figures_; }};
};

TEST_F(MachineWatchTest, SaysHowLateTheMachineWokeItsTimers) {
  EXPECT_EQ(watch_.sentence({5, 1}),
            "the machine itself woke 4 % of timers late; worst 255 ms (`cordis doctor` says what "
            "to do)");
}

TEST_F(MachineWatchTest, SaysWhatAHypervisorTook) {
  figures_.stolen_share = 0.125;
  EXPECT_EQ(watch_.sentence({5, 1}),
            "the machine itself woke 4 % of timers late; worst 255 ms; its hypervisor took 12 % "
            "of the processor time (`cordis doctor` says what to do)");

  figures_ = figures_of(0.001, 0.001);
  figures_.stolen_share = 0.125;
  EXPECT_EQ(watch_.sentence({5, 1}),
            "the hypervisor took 12 % of the processor time (`cordis doctor` says what to do)");
}

TEST_F(MachineWatchTest, BlamesNoMachineThatKeepsTime) {
  figures_ = figures_of(0.001, 0.001);
  EXPECT_EQ(watch_.sentence({5, 1}), "");
  figures_.stolen_share.reset();
  EXPECT_EQ(watch_.sentence({5, 1}), "");
  figures_ = figures_of(0.001, 0.011);
  EXPECT_NE(watch_.sentence({5, 1}), "") << "one long stall";
  figures_ = figures_of(0.011, 0.001);
  EXPECT_NE(watch_.sentence({5, 1}), "") << "many short ones";
}

TEST_F(MachineWatchTest, BlamesNoMachineForWhatTheSessionItselfTakes) {
  figures_.own_share = 0.97;
  figures_.core_count = 1;
  EXPECT_EQ(
      watch_.sentence({5, 1}),
      "the session itself took 97 % of the time of the 1 core that it may use: its loops wait "
      "for each other; give it more cores, or less to compute");
  EXPECT_EQ(watch_.sentence_when_repeated({5, 1}), watch_.sentence({5, 1}));
}

TEST_F(MachineWatchTest, WritesLongStallsInMilliseconds) {
  figures_.worst_s = 1.0523;
  EXPECT_NE(watch_.sentence({5, 1}).find("; worst 1052 ms"), std::string::npos);
}

TEST_F(MachineWatchTest, BlamesNoMachineForASceneThatIsTooSlow) {
  EXPECT_EQ(watch_.sentence({5, 500}), "");
  EXPECT_EQ(watch_.sentence({0, 0}), "") << "no tick was late";
}

TEST_F(MachineWatchTest, SaysItOnceWhileTheSessionRunsWhenLateTicksRepeat) {
  figures_.watched_s = 1.9;
  EXPECT_EQ(watch_.sentence_when_repeated({5, 1}), "") << "it has not looked for long enough";
  figures_.watched_s = 2.0;
  EXPECT_EQ(watch_.sentence_when_repeated({2, 0}), "") << "too few to speak of";

  EXPECT_EQ(watch_.sentence_when_repeated({3, 0}), watch_.sentence({3, 0}));
  EXPECT_EQ(watch_.sentence_when_repeated({300, 0}), "");
}

}  // namespace
}  // namespace cordis::cli
