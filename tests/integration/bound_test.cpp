// tests/integration/bound_test.cpp -- beyond what is certified, devices are let go.
#include <cmath>
#include <csignal>
#include <string>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"

namespace cordis::test {
namespace {

/// A session with a key; it ends when the launcher is interrupted.
class Bound : public testing::Test {
 protected:
  explicit Bound(const std::string& clock = "lockstep") : session_(clock, kSimAndKey) {}

  void play(const char* scene, const std::string& key = steady_key(-0.01, 0.0)) {
    session_.add_file("scene.yaml", scene);
    session_.add_file("key.yaml", key);
    launcher_ = &session_.start_launcher();
  }

  /// Waits until the devices are let go of, and the status has this reason in its text.
  void expect_let_go(const std::string& reason) {
    ASSERT_TRUE(status_.wait_for("sim", [&](const msg::NodeStatus& now) {
      return now.phase() == msg::PHASE_DISCONNECTED && now.text().find(reason) != std::string::npos;
    })) << status_.of("sim").text();
  }

  void expect_zero_forces(int count) {
    msg::GestureForces force;
    const std::uint64_t step = status_.of("sim").step();
    ASSERT_TRUE(eventually([&] { return forces_.take(force) && force.sample() > step; }));
    for (int n = 0; n < count; ++n) {
      EXPECT_EQ(force.force_n()[0], 0.0) << force.sample();
      EXPECT_TRUE(eventually([&] { return forces_.take(force); }));
    }
  }

  /// @return what the launcher has printed
  std::string end() {
    launcher_->signal(SIGINT);
    EXPECT_EQ(launcher_->wait(kPatience), 0) << launcher_->output();
    return launcher_->output();
  }

  LiveSession session_;
  StatusWatch status_{session_.participant()};

 private:
  dds::Reader<msg::GestureForces> forces_{session_.participant(), dds::Topic::kForces};
  ChildProcess* launcher_ = nullptr;
};

/// 25 masses that are drawn to the middle of a square and push each other off from 20 mm on: the step
/// is certified for 6 at once, and more come. A key is linked to a fixed point.
const char* const kGathering = R"(cordis: 1
name: gathering
space: 2
step: {rate_hz: 1000, integrator: cordis}
liaisons:
  pull: {kind: spring_damper, stiffness_n_per_m: 20, viscosity_n_s_per_m: 0.01}
  push: {kind: state_machine, stiffness_n_per_m: 150, viscosity_n_s_per_m: 0.02, pulls: false}
  wall: {kind: spring, stiffness_n_per_m: 100}
matter:
  middle: {kind: fixed, at_m: [0.1, 0.1]}
  ground: {kind: fixed, at_m: [0.5, 0]}
  crowd: {kind: lattice, structure: square, corner_m: [0, 0], counts: [5, 5], spacing_m: 0.05, mass_kg: 0.001}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: [0.5, 0.1], along: y}
links:
  - {liaison: pull, between: [middle, crowd], rest_m: 0}
  - {liaison: push, within: crowd, rest_m: 0.02, range_m: 0.02}
  - {liaison: wall, between: [key, ground]}
)";

TEST_F(Bound, ACrowdBeyondItsCertifiedPartnersLetsGoOfTheDevicesAndSaysWhy) {
  play(kGathering);

  const std::string reason = "has let go of the devices: a mass of push of sets";
  ASSERT_NO_FATAL_FAILURE(expect_let_go(reason));
  EXPECT_GT(status_.of("sim").largest_partners(), status_.of("sim").certified_partners());
  expect_zero_forces(20);
  const std::string output = end();
  EXPECT_NE(output.find("sim: " + reason), std::string::npos) << output;
}

/// A ball flies between two walls, each so stiff that a touch may gain energy: not certain. A key is
/// linked to a fixed point.
const char* const kBouncing = R"(cordis: 1
name: bouncing
space: 1
step: {rate_hz: 1000, integrator: cordis}
liaisons:
  hit: {kind: state_machine, stiffness_n_per_m: 19100, pulls: false}
  wall: {kind: spring, stiffness_n_per_m: 100}
matter:
  low: {kind: fixed, at_m: -0.1}
  high: {kind: fixed, at_m: 0.113}
  ground: {kind: fixed, at_m: 0.5}
  ball: {kind: mass, mass_kg: 0.01, at_m: 0, velocity_m_per_s: 1.234}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 0.6}
links:
  - {liaison: hit, between: [low, ball], rest_m: 0.03}
  - {liaison: hit, between: [ball, high], rest_m: 0.03}
  - {liaison: wall, between: [ground, key], rest_m: 0.1}
)";

TEST_F(Bound, StepsThatMakeEnergyLetGoOfTheDevicesAndSayWhy) {
  play(kBouncing);

  const std::string reason =
      "has let go of the devices: the steps have made more than a tenth of the largest energy";
  ASSERT_NO_FATAL_FAILURE(expect_let_go(reason));
  EXPECT_EQ(status_.of("sim").text(), reason);
  expect_zero_forces(1);
  end();
}

class BoundInRealTime : public Bound {
 protected:
  BoundInRealTime() : Bound("realtime") {}
};

TEST_F(BoundInRealTime, StepsThatMakeEnergyLetGoOfTheDevicesAndSayWhy) {
  play(kBouncing);

  const std::string reason =
      "has let go of the devices: the steps have made more than a tenth of the largest energy";
  ASSERT_NO_FATAL_FAILURE(expect_let_go(reason));
  expect_zero_forces(20);
  const std::string output = end();
  EXPECT_NE(output.find("sim: " + reason), std::string::npos) << output;
}

/// A ball between a wall and a paddle, which stiffen as they are pressed in: certified for the energy
/// of the start, and for a hand of 1 m/s.
const char* const kPaddle = R"(cordis: 1
name: paddle
space: 1
step: {rate_hz: 1000, integrator: cordis}
liaisons:
  hit: {kind: state_machine, elasticity: {kind: power, coefficient: 3.0e+5, exponent: 2.5}, pulls: false}
matter:
  wall: {kind: fixed, at_m: -0.02}
  ball: {kind: mass, mass_kg: 0.01, at_m: 0, velocity_m_per_s: 0.1}
ports:
  paddle: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 0.05}
links:
  - {liaison: hit, between: [wall, ball], rest_m: 0.01}
  - {liaison: hit, between: [ball, paddle], rest_m: 0.01}
)";

/// Down and up by 40 mm in 40 ms: 2 m/s.
std::string fast_key() {
  return std::string(kScriptedKey) +
         R"(    - {at_s: 0, m: 0}
    - {at_s: 0.02, m: -0.04}
    - {at_s: 0.04, m: 0}
  repeat_s: 0.04
)";
}

TEST_F(Bound, ACertifiedSceneBeyondItsReachSaysSoAndLetsGoOnceItMakesEnergy) {
  play(kPaddle, fast_key());

  const std::string reason = "has let go of the devices: the steps have made more than a tenth";
  ASSERT_NO_FATAL_FAILURE(expect_let_go(reason));
  expect_zero_forces(1);
  const std::string output = end();
  EXPECT_NE(output.find("than its step is certified for"), std::string::npos) << output;
  EXPECT_NE(output.find(reason), std::string::npos) << output;
}

}  // namespace
}  // namespace cordis::test
