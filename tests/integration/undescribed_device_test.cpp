// tests/integration/undescribed_device_test.cpp -- a device that does not say what it is.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <regex>
#include <string>
#include <thread>
#include <type_traits>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "node/config/name_hash.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/time.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"

namespace cordis::test {
namespace {

constexpr const char* kSimAlone = "  sim: {node: sim_node, scene: scene.yaml}\n";
constexpr const char* kUnknown = "its limits are unknown, and it is given no force";

/// A device of one axis that the test moves by hand. @tparam Sent  positions or forces
template <class Sent>
class HandmadeDevice {
 public:
  static constexpr bool kIsMass = std::is_same_v<Sent, msg::GesturePositions>;
  using Received = std::conditional_t<kIsMass, msg::GestureForces, msg::GesturePositions>;

  explicit HandmadeDevice(dds::Participant& participant, std::uint64_t epoch = 7)
      : samples_(participant, kIsMass ? dds::Topic::kPositions : dds::Topic::kForces),
        answers_(participant, kIsMass ? dds::Topic::kForces : dds::Topic::kPositions),
        descriptions_(participant, dds::Topic::kDevice) {
    sample_.device_id(config::name_hash("keyboard"));
    sample_.epoch(epoch);
    sample_.axis_count(1);
  }

  void describe(double rate_hz = 1000.0) {
    msg::DeviceDescription description;
    description.device_id(sample_.device_id());
    description.device("keyboard");
    description.driver("handmade");
    description.epoch(sample_.epoch());
    description.coordinate_count(1);
    description.rate_hz(rate_hz);
    description.moving_mass_kg(0.05);
    description.travel_m()[0] = 0.08;
    description.lowest_m(-0.04);
    description.highest_m(0.04);
    description.force_n()[0] = 20.0;
    EXPECT_TRUE(descriptions_.write(description));
  }

  /// The device plays on as another process.
  void restart(std::uint64_t epoch) {
    sample_.epoch(epoch);
    sample_.sample(0);
    describe();
  }

  /// What the next samples say of the newest answer.
  void report_delay(double delay_s) {
    sample_.answered_epoch(answer_.epoch());
    sample_.answered_sample(answer_.sample());
    sample_.answered_time_nsec(answer_.time_nsec());
    sample_.answer_delay_s(delay_s);
  }

  /// Sends the next sample with a value of its axis.
  void send(double value) {
    sample_.sample(sample_.sample() + 1);
    sample_.time_nsec(node::monotonic_nsec());
    value_of(sample_) = value;
    EXPECT_TRUE(samples_.write(sample_));
  }

  /// Repeats the sample every 100 ms until it is answered, as a device in lockstep has to.
  bool await_answer() {
    std::int64_t sent = node::monotonic_nsec();
    return eventually([&] {
      if (is_answered()) return true;
      if (node::monotonic_nsec() - sent > 100'000'000) {
        sent = node::monotonic_nsec();
        EXPECT_TRUE(samples_.write(sample_));
      }
      return false;
    });
  }

  /// Takes what has come. @return whether the newest sample is answered
  bool is_answered() {
    while (answers_.take(answer_)) {
    }
    return answer_.answered_epoch() == sample_.epoch() &&
           answer_.answered_sample() == sample_.sample();
  }

  /// Value of the newest answer [N] or [m].
  double answer() { return value_of(answer_); }

 private:
  template <class Message>
  static double& value_of(Message& message) {
    if constexpr (std::is_same_v<Message, msg::GesturePositions>) {
      return message.position_m()[0];
    } else {
      return message.force_n()[0];
    }
  }

  dds::Writer<Sent> samples_;
  dds::Reader<Received> answers_;
  dds::Writer<msg::DeviceDescription> descriptions_;
  Sent sample_;
  Received answer_;
};

std::size_t count_of(const std::string& part, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t position = text.find(part); position != std::string::npos;
       position = text.find(part, position + 1))
    ++count;
  return count;
}

/// Samples in realtime without a description, and later with one.
/// @param value      of each sample
/// @param answer     that the device gets once it has described itself
template <class Sent>
void expect_nothing_before_the_description(const std::string& scene, double value, double answer) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", scene);
  ChildProcess& sim = session.start("sim_node", "sim");
  StatusWatch status(session.participant());
  HandmadeDevice<Sent> device(session.participant());
  double largest = 0.0;
  ASSERT_TRUE(status.wait_for("sim", [&](const msg::NodeStatus& said) {
    device.send(value);
    device.is_answered();
    largest = std::max(largest, std::abs(device.answer()));
    return said.text().find(kUnknown) != std::string::npos;
  })) << status.of("sim").text();
  EXPECT_EQ(largest, 0.0);
  EXPECT_NE(status.of("sim").text().find("device 'keyboard' sends samples and no"),
            std::string::npos);
  EXPECT_EQ(status.of("sim").silent_ticks(), 0u) << "a device that is refused is not missed";
  EXPECT_TRUE(sim.wait_for_output(kUnknown, kPatience));

