// tests/sim/arrival_pace_test.cpp -- why a scene in real time comes too late.
#include "sim_node/arrival_pace.h"

#include <ctime>
#include <optional>

#include <gtest/gtest.h>

#include "node/dds/participant.h"
#include "node/processor_time.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/test_domain.h"

namespace cordis::sim {
namespace {

constexpr double kPaceRate = 1000.0;            // [Hz]
constexpr std::int64_t kLongTime = 20'500'000;  // [ns], of some 20 periods
constexpr std::int64_t kLongWork = 3'000'000;   // [ns], of 3 periods

/// A scene without a device: the clock of this host alone sets the pace.
struct Paced {
  dds::Participant participant{{test::own_domain(), "pace", "sim"}};
  dds::Participant for_loop{{test::own_domain(), "pace", "sim-loop"}};
  DeviceLink link{participant, for_loop, kEpochOfSim, config::Clock::kRealtime, 0.95};
  Simulation simulation{scene_of(swing_text()), kEpochOfSim};
  InputLog inputs;
  ArrivalPace pace{kPaceRate};

  node::LateCause next_tick() {
    std::optional<node::LateCause> cause;
    while (!cause) cause = pace.wait(simulation, link, inputs);
    return *cause;
  }
  static void compute() {
    const std::int64_t begun = node::thread_processor_nsec();
    while (node::thread_processor_nsec() - begun < kLongWork) {
    }
  }
  static void do_nothing() {
    const timespec time{0, kLongTime};
    nanosleep(&time, nullptr);
  }
};

TEST(ArrivalPace, TakesATickThatComputesTooLongForTheCauseOfALateOne) {
  Paced paced;
  paced.next_tick();
  for (int n = 0; n < 3; ++n) {
    paced.compute();
    EXPECT_EQ(paced.next_tick(), node::LateCause::kWork);
    paced.do_nothing();
    EXPECT_EQ(paced.next_tick(), node::LateCause::kMachine);
  }
}

TEST(ArrivalPace, HasComputedNothingBeforeItsFirstTickAtAnotherRate) {
  Paced paced;
  paced.next_tick();
  paced.compute();
  ASSERT_EQ(paced.next_tick(), node::LateCause::kWork);

  paced.compute();
  paced.pace.restart(0.5 * kPaceRate);
  paced.do_nothing();

  EXPECT_EQ(paced.next_tick(), node::LateCause::kMachine);
  EXPECT_EQ(paced.pace.rate_hz(), 0.5 * kPaceRate);
}

}  // namespace
}  // namespace cordis::sim
