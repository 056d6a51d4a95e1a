// tests/engine/oscillator_test.cpp -- one mass, spring and damper against the exact motion.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

struct Regime {
  std::string name;
  double order;
  double bound;  // of the position error [m] with a step of 1 ms; see the cases
};

class Oscillator : public testing::TestWithParam<Regime> {};

double largest_error(const nlohmann::json& problem, const nlohmann::json& regime, double step) {
  const auto& params = problem["params"];
  World world = make_world(oscillator(number(params["m"]), number(params["k"]), number(regime["z"]),
                                      number(params["x0"]), number(params["v0"]), step));
  double largest = 0.0;
  for (const auto& row : regime["t_x_v"]) {
    const int n = static_cast<int>(std::lround(number(row[0]) / step));
    run(world, n - static_cast<int>(world.step_count()));
    largest = std::max(largest, std::abs(world.position(1).x() - number(row[1])));
  }
  return largest;
}

TEST_P(Oscillator, ConvergesToTheExactMotion) {
  const nlohmann::json problem = reference("R01_damped_oscillator");
  const auto regime =
      std::find_if(problem["cases"].begin(), problem["cases"].end(),
                   [](const auto& entry) { return entry["name"] == GetParam().name; });
  ASSERT_NE(regime, problem["cases"].end());

  const double coarse = largest_error(problem, *regime, 1e-3);
  const double middle = largest_error(problem, *regime, 5e-4);
  const double fine = largest_error(problem, *regime, 2.5e-4);

  EXPECT_LT(coarse, GetParam().bound);
  EXPECT_NEAR(std::log2(coarse / middle), GetParam().order, 0.1);
  EXPECT_NEAR(std::log2(middle / fine), GetParam().order, 0.1);
}

// Bounds: amplitude A = 0.0125 m, w = 4 / s, t up to 5 s. Undamped, the phase runs ahead by w t (w
// dt)^2 / 24 and the amplitude is at most (w dt)^2 / 8 too large. Damped, the rate of decay s = Z /
// 2m is Z' / 2 too large and the frequency Z' / 4, which is at most A s t e^(-s t) Z' / 2 and A w t
// e^(-s t) Z' / 4; s t e^(-s t) is at most 1 / e.
INSTANTIATE_TEST_SUITE_P(Regimes, Oscillator,
                         testing::Values(Regime{"undamped", 2.0, 1.9e-7},
                                         Regime{"light", 1.0, 5.0e-6},
                                         Regime{"zeta=0.5", 1.0, 2.5e-5},
                                         Regime{"critical", 1.0, 5.0e-5},
                                         Regime{"overdamped", 1.0, 5.0e-4}));

}  // namespace
}  // namespace cordis::test