  device.describe();
  EXPECT_TRUE(eventually([&] {
    device.send(value);
    device.is_answered();
    return std::abs(device.answer() - answer) < 1e-6;
  })) << device.answer();
  EXPECT_TRUE(status.wait_for("sim", [&](const msg::NodeStatus& said) {
    device.send(value);
    return said.text().empty();
  })) << status.of("sim").text();
  EXPECT_EQ(count_of(kUnknown, sim.output()), 1u);
}

TEST(UndescribedDevice, OfRoleMassIsGivenNoForceInRealtime) {
  expect_nothing_before_the_description<msg::GesturePositions>(wall_scene(200.0), -0.01, 2.0);
}

TEST(UndescribedDevice, OfRoleLiaisonMovesNothingInRealtime) {
  expect_nothing_before_the_description<msg::GestureForces>(pushed_mass_scene(), -1.0, -0.01);
}

TEST(UndescribedDevice, DoesNotSilenceADescribedOneOfItsName) {
  LiveSession session("realtime", kSimAndKey);
  session.add_file("scene.yaml", wall_scene(200.0));
  session.add_file("key.yaml", steady_key(-0.01, 0.0));
  session.start("sim_node", "sim");
  session.start("device_node", "keyboard");
  dds::Reader<msg::GestureForces> forces(session.participant(), dds::Topic::kForces);
  StatusWatch status(session.participant());
  msg::GestureForces force;
  ASSERT_TRUE(
      eventually([&] { return forces.take(force) && std::abs(force.force_n()[0] - 2.0) < 1e-9; }));

  HandmadeDevice<msg::GesturePositions> stranger(session.participant());
  const std::uint64_t epoch = force.answered_epoch();
  int answered = 0;
  EXPECT_TRUE(eventually([&] {
    stranger.send(0.02);
    while (forces.take(force)) {
      EXPECT_EQ(force.answered_epoch(), epoch);
      // Less while the device takes over again, when this machine has stalled it for a moment.
      EXPECT_LE(force.force_n()[0], 2.0 + 1e-9);
      answered += std::abs(force.force_n()[0] - 2.0) < 1e-9;
    }
    return answered > 1000;
  })) << answered;
}

TEST(UndescribedDevice, DoesNotTakeThePlaceOfADescribedOneThatIsAwayForAMoment) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", wall_scene(200.0));
  session.start("sim_node", "sim");
  HandmadeDevice<msg::GesturePositions> described(session.participant(), 7);
  HandmadeDevice<msg::GesturePositions> stranger(session.participant(), 8);
  described.describe();
  dds::Reader<msg::GestureForces> forces(session.participant(), dds::Topic::kForces);
  msg::GestureForces force;
  ASSERT_TRUE(eventually([&] {
    described.send(-0.01);
    while (forces.take(force)) {
    }
    return std::abs(force.force_n()[0] - 2.0) < 1e-6;
  }));
  std::int64_t sent = node::monotonic_nsec();
  std::int64_t longest = 0;
  int pauses = 0;
  int of_stranger = 0;
  EXPECT_TRUE(eventually([&] {
    stranger.send(0.02);
    const std::int64_t away = node::monotonic_nsec() - sent;
    if (away > 100'000'000) {  // five times what makes a device lost
      longest = std::max(longest, away);
      sent = node::monotonic_nsec();
      described.send(-0.01);
      ++pauses;
    }
    while (forces.take(force)) of_stranger += force.answered_epoch() == 8;
    return pauses == 20;
  }));
  if (longest > 900'000'000) GTEST_SKIP() << "this machine stalled for " << longest << " ns";
  EXPECT_EQ(of_stranger, 0);
}

/// Sends a value until it is answered with a force that is not zero.
bool is_given_force(HandmadeDevice<msg::GesturePositions>& device, double value) {
  return eventually([&] {
    device.send(value);
    return device.is_answered() && std::abs(device.answer()) > 0.0;
  });
}

TEST(DescribedDevice, OnStandbyIsKnownHoweverOftenOthersRestart) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", wall_scene(200.0));
  ChildProcess& sim = session.start("sim_node", "sim");
  const dds::ParticipantConfig& config = session.participant().config();
  dds::Participant standby_process({config.domain, config.session, "standby"});
  HandmadeDevice<msg::GesturePositions> standby(standby_process, 7);
  standby.describe();
  ASSERT_TRUE(is_given_force(standby, -0.01));

  constexpr std::uint64_t kMoreThanAreKnown = 80;
  HandmadeDevice<msg::GesturePositions> other(session.participant(), 8);
  for (std::uint64_t epoch = 100; epoch < 100 + kMoreThanAreKnown; ++epoch) {
    other.restart(epoch);
    ASSERT_TRUE(is_given_force(other, -0.01)) << epoch;
  }

  EXPECT_TRUE(is_given_force(standby, -0.01));
  EXPECT_EQ(count_of(kUnknown, sim.output()), 0u);
}

