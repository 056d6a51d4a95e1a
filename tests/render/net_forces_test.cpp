// tests/render/net_forces_test.cpp
#include "viz_node/render/net_forces.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

/// One mass that falls at 9.81 m/s^2, and one at rest.
msg::SceneFrame falling(double time_s) {
  msg::SceneFrame frame;
  frame.simulated_s(time_s);
  frame.position_m(
      {0.0f, static_cast<float>(-0.5 * 9.81 * time_s * time_s), 0.0f, 1.0f, 1.0f, 1.0f});
  return frame;
}

TEST(NetForces, OfAFallAreTheWeightWhateverTheFramesAreApart) {
  for (const double apart_s : {0.04, 0.01, 0.001, 0.0003}) {
    NetForces forces;
    for (int n = 0; n < 20; ++n) {
      forces.append(falling(n * apart_s));
      if (n < 2) {
        EXPECT_TRUE(forces.sizes({2.0f, 3.0f}).empty());
        EXPECT_EQ(forces.span_s(), 0.0);
      }
    }
    const std::vector<double> sizes = forces.sizes({2.0f, 3.0f});
    ASSERT_EQ(sizes.size(), 2u) << apart_s;
    EXPECT_NEAR(sizes[0], 2.0 * 9.81, 0.02 * 9.81) << apart_s;
    EXPECT_EQ(sizes[1], 0.0);
    EXPECT_GE(forces.span_s(), 2e-3 - 1e-12);
    EXPECT_LT(forces.span_s(), std::max(2.5 * apart_s, 3.2e-3));
  }
}

TEST(NetForces, StayWhereAFrameComesAgain) {
  NetForces forces;
  for (int n = 0; n < 6; ++n) {
    for (int repeat = 0; repeat < 1 + n % 3; ++repeat) forces.append(falling(0.04 * n));
  }
  const std::vector<double> sizes = forces.sizes({2.0f, 3.0f});
  ASSERT_EQ(sizes.size(), 2u);
  EXPECT_NEAR(sizes[0], 2.0 * 9.81, 0.02 * 9.81);
  EXPECT_NEAR(forces.span_s(), 0.08, 1e-12);
}

TEST(NetForces, BeginAgainWhereTimeDoes) {
  NetForces forces;
  for (int n = 0; n < 5; ++n) forces.append(falling(0.04 * n));
  forces.append(falling(0.0));
  EXPECT_EQ(forces.span_s(), 0.0);
  forces.append(falling(0.04));
  forces.append(falling(0.08));
  EXPECT_NEAR(forces.span_s(), 0.08, 1e-12);
}

}  // namespace
}  // namespace cordis::viz
