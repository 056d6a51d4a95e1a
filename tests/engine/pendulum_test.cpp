// tests/engine/pendulum_test.cpp -- a mass on a very stiff spring against the pendulum of a rod.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

/// Twice the time between the first two passages under the point it hangs from [s].
double swing_period(double angle, double rod_stiffness, double step) {
  constexpr double kGravity = 9.81;
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = step;
  scene.gravity = Vec3(0, -kGravity, 0);
  const double stretch = kGravity * std::cos(angle) / rod_stiffness;  // so that it begins at rest
  scene.mats = {fixed(Vec3::Zero()),
                mass(1.0, (1.0 + stretch) * Vec3(std::sin(angle), -std::cos(angle), 0))};
  scene.links = {{0, 1, rod_stiffness, 0.0, 1.0}};
  World world = make_world(scene);

  double passage[2] = {};
  for (int count = 0; count < 2;) {
    const double before = world.position(1).x();
    world.step();
    const double now = world.position(1).x();
    if (before * now > 0.0 || now == 0.0) continue;
    passage[count++] = (static_cast<double>(world.step_count()) - now / (now - before)) * step;
  }
  return 2.0 * (passage[1] - passage[0]);
}

TEST(Pendulum, OfAStiffSpringHasThePeriodOfARodInTheLimit) {
  const nlohmann::json problem = reference("R18_rigid_pendulum_limit");
  ASSERT_EQ(problem["theta0_period"].size(), 5u);
  for (const auto& row : problem["theta0_period"]) {
    const double angle = number(row[0]);
    const double expected = number(row[1]);
    const double soft = swing_period(angle, 1e5, 1e-4);
    const double stiff = swing_period(angle, 2e5, 1e-4);

    EXPECT_GT(std::abs(soft - expected), 1e-5) << angle;  // a spring is longer than a rod
    EXPECT_NEAR(2.0 * stiff - soft, expected, 1e-6 * expected) << angle;
  }
}

}  // namespace
}  // namespace cordis::test
