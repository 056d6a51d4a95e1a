// tests/engine/plucked_string_test.cpp -- a plucked string with both kinds of viscosity against its
// modal sum.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

NetworkDescription plucked_string(const nlohmann::json& params, double step) {
  const int count = params["N"].get<int>();
  const int apex = params["apex"].get<int>();
  const double height = number(params["amp"]);
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.medium_viscosity = number(params["z_ground"]);
  for (int i = 0; i <= count + 1; ++i) {
    const double rise =
        i <= apex ? height * i / apex : height * (count + 1 - i) / (count + 1 - apex);
    const Vec3 position(i == 0 || i == count + 1 ? 0.0 : rise, 0, 0);
    scene.mats.push_back(i == 0 || i == count + 1 ? fixed(position)
                                                  : mass(number(params["m"]), position));
  }
  for (int i = 0; i <= count; ++i) {
    scene.links.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1),
                           number(params["k"]), number(params["z_link"]), 0.0});
  }
  return scene;
}

double largest_error(const nlohmann::json& problem, double step) {
  double largest = 0.0;
  for (const auto& [mat, rows] : problem["t_x_v_at_mass"].items()) {
    World world = make_world(plucked_string(problem["params"], step));
    for (const auto& row : rows) {
      const int n = static_cast<int>(std::lround(number(row[0]) / step));
      run(world, n - static_cast<int>(world.step_count()));
      const double x = world.position(static_cast<std::uint32_t>(std::stoi(mat))).x();
      largest = std::max(largest, std::abs(x - number(row[1])));
    }
  }
  return largest;
}

TEST(PluckedString, ConvergesToItsModalSum) {
  const nlohmann::json problem = reference("R05_plucked_string");

  const double coarse = largest_error(problem, 2e-6);
  const double fine = largest_error(problem, 1e-6);

  EXPECT_LT(coarse, 1e-5) << "a thousandth of the height it is plucked to";
  EXPECT_NEAR(std::log2(coarse / fine), 1.0, 0.1) << "the viscosity makes the scheme first order";
}

}  // namespace
}  // namespace cordis::test
