// tests/integration/hostile_test.cpp -- any program may take part in a session; what it writes
// neither ends a node nor silences another.
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
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
#include "tests/support/datagrams.h"

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
  EXPECT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING));
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
    port.role(static_cast<msg::PortRole>(role));
    port.axes({4'000'000'000u});
    msg::SceneDescription scene;
    scene.wire_version(msg::WIRE_VERSION);
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
  for (std::size_t position = said.find("unknown role"); position != std::string::npos;
       position = said.find("unknown role", position + 1)) {
    ++times;
  }
  EXPECT_EQ(times, 1u) << "it is reported once\n" << said;
}

constexpr std::uint32_t kAnotherVersion = msg::WIRE_VERSION + 6;

/// A key of another version of the wire, in the session of a sim_node or alone.
dds::ParticipantConfig of_another_version(LiveSession& session, const std::string& node) {
  dds::ParticipantConfig config = session.participant().config();
  config.node = node;
  config.wire_version = kAnotherVersion;
  return config;
}

std::string of_versions(const std::string& node) {
  return "'" + node + "' speaks version " + std::to_string(kAnotherVersion) +
         " of the wire and this process version " + std::to_string(msg::WIRE_VERSION);
}

// Fast DDS alone aborts at the first one: APacketWithOneByteMore.
TEST_F(Hostile, APacketWithOneByteMoreEndsNoNodeAndTakesNoForce) {
  ASSERT_TRUE(feels_after(500));
  std::optional<Datagram> packet = an_announcement();
  ASSERT_TRUE(packet);
  packet->push_back(0);
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t before = force_.answered_sample();
    send_to_all(*packet);
    ASSERT_TRUE(feels_after(before)) << i;
    ASSERT_TRUE(still_run()) << i;
  }
}

TEST(AnotherWireVersion, OfADeviceIsGivenNoForceAndNamedOnce) {
  LiveSession session("realtime", kSimAndKey);
  session.add_file("scene.yaml", wall_scene(200.0));
  session.add_file("key.yaml", steady_key(-0.01, 0.0));
  ChildProcess& sim = session.start("sim_node", "sim");
  StatusWatch status(session.participant());
  dds::Participant key(of_another_version(session, "keyboard"));
  dds::Writer<msg::GesturePositions> positions(key, dds::Topic::kPositions);
  dds::Reader<msg::GestureForces> forces(session.participant(), dds::Topic::kForces);
  ASSERT_TRUE(
      eventually([&] { return positions.matched_count() > 0 && forces.matched_count() > 0; }));

  msg::GesturePositions sample;
  sample.device_id(config::name_hash("keyboard"));
  sample.epoch(1);
  sample.axis_count(1);
  sample.position_m()[0] = -0.01;
  const std::string refusal =
      of_versions("test/keyboard") + ": its messages are refused, and no force flows";
  EXPECT_TRUE(status.wait_for("sim", [&](const msg::NodeStatus& said) {
    for (int i = 0; i < 20; ++i) {
      sample.sample(sample.sample() + 1);
      EXPECT_TRUE(positions.write(sample));
    }
    return sample.sample() > 2000 && said.text().find(refusal) != std::string::npos;
  }));
  msg::GestureForces force;
  EXPECT_FALSE(forces.take(force)) << "an answer to sample " << force.answered_sample();
  EXPECT_TRUE(status.wait_for_phase("sim", msg::PHASE_WAITING));
  const std::string log = sim.output();
  EXPECT_NE(log.find(refusal), std::string::npos);
  EXPECT_EQ(log.find(refusal), log.rfind(refusal)) << log;
}

