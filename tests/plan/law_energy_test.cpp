// tests/plan/law_energy_test.cpp -- what a law brings into the motion.
#include "sim_node/plan/stability/law_energy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/laws/table.h"
#include "tests/engine/programs.h"
#include "tests/support/test_seed.h"

namespace cordis::plan {
namespace {

/// A tension that goes straight from point to point, and stays beyond the ends.
struct Curve {
  std::vector<double> distance;
  std::vector<double> tension;

  double at(double place) const {
    if (place <= distance.front()) return tension.front();
    for (std::size_t i = 1; i < distance.size(); ++i) {
      if (place > distance[i]) continue;
      const double share = (place - distance[i - 1]) / (distance[i] - distance[i - 1]);
      return tension[i - 1] + share * (tension[i] - tension[i - 1]);
    }
    return tension.back();
  }
};

/// The most that the potential falls on the way, in many small steps.
double max_fall(const Curve& curve, double from, double to) {
  constexpr int kSteps = 20'000;
  const double step = (to - from) / kSteps;
  double potential = 0.0;
  double lowest = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    potential += curve.at(from + (i + 0.5) * step) * step;
    lowest = std::min(lowest, potential);
  }
  return -lowest;
}

TEST(LawEnergy, FallsByWhatATableGivesOnBothSidesAtEveryScale) {
  std::mt19937 engine(test::test_seed());
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  for (int round = 0; round < 100; ++round) {
    const double scale = std::pow(10.0, between(-3.0, 1.5));  // [m]
    const double force = std::pow(10.0, between(-2.0, 3.0));  // [N]
    Curve curve;
    for (int i = 0; i < 6; ++i) {
      curve.distance.push_back(scale * (-1.0 + 0.4 * (i + between(-0.3, 0.3))));
      curve.tension.push_back(force * between(-1.0, 1.0));
    }
    engine::LinkState state;
    state.elasticity = engine::Table(curve.distance, curve.tension);
    const double start = scale * between(-1.0, 1.0);
    const Span span{start, start, start - scale * between(0.0, 1.0),
                    start + scale * between(0.0, 1.0)};

    const double expected =
        max_fall(curve, start, span.highest) + max_fall(curve, start, span.lowest);

    // It follows the way in 400 steps, so it misses where the tension changes its sign by as much.
    EXPECT_NEAR(fall_of(state, 0.0, span, {}), expected, 1e-4 * force * scale)
        << "round " << round << ", scale " << scale << " m";
  }
}

/// A push that grows as a power of the elongation: faster than its cube root, it drives apart ever harder.
TEST(LawEnergy, DrivesApartWhatPushesMoreThanTwiceAsMuchTenTimesAsFar) {
  for (const double exponent : {0.2, 0.28, 0.34, 0.5, 1.0, 1.5}) {
    const test::Term far = test::size(test::q(engine::Quantity::kElongation));
    engine::LinkState state;
    state.elasticity =
        test::expression_law(-3.0 * test::two(engine::Operation::kPower, far, exponent));
    const bool grows = std::pow(10.0, exponent) > 2.0;
    EXPECT_EQ(drives_apart(state, 0.2, /*turns=*/true, Reach{0.2}), grows) << exponent;
  }
}

}  // namespace
}  // namespace cordis::plan
