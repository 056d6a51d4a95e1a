// tests/device/loop_meter_test.cpp
#include "device_node/loop_meter.h"

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

msg::NodeStatus status_of(const LoopMeter& meter) {
  msg::NodeStatus status;
  meter.fill(status);
  return status;
}

TEST(LoopMeter, ReportsWhatWasCounted) {
  LoopMeter meter;
  for (int n = 0; n < 5; ++n) meter.count_tick();
  meter.count_dropped();
  meter.count_dropped();
  meter.late_ticks().count(node::LateCause::kMachine);
  meter.late_ticks().count(node::LateCause::kMachine);
  meter.late_ticks().count(node::LateCause::kWork);
  meter.late_ticks().count(node::LateCause::kNone);
  for (int n = 0; n < 4; ++n) meter.late_ticks().count_silent();

  const msg::NodeStatus status = status_of(meter);

  EXPECT_EQ(status.ticks(), 5u);
  EXPECT_EQ(status.dropped(), 2u);
  EXPECT_EQ(status.overruns(), 3u);
  EXPECT_EQ(status.late_by_machine(), 2u);
  EXPECT_EQ(status.late_by_work(), 1u);
  EXPECT_EQ(status.silent_ticks(), 4u);
}

TEST(LoopMeter, CountsSamplesWithoutAnAnswerOfTheirOwn) {
  LoopMeter meter;
  EXPECT_EQ(status_of(meter).link_samples(), 0u);

  meter.record_answer(1);  // the first
  meter.record_answer(1);
  meter.record_answer(4);  // three between them have none

  EXPECT_EQ(status_of(meter).link_samples(), 6u);
  EXPECT_EQ(status_of(meter).link_unanswered(), 3u);
}

TEST(LoopMeter, ReportsItsPhase) {
  LoopMeter meter;
  EXPECT_EQ(status_of(meter).phase(), msg::PHASE_WAITING);
  meter.set_phase(Phase::kUnused);
  EXPECT_EQ(status_of(meter).phase(), msg::PHASE_UNUSED);
  meter.set_phase(Phase::kRunning);
  EXPECT_EQ(status_of(meter).phase(), msg::PHASE_RUNNING);
  EXPECT_EQ(status_of(meter).text(), "");
  meter.set_phase(Phase::kLost);
  EXPECT_EQ(status_of(meter).phase(), msg::PHASE_LOST);
  EXPECT_NE(status_of(meter).text(), "");
  meter.set_phase(Phase::kStopped);
  EXPECT_EQ(status_of(meter).phase(), msg::PHASE_STOPPED);
}

TEST(LoopMeter, EndsWithTheDeviceThatWasNeverConnected) {
  LoopMeter meter;
  EXPECT_EQ(meter.last_phase(), Phase::kStopped) << "no scene asked for the device";

  meter.record_device(false, false);
  EXPECT_EQ(meter.last_phase(), Phase::kNeverConnected);
  meter.set_phase(meter.last_phase());
  EXPECT_EQ(status_of(meter).phase(), msg::PHASE_FAILED);
  EXPECT_EQ(status_of(meter).text(), "the device was never connected");

  meter.record_device(false, false, /*is_taken=*/true);
  meter.set_phase(Phase::kLost);
  EXPECT_EQ(status_of(meter).text(), "another process drives this device; waits until it is free");
  meter.set_phase(meter.last_phase());
  EXPECT_EQ(status_of(meter).phase(), msg::PHASE_FAILED);
  EXPECT_EQ(status_of(meter).text(), "another process drove the device");

  meter.record_device(false, true);
  EXPECT_EQ(meter.last_phase(), Phase::kReplaced);
  meter.set_phase(meter.last_phase());
  EXPECT_EQ(status_of(meter).phase(), msg::PHASE_STOPPED);
  EXPECT_EQ(status_of(meter).text(), "the device was never connected; another node played it");

  meter.record_device(true, false);
  meter.record_device(false, false);  // it was unplugged
  EXPECT_EQ(meter.last_phase(), Phase::kStopped);
}

TEST(LoopMeter, ShowsLatenciesEvery256Ticks) {
  LoopMeter meter;
  for (int n = 0; n < 99; ++n) meter.record_latency(100'000);
  meter.record_latency(5'000'000);

  EXPECT_EQ(status_of(meter).latency_count(), 0u);
  for (int n = 0; n < 256; ++n) meter.count_tick();
  const msg::NodeStatus status = status_of(meter);

  EXPECT_EQ(status.latency_count(), 100u);
  EXPECT_NEAR(status.latency_p50_s(), 100e-6, 4e-6);  // bins are 3 % wide
  EXPECT_NEAR(status.latency_p99_s(), 100e-6, 4e-6);
  EXPECT_DOUBLE_EQ(status.latency_max_s(), 5e-3);
}

}  // namespace
}  // namespace cordis::device
