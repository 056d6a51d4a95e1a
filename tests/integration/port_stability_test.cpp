// tests/integration/port_stability_test.cpp -- where the force loop begins to swing, through real
// processes in lockstep, with the wire 0 to 3 periods late.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <sstream>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/integration/status_watch.h"
#include "tests/support/filled.h"
#include "tests/support/haptic_boundaries.h"

namespace cordis::test {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr double kMass = 0.05;    // [kg]
constexpr double kBeta = 0.1;     // b T / m
constexpr double kZ = 0.1;        // B T / m
constexpr double kSide = 0.02;    // so near to the boundary on either side
constexpr int kTicks = 4000;

/// K T^2 / m on the boundary, from the reference table.
double table_kappa(int delay, double beta = kBeta, double z = kZ) {
  for (const HapticBoundary& row : haptic_boundaries()) {
    if (row.beta == beta && row.z == z && row.delay == delay) return row.stable;
  }
  ADD_FAILURE() << "not in the table";
  return 0.0;
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

/// A key of which nothing but mass and viscosity is felt: stops far away and simulated in 90
/// sub-steps, no friction, a guard that lets everything through.
std::string bare_key(int delay, const std::string& hand, double force_limit = 1e5,
                     double beta = kBeta) {
  return R"(cordis: 1
axes: 1
travel_m: 1
rest: middle
rate_hz: 1000
driver: mock
force_limit_n: )" +
         number(force_limit) +
         R"(
slew_limit_n_per_s: 1.0e+9
speed_limit_m_per_s: 1.0e+6
power_limit_w: 1.0e+12
start_ramp_s: 0
delay_periods: )" +
         std::to_string(delay) + "\nmock:\n  key: {mass_kg: " + number(kMass) +
         ", viscosity_n_s_per_m: " + number(beta * kMass / kPeriod) +
         ", friction_n: 0, stop_n_per_m: 4.0e+6, stop_viscosity_n_s_per_m: 20, "
         "motor_limit_n: 1.0e+6}\n" +
         hand;
}

/// Largest distance of the key (or of the force of the hand) from where it comes to rest, in the
/// last two quarters of a run.
struct Swing {
  double third = 0.0;
  double last = 0.0;
  std::uint64_t passivity_ticks = 0;  // of the node that damps in this role

  /// It grows, or has grown already from almost nothing to more than 1 m or 1 N.
  bool lasts() const { return last > third || last > 1.0; }
};

template <class Message, class Values>
Swing swing_of(const std::string& scene, const std::string& key, dds::Topic topic, double rest,
               const Values& values) {
  LiveSession session("lockstep", "  sim: {node: sim_node, scene: scene.yaml, duration_s: " +
                                      number(kTicks * kPeriod) +
                                      "}\n  keyboard: {node: device_node, device: key.yaml}\n");
  session.add_file("scene.yaml", scene);
  session.add_file("key.yaml", key);
  dds::Reader<Message> reader(session.participant(), topic);
  StatusWatch status(session.participant());
  session.start("device_node", "keyboard");
  ChildProcess& sim = session.start("sim_node", "sim");
  Swing swing;
  std::uint64_t last_sample = 0;
  Message message;
  EXPECT_TRUE(eventually([&] {
    while (reader.take(message)) {
      if (message.sample() <= last_sample) continue;
      last_sample = message.sample();
      if (last_sample < kTicks / 2) continue;
      double& largest = last_sample < kTicks * 3 / 4 ? swing.third : swing.last;
      largest = std::max(largest, std::abs(values(message)[0] - rest));
    }
    return sim.wait(std::chrono::milliseconds(0)) == 0;
  }));
  EXPECT_GT(last_sample, static_cast<std::uint64_t>(kTicks) * 9 / 10);
  const bool is_mass = topic == dds::Topic::kPositions;
  if (is_mass) session.node("keyboard").signal(SIGTERM);
  EXPECT_TRUE(status.wait_for_phase(is_mass ? "keyboard" : "sim", msg::PHASE_STOPPED));
  swing.passivity_ticks = status.of(is_mass ? "keyboard" : "sim").passivity_ticks();
  return swing;
}

