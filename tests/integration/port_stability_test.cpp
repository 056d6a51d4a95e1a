// tests/integration/port_stability_test.cpp -- where the force loop begins to swing, through real
// processes in lockstep, with the wire 0 to 3 periods late.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/support/haptic_boundaries.h"

namespace cordis::test {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr double kMass = 0.05;    // [kg]
constexpr double kBeta = 0.1;     // b T / m
constexpr double kZ = 0.1;        // B T / m
constexpr double kSide = 0.02;    // so near to the boundary on either side
constexpr int kTicks = 4000;

/// K T^2 / m on the boundary for kBeta and kZ, from the reference table.
double table_kappa(int delay) {
  for (const HapticBoundary& row : haptic_boundaries()) {
    if (row.beta == kBeta && row.z == kZ && row.delay == delay) return row.stable;
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
std::string bare_key(int delay, const std::string& hand) {
  return "cordis: 1\naxes: 1\ntravel_m: 1\nrest: middle\nrate_hz: 1000\ndriver: mock\n"
         "force_limit_n: 1.0e+5\nslew_limit_n_per_s: 1.0e+9\nspeed_limit_m_per_s: 1.0e+6\n"
         "power_limit_w: 1.0e+12\nstart_ramp_s: 0\ndelay_periods: " +
         std::to_string(delay) + "\nmock:\n  key: {mass_kg: " + number(kMass) +
         ", viscosity_n_s_per_m: " + number(kBeta * kMass / kPeriod) +
         ", friction_n: 0, stop_n_per_m: 4.0e+6, stop_viscosity_n_s_per_m: 20, "
         "motor_limit_n: 1.0e+6}\n" +
         hand;
}

/// Largest distance of the key from where it comes to rest, in the last quarter of the run over
/// the quarter before.
template <class Message, class Values>
double growth_of(const std::string& scene, const std::string& key, dds::Topic topic, double rest,
                 const Values& values) {
  LiveSession session("lockstep", "  sim: {node: sim_node, scene: scene.yaml, duration_s: " +
                                      number(kTicks * kPeriod) +
                                      "}\n  keyboard: {node: device_node, device: key.yaml}\n");
  session.add_file("scene.yaml", scene);
  session.add_file("key.yaml", key);
  dds::Reader<Message> reader(session.participant(), topic);
  session.start("device_node", "keyboard");
  ChildProcess& sim = session.start("sim_node", "sim");
  double before = 0.0;
  double after = 0.0;
  std::uint64_t heard = 0;
  Message message;
  EXPECT_TRUE(eventually([&] {
    while (reader.take(message)) {
      if (message.sample() < kTicks / 2 || message.sample() <= heard) continue;
      heard = message.sample();
      double& largest = message.sample() < kTicks * 3 / 4 ? before : after;
      largest = std::max(largest, std::abs(values(message)[0] - rest));
    }
    return sim.wait(std::chrono::milliseconds(0)) == 0;
  }));
  EXPECT_GT(heard, static_cast<std::uint64_t>(kTicks) * 9 / 10);
  return after / before;
}

class PortStability : public ::testing::TestWithParam<int> {};

/// Without delay this role is the scheme by itself, whose limit tests/engine holds.
class DelayedPortStability : public ::testing::TestWithParam<int> {};

/// A wall that pushes the key to 0.1 mm below its rest.
double growth_in_role_mass(double kappa, int delay) {
  const std::string scene =
      "cordis: 1\nname: wall\nspace: 1\nstep: {rate_hz: 1000, gesture_rate_hz: 1000}\n"
      "liaisons:\n  wall: {kind: spring_damper, stiffness_n_per_m: " +
      number(kappa * kMass / (kPeriod * kPeriod)) +
      ", viscosity_n_s_per_m: " + number(kZ * kMass / kPeriod) +
      ", rest_m: 0.0001}\nmatter:\n  ground: {kind: fixed, at_m: [0]}\n"
      "  bob: {kind: mass, mass_kg: 1, at_m: [0.1]}\n"
      "ports:\n  key: {device: keyboard, axes: [0], role: mass, at_m: [0], coupling: direct}\n"
      "links:\n  - {liaison: wall, between: [key, ground]}\n";
  return growth_of<msg::GesturePositions>(
      scene, bare_key(delay, ""), dds::Topic::kPositions, -0.0001,
      [](const msg::GesturePositions& message) { return message.position_m(); });
}

TEST_P(PortStability, RoleMassSwingsJustWhereTheTableSays) {
  const double kappa = table_kappa(GetParam());

  EXPECT_LT(growth_in_role_mass(kappa * (1.0 - kSide), GetParam()), 1.0);
  EXPECT_GT(growth_in_role_mass(kappa * (1.0 + kSide), GetParam()), 1.0);
}

/// A hand of 100 kg, 0.1 mm from the mass, holds it with a spring.
double growth_in_role_liaison(double kappa, int delay) {
  const std::string scene =
      "cordis: 1\nname: held\nspace: 1\nstep: {rate_hz: 1000, gesture_rate_hz: 1000}\n"
      "liaisons:\n  air: {kind: damper, viscosity_n_s_per_m: " +
      number(kZ * kMass / kPeriod) +
      "}\nmatter:\n  ground: {kind: fixed, at_m: [0]}\n"
      "ports:\n  key: {device: keyboard, axes: [0], role: liaison, mass_kg: " +
      number(kMass) +
      ", at_m: [0]}\n"
      "links:\n  - {liaison: air, between: [key, ground]}\n";
  const std::string hand =
      "  hand: {mass_kg: 100, stiffness_n_per_m: 0.001, viscosity_n_s_per_m: 0, start_m: 0.0001,\n"
      "         finger: {stiffness_n_per_m: " +
      number(kappa * kMass / (kPeriod * kPeriod)) + ", viscosity_n_s_per_m: 0, holds: true}}\n";
  return growth_of<msg::GestureForces>(
      scene, bare_key(delay, hand), dds::Topic::kForces, 0.0,
      [](const msg::GestureForces& message) { return message.force_n(); });
}

TEST_P(DelayedPortStability, RoleLiaisonSwingsJustWhereItsRecurrenceSays) {
  // k T^2/m on the boundary of x(n+1) = (2-Z') x(n) - (1-Z') x(n-1) - k x(n-d) with Z' = 0.1, the
  // least real positive -z^d (z - 2 + Z' + (1-Z')/z) on the unit circle.
  const double limits[] = {0.100000000, 0.051249220, 0.034784063};
  const double kappa = limits[GetParam() - 1];

  EXPECT_LT(growth_in_role_liaison(kappa * (1.0 - kSide), GetParam()), 1.0);
  EXPECT_GT(growth_in_role_liaison(kappa * (1.0 + kSide), GetParam()), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Delays, PortStability, ::testing::Values(0, 1, 2, 3));
INSTANTIATE_TEST_SUITE_P(Delays, DelayedPortStability, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace cordis::test