/// When a device in lockstep describes itself.
enum class Described { kFirst, kAfterASecond, kAfterItsFirstAnswer, kNever };

struct Outcome {
  std::string hash;
  double answer = 0.0;  // to the last sample
  std::string output;   // of sim_node
};

template <class Sent>
Outcome play_in_lockstep(const std::string& scene, double value, Described described) {
  LiveSession session("lockstep", kSimAlone);
  session.add_file("scene.yaml", scene);
  ChildProcess& sim = session.start("sim_node", "sim");
  HandmadeDevice<Sent> device(session.participant());
  if (described == Described::kFirst) device.describe();
  device.send(value);
  if (described == Described::kAfterASecond) {
    const std::int64_t begin = node::monotonic_nsec();
    EXPECT_TRUE(eventually([&] {
      EXPECT_FALSE(device.is_answered()) << "the scene waits for the description";
      return node::monotonic_nsec() - begin > 1'000'000'000;
    }));
    device.describe();
  }
  EXPECT_TRUE(device.await_answer());
  if (described == Described::kAfterItsFirstAnswer) device.describe();
  for (int i = 1; i < 1000; ++i) {
    device.send(value);
    EXPECT_TRUE(device.await_answer());
  }
  const bool is_refused =
      described == Described::kAfterItsFirstAnswer || described == Described::kNever;
  EXPECT_TRUE(!is_refused || sim.wait_for_output(kUnknown, kPatience));
  sim.signal(SIGTERM);
  EXPECT_EQ(sim.wait(kPatience), 0);
  Outcome outcome{{}, device.answer(), sim.output()};
  std::smatch match;
  if (std::regex_search(outcome.output, match,
                        std::regex("state hash [0-9a-f]{16} after 4000 steps")))
    outcome.hash = match.str();
  EXPECT_NE(outcome.hash, "");
  return outcome;
}

/// @param answer  to the last sample of a device that has described itself
template <class Sent>
void expect_the_same_in_every_run(const std::string& scene, double value, double answer) {
  const Outcome described = play_in_lockstep<Sent>(scene, value, Described::kFirst);
  EXPECT_NEAR(described.answer, answer, 1e-4);
  EXPECT_EQ(play_in_lockstep<Sent>(scene, value, Described::kAfterASecond).hash, described.hash);

  const Outcome never = play_in_lockstep<Sent>(scene, value, Described::kNever);
  EXPECT_EQ(never.answer, 0.0);
  EXPECT_NE(never.hash, described.hash);
  EXPECT_EQ(count_of(kUnknown, never.output), 1u);
  EXPECT_NE(never.output.find("device 'keyboard' sent samples before a"), std::string::npos);
  const Outcome late = play_in_lockstep<Sent>(scene, value, Described::kAfterItsFirstAnswer);
  EXPECT_EQ(late.answer, 0.0);
  EXPECT_EQ(late.hash, never.hash) << "a description after the first answer changes nothing";
}

TEST(UndescribedDevice, OfRoleMassIsAnsweredInLockstepAndGivenNoForce) {
  expect_the_same_in_every_run<msg::GesturePositions>(wall_scene(200.0), -0.01, 2.0);
}

TEST(UndescribedDevice, OfRoleLiaisonIsAnsweredInLockstepAndMovesNothing) {
  expect_the_same_in_every_run<msg::GestureForces>(pushed_mass_scene(), -1.0, -0.01);
}

TEST(DescribedDevice, ThatReportsAnswersBeforeTheyWentOutIsNotBelieved) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", wall_scene(100.0));
  StatusWatch status(session.participant());
  HandmadeDevice<msg::GesturePositions> device(session.participant());
  device.describe(10.0);  // 20 answers are enough
  session.start("sim_node", "sim");
  ASSERT_TRUE(status.wait_for_phase("sim", msg::PHASE_WAITING));

  dds::Reader<msg::NodeStatus> reports(session.participant(), dds::Topic::kStatus);
  msg::NodeStatus report;
  std::smatch match;
  const std::regex within("is answered within ([0-9]+) us");
  const auto is_measured = [&] {
    while (reports.take(report)) {
    }
    return std::regex_search(report.text(), match, within);
  };
  for (int n = 0; n < 1000 && !is_measured(); ++n) {
    device.send(0.0);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    device.is_answered();
    device.report_delay(1e-6);
  }
  ASSERT_EQ(match.size(), 2u) << report.text();

  EXPECT_GT(std::stod(match[1]), 1000.0)
      << "the newest answer went out some 20 ms after its sample";
}

}  // namespace
}  // namespace cordis::test