TEST(AnotherWireVersion, OfASceneIsNotPlayedAndCtlSaysWhy) {
  LiveSession session("realtime", kSimAndKey);
  session.add_file("key.yaml", steady_key(-0.01, 0.0));
  session.start("device_node", "keyboard");
  dds::Participant sim(of_another_version(session, "sim"));
  dds::Writer<msg::SceneDescription> descriptions(sim, dds::Topic::kDescription);
  dds::Writer<msg::GestureForces> forces(sim, dds::Topic::kForces);
  dds::Reader<msg::GesturePositions> samples(session.participant(), dds::Topic::kPositions);
  StatusWatch status(session.participant());
  msg::PortDescription port;
  port.device_id(config::name_hash("keyboard"));
  port.axes({0});
  msg::SceneDescription scene;
  scene.epoch(1);
  scene.gesture_rate_hz(1000.0);
  scene.ports({port});
  EXPECT_TRUE(descriptions.write(scene));

  const std::string refusal = of_versions("test/sim");
  EXPECT_TRUE(status.wait_for("keyboard", [&](const msg::NodeStatus& said) {
    return said.text().find(refusal) != std::string::npos;
  }));
  EXPECT_EQ(status.of("keyboard").phase(), msg::PHASE_WAITING);
  EXPECT_EQ(samples.matched_count(), 0) << "it plays no role";

  ChildProcess ctl({program_path("cordis"), "ctl", session.launch_file(), "pause"});
  EXPECT_EQ(ctl.wait(kPatience), 1);
  EXPECT_NE(ctl.output().find(refusal), std::string::npos) << ctl.output();
}

/// Keys k<first> to k<last - 1>, each on a spring of its own.
std::string keys_scene(int first, int last) {
  std::string ports;
  std::string links;
  for (int key = first; key < last; ++key) {
    const std::string name = "k" + std::to_string(key);
    ports += "  " + name + ": {device: " + name +
             ", axes: [0], role: mass, coupling: direct, at_m: [0]}\n";
    links += "  - {liaison: wall, between: [" + name + ", ground]}\n";
  }
  return R"(cordis: 1
name: keys
space: 1
step: {rate_hz: 1000, gesture_rate_hz: 1000, frame_rate_hz: 1, integrator: cordis}
liaisons:
  wall: {kind: spring, stiffness_n_per_m: 200}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 1, at_m: [0.1]}
ports:
)" + ports +
         "links:\n" + links;
}

/// DDS has room for the forces of 64 devices; those of another scene count as well.
TEST(UnwrittenForces, AreCountedAsDropped) {
  LiveSession session("realtime", "  sim: {node: sim_node, scene: scene.yaml}\n");
  session.add_file("scene.yaml", keys_scene(0, 64));
  session.add_file("other.yaml", keys_scene(64, 65));
  session.start("sim_node", "sim");
  StatusWatch status(session.participant());
  dds::Reader<msg::GestureForces> forces(session.participant(), dds::Topic::kForces);
  const auto send = [](dds::Writer<msg::GesturePositions>& positions, int key) {
    msg::GesturePositions sample;
    sample.device_id(config::name_hash("k" + std::to_string(key)));
    sample.epoch(1);
    sample.sample(1);
    sample.axis_count(1);
    EXPECT_TRUE(positions.write(sample)) << key;
  };
  std::set<std::uint32_t> answered;
  {
    dds::Writer<msg::GesturePositions> positions(session.participant(), dds::Topic::kPositions);
    ASSERT_TRUE(eventually([&] {
      for (int key = 0; key < 64; ++key) send(positions, key);
      msg::GestureForces force;
      while (forces.take(force)) answered.insert(force.device_id());
      return answered.size() == 64;
    })) << answered.size();
  }
  ASSERT_TRUE(status.wait_for_phase("sim", msg::PHASE_WAITING));
  ChildProcess ctl({program_path("cordis"), "ctl", session.launch_file(), "load", "other.yaml"});
  ASSERT_EQ(ctl.wait(kPatience), 0) << ctl.output();
  const std::uint64_t before = status.of("sim").dropped();

  // Frames are left out at most once a second: a thousand are forces.
  dds::Writer<msg::GesturePositions> positions(session.participant(), dds::Topic::kPositions);
  EXPECT_TRUE(status.wait_for("sim", [&](const msg::NodeStatus& said) {
    send(positions, 64);
    return said.dropped() > before + 1000;
  })) << status.of("sim").dropped();
}

}  // namespace
}  // namespace cordis::test