class PortStability : public ::testing::TestWithParam<int> {};

std::string wall_scene(double kappa, double z) {
  return R"(cordis: 1
name: wall
space: 1
step: {rate_hz: 1000, gesture_rate_hz: 1000}
liaisons:
  wall: {kind: spring_damper, stiffness_n_per_m: )" +
         number(kappa * kMass / (kPeriod * kPeriod)) +
         ", viscosity_n_s_per_m: " + number(z * kMass / kPeriod) +
         R"(, rest_m: 0.0001}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 1, at_m: [0.1]}
ports:
  key: {device: keyboard, axes: [0], role: mass, at_m: [0], coupling: direct}
links:
  - {liaison: wall, between: [key, ground]}
)";
}

/// A wall that pushes the key to 0.1 mm below its rest.
Swing swing_in_role_mass(double kappa, const std::string& key, double z = kZ) {
  return swing_of<msg::GesturePositions>(
      wall_scene(kappa, z), key, dds::Topic::kPositions, -0.0001,
      [](const msg::GesturePositions& message) { return message.position_m(); });
}

TEST_P(PortStability, RoleMassSwingsJustWhereTheTableSays) {
  const double kappa = table_kappa(GetParam());
  const std::string key = bare_key(GetParam(), "");

  EXPECT_FALSE(swing_in_role_mass(kappa * (1.0 - kSide), key).lasts());
  EXPECT_TRUE(swing_in_role_mass(kappa * (1.0 + kSide), key).lasts());
}

std::string held_scene() {
  return filled(
      R"(cordis: 1
name: held
space: 1
step: {rate_hz: 1000, gesture_rate_hz: 1000}
liaisons:
  air: {kind: damper, viscosity_n_s_per_m: <viscosity_n_s_per_m>}
matter:
  ground: {kind: fixed, at_m: [0]}
ports:
  key: {device: keyboard, axes: [0], role: liaison, mass_kg: <mass>, at_m: [0]}
links:
  - {liaison: air, between: [key, ground]}
)",
      {{"viscosity_n_s_per_m", number(kZ * kMass / kPeriod)}, {"mass", number(kMass)}});
}

/// A hand of 100 kg holds the mass with a spring, and moves by so much once the device has taken
/// over.
std::string holding(double kappa, double way_m) {
  return filled(
      R"(  hand: {mass_kg: 100, stiffness_n_per_m: 1.0e+5, viscosity_n_s_per_m: 6300, start_m: 0,
         moves: [{at_s: 0.3, in_s: 0.05, to_m: <way_m>}],
         finger: {stiffness_n_per_m: <stiffness_n_per_m>, viscosity_n_s_per_m: 0, holds: true}}
)",
      {{"way_m", number(way_m)},
       {"stiffness_n_per_m", number(kappa * kMass / (kPeriod * kPeriod))}});
}

Swing swing_in_role_liaison(const std::string& key) {
  return swing_of<msg::GestureForces>(
      held_scene(), key, dds::Topic::kForces, 0.0,
      [](const msg::GestureForces& message) { return message.force_n(); });
}

TEST_P(PortStability, RoleLiaisonSwingsJustWhereItsRecurrenceSays) {
  // k T^2/m on the boundary of x(n+1) = (2-Z') x(n) - (1-Z') x(n-1) - k x(n-d) with Z' = 0.1, the
  // least real positive -z^d (z - 2 + Z' + (1-Z')/z) on the unit circle.
  const double limits[] = {3.8, 0.100000000, 0.051249220, 0.034784063};
  const double kappa = limits[GetParam()];
  const auto key = [&](double side) {  // from so near that what swings up stays below the budget
    return bare_key(GetParam(), holding(kappa * side, 1e-6));
  };

  const Swing within = swing_in_role_liaison(key(1.0 - kSide));
  EXPECT_FALSE(within.lasts());
  EXPECT_EQ(within.passivity_ticks, 0u);
  EXPECT_TRUE(swing_in_role_liaison(key(1.0 + kSide)).lasts());
}

