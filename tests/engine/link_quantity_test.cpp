// tests/engine/link_quantity_test.cpp -- what a condition knows of its link.
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/led_link.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

class LinkQuantities : public testing::TestWithParam<VectorWidth> {
 protected:
  static World make(const NetworkDescription& scene) { return make_world(scene, GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Widths, LinkQuantities,
                         testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

/// Two states, of which the first is left when `quantity` exceeds `threshold`.
StateMachine watching(Quantity quantity, double threshold) {
  return Behaving().state(10.0, 1.0).exit(q(quantity) > threshold, 1).state(10.0).state_machine;
}

TEST_P(LinkQuantities, ReportHowItStandsAndMoves) {
  // b at (3, 4, 0) from a, moving by (0.3, -0.1, 0.2) in a step of 0.01 s, rest length 2
  const auto value_of = [](Quantity quantity) {
    NetworkDescription scene;
    scene.step = 0.01;
    scene.mats = {fixed(Vec3(1, 1, 1)), port(Vec3(3.7, 5.1, 0.8)), mass(2.5, Vec3(9, 9, 9))};
    scene.state_machines = {watching(quantity, -1e9)};
    scene.state_links = {{0, 1, 0, 2.0}};
    World world = make(scene);
    world.impose_position(1, Vec3(4.0, 5.0, 1.0));
    world.step();
    EXPECT_EQ(world.events().size(), 1U);
    return world.events()[0].value;
  };
  const double speed = (30.0 * 3.0 - 10.0 * 4.0) / 5.0;
  EXPECT_NEAR(value_of(Quantity::kDistance), 5.0, 1e-12);
  EXPECT_NEAR(value_of(Quantity::kElongation), 3.0, 1e-12);
  EXPECT_NEAR(value_of(Quantity::kSpeed), speed, 1e-9);
  EXPECT_NEAR(value_of(Quantity::kSpeedX), 30.0, 1e-9);
  EXPECT_NEAR(value_of(Quantity::kSpeedY), -10.0, 1e-9);
  EXPECT_NEAR(value_of(Quantity::kSpeedZ), 20.0, 1e-9);
  EXPECT_NEAR(value_of(Quantity::kSlip), std::sqrt(1400.0 - speed * speed), 1e-9);
  EXPECT_EQ(value_of(Quantity::kRestLength), 2.0);
  EXPECT_EQ(value_of(Quantity::kForce), 0.0);
  EXPECT_EQ(value_of(Quantity::kImpulse), 0.0);
  EXPECT_EQ(value_of(Quantity::kAge), 0.0);
}

TEST_P(LinkQuantities, ReportTheMassesOfItsEnds) {
  const auto masses = [](Quantity quantity) {
    NetworkDescription scene;
    scene.step = 0.01;
    scene.mats = {fixed(Vec3::Zero()), port(Vec3(1, 0, 0)), mass(2.5, Vec3(2, 0, 0)),
                  mass(0.5, Vec3(3, 0, 0))};
    scene.state_machines = {watching(quantity, -1.0)};
    scene.state_links = {{0, 2, 0, 0.0}, {3, 1, 0, 0.0}};
    World world = make(scene);
    world.step();
    EXPECT_EQ(world.events().size(), 2U);
    return std::vector<double>{world.events()[0].value, world.events()[1].value};
  };
  EXPECT_EQ(masses(Quantity::kMassA), (std::vector<double>{0.0, 0.5}));
  EXPECT_EQ(masses(Quantity::kMassB), (std::vector<double>{2.5, 0.0}));
}

TEST_P(LinkQuantities, ReportItsLastTensionImpulseAndAge) {
  const auto step_of_change = [](Quantity quantity, double threshold, double* value) {
    World world = make(led_link(watching(quantity, threshold), 0.0, 0.0));
    for (int n = 0; n < 100; ++n) {
      lead(world, 0.1 * (n + 1));  // tension in step n: 10 * 0.1 (n + 1) + 1 * 0.1 / 0.01 = n + 11
      if (world.events().empty()) continue;
      *value = world.events()[0].value;
      return n;
    }
    return -1;
  };
  double value = 0.0;
  EXPECT_EQ(step_of_change(Quantity::kForce, 20.5, &value), 11);
  EXPECT_NEAR(value, 21.0, 1e-9);
  // impulse at step n: 0.01 * sum of the tensions of steps 0 .. n-1 = 0.01 (n (n - 1) / 2 + 11 n)
  EXPECT_EQ(step_of_change(Quantity::kImpulse, 1.0, &value), 8);
  EXPECT_NEAR(value, 0.01 * (28 + 88), 1e-9);
  EXPECT_EQ(step_of_change(Quantity::kAge, 0.0749, &value), 8);
  EXPECT_NEAR(value, 0.08, 1e-12);
}

TEST_P(LinkQuantities, CountImpulseAndAgeFromTheEntry) {
  World world = make(led_link(Behaving()
                                  .state(0.0)
                                  .exit(q(Quantity::kAge) >= 0.025, 1)
                                  .state(10.0)
                                  .exit(q(Quantity::kImpulse) > 0.55, 2)
                                  .state(0.0)
                                  .exit(q(Quantity::kAge) >= 0.015, 0)
                                  .state_machine,
                              1.0, 0.0));
  std::vector<std::uint32_t> states;
  for (int n = 0; n < 23; ++n) {
    world.step();
    states.push_back(world.state_of(0));
  }
  // state 1 is entered in step 3, pulls with 10 N from that step on, and has taken 0.6 N s after
  // steps 3 to 8; and again from step 14 on
  EXPECT_EQ(states, (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 0,
                                                0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 0}));
}

}  // namespace
}  // namespace cordis::test
