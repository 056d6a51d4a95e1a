// tests/integration/hostile_test.cpp -- any program may take part in a session; what it writes
// neither ends a node nor silences another.
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "idl/scene.h"
#include "node/config/name_hash.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"

namespace cordis::test {
namespace {

/// A key that a spring of 200 N/m holds 1 cm below its rest, and a stranger in its session.
class Hostile : public ::testing::Test {
 protected:
  Hostile() {
    session_.add_file("scene.yaml", wall_scene(200.0));
    session_.add_file("key.yaml", steady_key(-0.01, 0.0));
    session_.start("sim_node", "sim");
    session_.start("device_node", "keyboard");
  }

  /// Waits for the force of a true sample after this one.
  bool feels_after(std::uint64_t sample) {
    return eventually([&] {
      return forces_.take(force_) && std::abs(force_.force_n()[0] - 2.0) < 1e-9 &&
             force_.answered_sample() > sample && force_.answered_sample() < sample + 1'000'000;
    });
  }
  bool still_run() {
    return session_.node("sim").wait(std::chrono::milliseconds(0)) == -1 &&
           session_.node("keyboard").wait(std::chrono::milliseconds(0)) == -1;
  }

  LiveSession session_{"realtime", kSimAndKey};
  StatusWatch status_{session_.participant()};
  dds::Reader<msg::GestureForces> forces_{session_.participant(), dds::Topic::kForces};
  msg::GestureForces force_;
};

TEST_F(Hostile, ASampleOfTheHighestNumberSilencesNoDevice) {
  dds::Writer<msg::GesturePositions> positions(session_.participant(), dds::Topic::kPositions);
  ASSERT_TRUE(feels_after(500));
  ASSERT_TRUE(eventually([&] { return positions.matched_count() > 0; }));
  msg::GesturePositions sample;
  sample.device_id(config::name_hash("keyboard"));
  sample.epoch(force_.answered_epoch());
  sample.axis_count(1);
  for (const double place : {1e300, -1e300, 0.5, std::nan("")}) {
    SCOPED_TRACE("at " + std::to_string(place) + " m");
    const std::uint64_t before = force_.answered_sample();
    sample.sample(~std::uint64_t{0});
    sample.time_nsec(INT64_MAX);
    sample.position_m().fill(place);
    EXPECT_TRUE(positions.write(sample));
    EXPECT_TRUE(feels_after(before + 200)) << "the true device is answered again";
  }
  EXPECT_TRUE(still_run());
}

TEST_F(Hostile, AnAnswerOfAnyNumberLeavesTheTrueOnes) {
  dds::Writer<msg::GestureForces> answers(session_.participant(), dds::Topic::kForces);
  ASSERT_TRUE(feels_after(500));
  ASSERT_TRUE(eventually([&] { return answers.matched_count() > 1; }));
  msg::GestureForces answer = force_;
  answer.sample(~std::uint64_t{0});
  answer.answered_sample(~std::uint64_t{0});
  answer.answered_time_nsec(INT64_MIN);
  answer.force_n().fill(1e300);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(answers.write(answer));

  EXPECT_TRUE(feels_after(force_.answered_sample() + 500));
  EXPECT_TRUE(status_.wait_for_phase("keyboard", "running"));
  EXPECT_TRUE(still_run());
}

TEST_F(Hostile, ADescriptionOfAnUnknownRoleIsRefusedAndTheDevicePlaysOn) {
  dds::Writer<msg::SceneDescription> descriptions(session_.participant(), dds::Topic::kDescription);
  ASSERT_TRUE(feels_after(500));
  ASSERT_TRUE(eventually([&] { return descriptions.matched_count() > 0; }));
  for (const std::uint32_t role : {7u, 0u}) {  // the second one with an axis that no key has
    msg::PortDescription port;
    port.name("port\n\033[2J");
    port.device_id(config::name_hash("keyboard"));
    port.role(role);
    port.axes({4'000'000'000u});
    msg::SceneDescription scene;
    scene.epoch(1);
    scene.name("hostile");
    scene.ports({port});
    EXPECT_TRUE(descriptions.write(scene));
    const std::string what = role == 7 ? "the unknown role 7" : "wants axis 4000000000";
    EXPECT_TRUE(status_.wait_for("keyboard", [&](const msg::NodeStatus& now) {
      return now.text().find("refused") != std::string::npos &&
             now.text().find(what) != std::string::npos;
    })) << what;
    EXPECT_TRUE(feels_after(force_.answered_sample() + 200));
  }
  EXPECT_TRUE(still_run());
  const std::string said = session_.node("keyboard").output();
  EXPECT_EQ(said.find('\033'), std::string::npos) << said;
  std::size_t times = 0;
  for (std::size_t at = said.find("unknown role"); at != std::string::npos;
       at = said.find("unknown role", at + 1)) {
    ++times;
  }
  EXPECT_EQ(times, 1u) << "it is told once\n" << said;
}

}  // namespace
}  // namespace cordis::test