INSTANTIATE_TEST_SUITE_P(Delays, PortStability, ::testing::Values(0, 1, 2, 3));

constexpr double kTimesTooStiff = 10.0;

TEST(PassivityController, EndsTheSwingOfAWallTenTimesTooStiff) {
  constexpr double kSlight = 0.01;  // of the viscosity of the key: the wall has none
  const double kappa = kTimesTooStiff * table_kappa(1, kSlight, 0.0);
  const std::string declared =
      "stiffness_limit_n_per_m: 1.0e+9\nviscosity_n_s_per_m: " + number(kSlight * kMass / kPeriod) +
      "\npassivity: {active: ";
  const auto swing = [&](const char* active) {
    return swing_in_role_mass(kappa, bare_key(1, "", 20.0, kSlight) + declared + active + "}\n",
                              0.0);
  };

  const Swing free = swing("false");
  const Swing damped = swing("true");

  EXPECT_GT(free.last, 0.001);
  EXPECT_LT(damped.last, 0.02 * free.last);
  EXPECT_GT(damped.passivity_ticks, 0u);
}

TEST(PassivityController, EndsTheSwingOfAHandTenTimesTooStiff) {
  const std::string key = bare_key(1, holding(kTimesTooStiff * 0.1, 0.005), 50.0);

  const Swing damped = swing_in_role_liaison(key);

  EXPECT_GT(damped.passivity_ticks, 0u) << "it swung up until it was seen to";
  EXPECT_LT(damped.last, 0.1) << "[N]";
}

/// Slow enough for a busy machine: the wall needs an answer within some 6 ms of its 10.
constexpr const char* kSlowWall = R"(cordis: 1
name: wall
space: 1
step: {rate_hz: 100, gesture_rate_hz: 100}
liaisons:
  wall: {kind: spring, stiffness_n_per_m: 500, rest_m: 0.0001}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 1, at_m: [0.1]}
ports:
  key: {device: keyboard, axes: [0], role: mass, at_m: [0], coupling: direct}
links:
  - {liaison: wall, between: [key, ground]}
)";
constexpr const char* kSlowKey = R"(cordis: 1
axes: 1
rest: middle
rate_hz: 100
driver: mock
viscosity_n_s_per_m: 5
moving_mass_kg: 0.2
mock:
  key: {mass_kg: 0.2, viscosity_n_s_per_m: 5}
  hand: {gesture: {kind: hold, at_m: -0.01}}
)";

TEST(AnswerDelay, AKeyTooWeakForAnAnswerAPeriodLateIsPlayedOnceItsAnswersAreMeasuredFaster) {
  LiveSession session("realtime",
                      R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
)");
  session.add_file("scene.yaml", kSlowWall);
  session.add_file("key.yaml", kSlowKey);
  dds::Reader<msg::GestureForces> forces(session.participant(), dds::Topic::kForces);
  StatusWatch status(session.participant());
  session.start("sim_node", "sim");
  session.start("device_node", "keyboard");
  const auto says = [&](const std::string& words) {
    return status.wait_for("sim", [&](const msg::NodeStatus& message) {
      return message.text().find(words) != std::string::npos;
    });
  };

  ASSERT_TRUE(says("one period is assumed until 200 answers are measured"));
  msg::GestureForces force;
  double largest_before = 0.0;
  while (forces.take(force))
    largest_before = std::max(largest_before, std::abs(force.force_n()[0]));
  EXPECT_EQ(largest_before, 0.0);

  ASSERT_TRUE(says("the device 'keyboard' is answered within "));
  EXPECT_TRUE(eventually([&] { return forces.take(force) && std::abs(force.force_n()[0]) > 1.0; }));
  EXPECT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_RUNNING));
  EXPECT_EQ(status.of("keyboard").passivity_ticks(), 0u) << "the loop makes no energy";
}

}  // namespace
}  // namespace cordis::test
