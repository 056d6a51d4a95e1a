// tests/device/phase_log_test.cpp
#include "device_node/phase_log.h"

#include <gtest/gtest.h>

#include "tests/support/captured_log.h"

namespace cordis::device {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

PhaseLog key_log() {
  return {"keyboard", "kfb1", 0.02};
}

TEST(PhaseLog, ReportsEachChangeInItsWords) {
  const test::CapturedLog log;
  PhaseLog phases = key_log();
  EXPECT_FALSE(phases.note(Phase::kWaiting, true, 0)) << "it waits at first";
  EXPECT_TRUE(phases.note(Phase::kRunning, true, 0));
  EXPECT_TRUE(phases.note(Phase::kLost, true, 0));
  EXPECT_FALSE(phases.note(Phase::kLost, true, 0));
  phases.note(Phase::kRunning, true, 250 * kMillisecond);
  phases.note(Phase::kLost, false, 300 * kMillisecond);
  phases.note(Phase::kDisconnected, true, 400 * kMillisecond);
  phases.note(Phase::kStandby, true, 500 * kMillisecond);
  phases.note(Phase::kRunning, true, 600 * kMillisecond);

  EXPECT_EQ(log.lines(""),
            R"(no answer from the scene for more than 20 ms: motors at zero
plays again after 0.250 s
driver kfb1: the device does not answer; trying again. Check its power, its cable, and its address in the device file
driver kfb1: the motors have been let go of outside the loop; forces return by the ramp
the scene answers another process that plays 'keyboard'; ready to take over
takes over 'keyboard'
)");
}

/// Lets the device be missing from 0 on, a look per 100 ms.
void miss_first_device(PhaseLog& phases, std::int64_t until) {
  for (std::int64_t now = 0; now <= until; now += 100 * kMillisecond) {
    phases.note(Phase::kLost, false, now);
    phases.report(now);
  }
}

TEST(PhaseLog, WarnsOfNoDeviceThatAnswersWithin3Seconds) {
  const test::CapturedLog log;
  PhaseLog phases = key_log();
  miss_first_device(phases, 2900 * kMillisecond);
  // The board is connected now. The scene answers later.
  phases.note(Phase::kLost, true, 2950 * kMillisecond);
  phases.report(2950 * kMillisecond);
  phases.report(3100 * kMillisecond);
  phases.note(Phase::kRunning, true, 3200 * kMillisecond);

  EXPECT_EQ(log.lines(""), "plays 'keyboard'\n");
}

TEST(PhaseLog, WarnsOnceOfADeviceThatIsMissingFromTheStart) {
  const test::CapturedLog log;
  PhaseLog phases = key_log();
  miss_first_device(phases, 9000 * kMillisecond);
  phases.note(Phase::kRunning, true, 9100 * kMillisecond);

  EXPECT_EQ(
      log.lines(""),
      R"(driver kfb1: the device does not answer; trying again. Check its power, its cable, and its address in the device file
plays 'keyboard'
)");
}

TEST(PhaseLog, AsksForNoCableOfADeviceThatAnotherProcessDrives) {
  const test::CapturedLog log;
  PhaseLog phases = key_log();
  for (std::int64_t now = 0; now <= 9000 * kMillisecond; now += 100 * kMillisecond) {
    phases.note(Phase::kLost, false, now, /*is_taken=*/true);
    phases.report(now);
  }
  EXPECT_EQ(log.lines(""), "");
  for (std::int64_t now = 9000 * kMillisecond; now <= 13000 * kMillisecond;
       now += 100 * kMillisecond) {
    phases.note(Phase::kLost, false, now);  // it is free, and not there
    phases.report(now);
  }
  EXPECT_NE(log.lines("").find("the device does not answer"), std::string::npos);
}

TEST(PhaseLog, CountsAPhaseThatComesAndGoes) {
  const test::CapturedLog log;
  PhaseLog phases = key_log();
  phases.note(Phase::kRunning, true, 0);
  for (std::int64_t n = 0; n < 50; ++n) {
    const std::int64_t now = n * 100 * kMillisecond;
    phases.note(Phase::kDisconnected, true, now);
    phases.report(now);
    phases.note(Phase::kRunning, true, now + (n + 1) * kMillisecond);
  }
  phases.report(5'001 * kMillisecond);

  EXPECT_EQ(
      log.lines(""),
      R"(driver kfb1: the motors have been let go of outside the loop; forces return by the ramp
plays again after 0.001 s
driver kfb1: the motors were let go of outside the loop: 49 more times in 5 s
played again: 49 more times in 5 s, the worst 50 ms
)");
}

}  // namespace
}  // namespace cordis::device
