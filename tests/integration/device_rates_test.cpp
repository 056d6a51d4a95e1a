// tests/integration/device_rates_test.cpp -- devices of two rates in one real session.
#include <cmath>
#include <csignal>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "node/config/name_hash.h"
#include "node/dds/arrival.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"

namespace cordis::test {
namespace {

constexpr const char* kSimKeyAndPedal =
    R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
  pedal: {node: device_node, device: pedal.yaml}
)";

/// wall_scene() with a second device before the same spring.
std::string two_port_scene() {
  std::string scene = wall_scene(200.0);
  const std::string links = "links:\n";
  scene.insert(scene.find(links),
               "  pedal: {device: pedal, axes: [0], role: mass, coupling: direct, at_m: [0]}\n");
  return scene + "  - {liaison: wall, between: [pedal, ground]}\n";
}

std::string at_rate(std::string device, const std::string& rate_hz) {
  const std::string rate = "rate_hz: 1000";
  return device.replace(device.find(rate), rate.size(), "rate_hz: " + rate_hz);
}

/// Answers to one device, by what its samples say of them.
struct Answers {
  std::uint64_t applied = 0;
  std::uint64_t on_arrival = 0;  // in the half of a period in which the motors wait for one
};

class DeviceRates : public ::testing::Test {
 protected:
  DeviceRates() : session_("realtime", kSimKeyAndPedal), status_(session_.participant()) {
    session_.add_file("scene.yaml", two_port_scene());
    session_.add_file("key.yaml", steady_key(-0.01, 0.0));
    session_.add_file("pedal.yaml", at_rate(steady_key(-0.02, 0.0), "250"));
    session_.start("sim_node", "sim");
    for (const char* node : {"keyboard", "pedal"}) session_.start("device_node", node);
  }

  /// The answers to the next samples of a device, until so many have been applied.
  Answers next_answers(const std::string& device, double period_s, std::uint64_t count) {
    dds::Arrival arrival;
    dds::Reader<msg::GesturePositions> positions(session_.participant(), dds::Topic::kPositions,
                                                 &arrival);
    const std::uint32_t id = config::name_hash(device);
    Answers answers;
    msg::GesturePositions sample;
    std::uint64_t newest = 0;
    EXPECT_TRUE(eventually([&] {
      while (positions.take(sample)) {
        if (sample.device_id() != id || sample.answered_sample() == newest) continue;
        newest = sample.answered_sample();
        ++answers.applied;
        answers.on_arrival += sample.answer_delay_s() < 0.5 * period_s;
      }
      return answers.applied >= count;
    })) << device
        << ": " << answers.applied;
    return answers;
  }

  LiveSession session_;
  StatusWatch status_;
};

TEST_F(DeviceRates, EachGetsItsForcesAndTheSlowOneDelaysNoAnswerToTheFastOne) {
  dds::Reader<msg::GestureForces> forces(session_.participant(), dds::Topic::kForces);
  bool fast_feels = false;
  bool slow_feels = false;
  ASSERT_TRUE(eventually([&] {
    msg::GestureForces force;
    while (forces.take(force)) {
      const bool is_fast = force.device_id() == config::name_hash("keyboard");
      const double wanted_n = is_fast ? 2.0 : 4.0;  // 200 N/m, 10 and 20 mm
      if (std::abs(force.force_n()[0] - wanted_n) < 1e-9)
        (is_fast ? fast_feels : slow_feels) = true;
    }
    return fast_feels && slow_feels;
  })) << fast_feels
      << slow_feels;
  for (const char* node : {"keyboard", "pedal"})
    EXPECT_TRUE(status_.wait_for_phase(node, msg::PHASE_RUNNING)) << node;

  // A scene that waited for the slow one would answer three of four samples half a period later.
  const Answers fast = next_answers("keyboard", 1e-3, 3000);
  EXPECT_GT(5 * fast.on_arrival, 2 * fast.applied) << fast.on_arrival << " of " << fast.applied;
  const Answers slow = next_answers("pedal", 4e-3, 500);
  EXPECT_GT(5 * slow.on_arrival, 2 * slow.applied) << slow.on_arrival << " of " << slow.applied;
}

TEST_F(DeviceRates, OneThatFallsSilentDelaysNoAnswerToTheOther) {
  next_answers("keyboard", 1e-3, 1000);
  next_answers("pedal", 4e-3, 250);

  session_.node("pedal").signal(SIGSTOP);
  next_answers("keyboard", 1e-3, 100);  // it counts as silent after 20 ms
  const Answers fast = next_answers("keyboard", 1e-3, 2000);
  session_.node("pedal").signal(SIGCONT);

  // A scene that waited for the silent one would answer at the end of each period.
  EXPECT_GT(5 * fast.on_arrival, 2 * fast.applied) << fast.on_arrival << " of " << fast.applied;
  EXPECT_TRUE(status_.wait_for_phase("pedal", msg::PHASE_RUNNING)) << "back by itself";
}

}  // namespace
}  // namespace cordis::test
