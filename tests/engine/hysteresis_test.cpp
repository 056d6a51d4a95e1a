// tests/engine/hysteresis_test.cpp -- plasticity, rupture, ratchet and stick-slip, made of states.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/block_on_a_belt.h"
#include "tests/engine/many_states.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

const nlohmann::json& hysteresis() {
  static const nlohmann::json data = reference("R17_hysteresis");
  return data;
}

/// Elastic up to the yield elongation in both directions, then flowing.
StateMachine plastic(double stiffness, double yield) {
  const Term e = q(Quantity::kElongation);
  const Term rest = q(Quantity::kRestLength);
  return Behaving()
      .state(stiffness)
      .exit_to_rest(e > yield, 0, rest + (e - yield))
      .exit_to_rest(e < -yield, 0, rest + (e + yield))
      .state_machine;
}

/// A port at 0 joined to a fixed point by links of these state machines; 1 dimension.
NetworkDescription led(std::vector<StateMachine> state_machines, double step) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.mats = {fixed(Vec3::Zero()), port(Vec3::Zero())};
  for (std::uint32_t b = 0; b < state_machines.size(); ++b)
    scene.state_links.push_back({0, 1, b, 0.0});
  scene.state_machines = std::move(state_machines);
  return scene;
}

constexpr int kStepsPerCycle = 100'000;

/// Leads the port by A sin t from one phase to another, in cycles.
void lead(World& world, double amplitude, int first, int last) {
  for (int n = first + 1; n <= last; ++n) {
    world.impose_position(
        1, Vec3(amplitude * std::sin(2.0 * std::numbers::pi * n / kStepsPerCycle), 0, 0));
    world.step();
  }
}

TEST(Plastic, LosesTheAreaOfItsLoop) {
  const double stiffness = number(hysteresis()["params"]["K"]);
  const double yield = number(hysteresis()["params"]["uy"]);
  const double amplitude = number(hysteresis()["params"]["A"]);
  World world =
      make_world(led({plastic(stiffness, yield)}, 2.0 * std::numbers::pi / kStepsPerCycle));
  lead(world, amplitude, 0, kStepsPerCycle / 4);
  EXPECT_NEAR(world.rest_length_of(0), number(hysteresis()["residual_a"]), 1e-15);
  const engine::Energy before = world.energy();
  lead(world, amplitude, kStepsPerCycle / 4, kStepsPerCycle * 5 / 4);
  const engine::Energy after = world.energy();

  const double expected = number(hysteresis()["W_a"]);
  EXPECT_NEAR(after.port_work - before.port_work, expected, 1e-6 * expected);
  EXPECT_NEAR(before.switching - after.switching, expected, 1e-6 * expected);
  EXPECT_EQ(after.dissipated, 0.0) << "it is the flow that takes it, a change of state each";
  EXPECT_LT(std::abs(after.residual()), 1e-12 * after.largest);
  EXPECT_LT(std::abs(after.elastic_error), 1e-12 * after.largest);
}

TEST(Plastic, HardensWithASpringInParallel) {
  const double stiffness = number(hysteresis()["params"]["K"]);
  const double second = number(hysteresis()["params"]["a"]);
  const double amplitude = number(hysteresis()["params"]["A"]);
  World world =
      make_world(led({plastic((1.0 - second) * stiffness, number(hysteresis()["params"]["uy"])),
                      Behaving().state(second * stiffness).state_machine},
                     2.0 * std::numbers::pi / kStepsPerCycle));
  lead(world, amplitude, 0, kStepsPerCycle / 4);
  const double before = world.energy().port_work;
  lead(world, amplitude, kStepsPerCycle / 4, kStepsPerCycle * 5 / 4);

  const double expected = number(hysteresis()["W_b"]);
  EXPECT_NEAR(world.energy().port_work - before, expected, 1e-6 * expected);
}

