// tests/engine/two_bodies_test.cpp -- two free masses joined by a spring-damper against their exact
// motion.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

World two_bodies(const nlohmann::json& params, const Vec3& direction, int dimension, double step) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = step;
  scene.mats = {mass(number(params["m1"]), number(params["x1"]) * direction,
                     number(params["v1"]) * direction),
                mass(number(params["m2"]), number(params["x2"]) * direction,
                     number(params["v2"]) * direction)};
  scene.links = {{0, 1, number(params["k"]), number(params["z"]), number(params["L0"])}};
  return make_world(scene);
}

double largest_error(const nlohmann::json& problem, const Vec3& direction, int dimension,
                     double step) {
  World world = two_bodies(problem["params"], direction, dimension, step);
  double largest = 0.0;
  for (const auto& row : problem["t_x1_x2_v1_v2"]) {
    const int n = static_cast<int>(std::lround(number(row[0]) / step));
    run(world, n - static_cast<int>(world.step_count()));
    for (std::uint32_t i : {0U, 1U}) {
      const double error = (world.position(i) - number(row[1 + i]) * direction).norm();
      largest = std::max(largest, error);
    }
  }
  return largest;
}

TEST(TwoBodies, ConvergeToTheirExactMotion) {
  const nlohmann::json problem = reference("R06_two_bodies");
  const Vec3 direction(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0);

  for (const auto& [dimension, axis] :
       {std::pair{1, Vec3(1, 0, 0)}, {2, Vec3(0.6, 0.8, 0)}, {3, direction}}) {
    const double coarse = largest_error(problem, axis, dimension, 1e-4);
    const double fine = largest_error(problem, axis, dimension, 5e-5);

    EXPECT_LT(coarse, 1e-5) << dimension << " dimensions";
    EXPECT_NEAR(std::log2(coarse / fine), 1.0, 0.1) << dimension << " dimensions";
  }
}

TEST(TwoBodies, KeepTheirCentreOfMassInUniformMotion) {
  const nlohmann::json params = reference("R06_two_bodies")["params"];
  World world = two_bodies(params, Vec3(1, 0, 0), 1, 1e-3);
  const double m1 = number(params["m1"]);
  const double m2 = number(params["m2"]);
  const double centre = m2 * number(params["x2"]) / (m1 + m2);
  const double speed = (m1 * number(params["v1"]) + m2 * number(params["v2"])) / (m1 + m2);

  for (int n = 1; n <= 3000; ++n) {
    world.step();
    const double now = (m1 * world.position(0).x() + m2 * world.position(1).x()) / (m1 + m2);
    // half an ulp of 2 m a step, in two sums, one after the other: at most n^2 of them
    ASSERT_NEAR(now, centre + speed * n * 1e-3, 1e-15 * n + 1e-17 * n * n) << "step " << n;
  }
}

}  // namespace
}  // namespace cordis::test