TEST(Rupture, ComesAtItsElongation) {
  const nlohmann::json data = hysteresis()["rupture"];
  const double step = 1e-6;
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.mats = {mass(number(data["m"]), Vec3::Zero()), port(Vec3::Zero())};
  scene.state_machines = {Behaving()
                              .state(number(data["k"]))
                              .exit(q(Quantity::kElongation) > number(data["ub"]), 1)
                              .state(0.0)
                              .state_machine};
  scene.state_links = {{0, 1, 0, 0.0}};
  World world = make_world(scene);
  while (world.state_of(0) == 0 && world.step_count() < 100'000) {
    const double t = static_cast<double>(world.step_count() + 1) * step;
    world.impose_position(1, Vec3(number(data["V"]) * t, 0, 0));
    world.step();
  }

  EXPECT_NEAR(static_cast<double>(world.step_count()) * step, number(data["t_break"]), 2.0 * step);
  EXPECT_NEAR(world.position(0).x(), number(data["x_break"]), 2.0 * step);
  EXPECT_NEAR(world.velocity(0).x(), number(data["v_break"]), 2e-5);
  ASSERT_EQ(world.events().size(), 1U);
  const double stored = 0.5 * number(data["k"]) * number(data["ub"]) * number(data["ub"]);
  EXPECT_NEAR(world.events()[0].energy, -stored, 1e-4 * stored);
  EXPECT_EQ(world.events()[0].energy, world.energy().switching);
}

TEST(Ratchet, HoldsTheTeethItHasPassed) {
  const nlohmann::json data = hysteresis()["ratchet"];
  const double pitch = number(data["pitch"]);
  const Term next = q(Quantity::kRestLength) + pitch;
  World world = make_world(led({Behaving()
                                    .state(number(data["K"]))
                                    .exit_to_rest(q(Quantity::kElongation) >= pitch, 0, next)
                                    .state_machine},
                               1e-3));
  constexpr int kSteps = 370'000;
  const double reach = number(data["A"]);
  double before_reversal = 0.0;
  for (int n = 1; n <= 2 * kSteps; ++n) {
    const double x = n <= kSteps ? reach * n / kSteps : reach * (2 * kSteps - n) / kSteps;
    world.impose_position(1, Vec3(x, 0, 0));
    world.step();
    if (n == kSteps) before_reversal = world.tension_of(0);
  }

  EXPECT_EQ(world.change_count(0, 0, 0), data["teeth"].get<std::uint64_t>());
  EXPECT_NEAR(before_reversal, number(data["force_before_reversal"]), 1e-9);
  EXPECT_NEAR(world.tension_of(0), number(data["force_at_return"]), 1e-9);
  EXPECT_NEAR(-world.energy().switching, number(data["dissipated"]), 1e-6);
}

void expect_stick_slip(const nlohmann::json& params, const nlohmann::json& expected) {
  const double step = 1e-5;
  World world = make_world(block_on_a_belt(params, step));
  std::vector<double> slip_times;
  std::vector<double> stick_times;
  std::vector<double> belt_work;
  double furthest = 0.0;
  double nearest = 1.0;
  while (slip_times.size() < 4) {
    const double t = static_cast<double>(world.step_count()) * step;
    world.impose_position(2, Vec3(number(params["V"]) * t, 0, 0));
    world.step();
    furthest = std::max(furthest, world.position(1).x());
    if (slip_times.size() >= 2) nearest = std::min(nearest, world.position(1).x());
    if (world.events().empty()) continue;
    if (world.state_of(0) == 1) {
      slip_times.push_back(t);
      belt_work.push_back(world.energy().port_work);
    } else {
      stick_times.push_back(t);
    }
  }

  const double period = number(expected["period"]);
  EXPECT_NEAR(slip_times[3] - slip_times[2], period, 1e-4 * period);
  EXPECT_NEAR(stick_times[2] - slip_times[2], number(expected["t_slip"]), 2e-4 * period);
  EXPECT_NEAR(furthest, number(expected["x_max"]), 1e-3 * furthest);
  EXPECT_NEAR(nearest, number(expected["x_min"]), 1e-3 * furthest);
  const double work = number(expected["dissipated_per_period_equals_belt_work"]);
  EXPECT_NEAR(belt_work[3] - belt_work[2], work, 1e-3 * work);
  const engine::Energy energy = world.energy();
  EXPECT_LT(std::abs(energy.residual()), 1e-9 * energy.largest);
}

TEST(StickSlip, HasThePeriodOfCoulombFriction) {
  const nlohmann::json data = reference("R15_stick_slip_coulomb");
  expect_stick_slip(data["params"], data);
  expect_stick_slip(data["second_case"]["params"], data["second_case"]);
}

}  // namespace
}  // namespace cordis::test
