// tests/gallery/bouncing_ball_test.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kRadius = 0.02;
constexpr double kFall = 0.30;

/// Restitution of a spring-damper that ends where it began: exp(-pi zeta / sqrt(1 - zeta^2)).
double restitution(double viscosity) {
  const double zeta = viscosity / (2.0 * std::sqrt(800.0 * 0.02));
  return std::exp(-std::numbers::pi * zeta / std::sqrt(1.0 - zeta * zeta));
}

TEST(BouncingBall, ComesBackAsHighAsItsMaterialLets) {
  const std::array<double, 3> viscosities = {0.2, 0.8, 2.0};
  GallerySession session("bouncing_ball.yaml");
  std::array<double, 3> highest{};
  std::array<bool, 3> has_bounced{};
  session.play_until(0.6, [&] {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const double height = session.position("balls", i).y() - kRadius;
      if (height < 0.0 && highest[i] > 0.001) has_bounced[i] = true;  // the second touch
      if (session.velocity("balls", i).y() > 0.0 && !has_bounced[i]) {
        highest[i] = std::max(highest[i], height);
      }
    }
  });

  for (std::size_t i = 0; i < 3; ++i) {
    const double expected = restitution(viscosities[i]);
    // the weight bends the softest bounce most
    EXPECT_NEAR(std::sqrt(highest[i] / kFall), expected, 0.02 * expected) << i;
  }
}

TEST(BouncingBall, FindsTheBeatOfTheBat) {
  GallerySession session("bouncing_ball.yaml");
  int hits = 0;
  bool touches = false;
  session.play_until(4.0);
  session.play_until(8.0, [&] {
    const bool now = std::abs(session.signal("bat_force")) > 0.0;
    if (now && !touches) ++hits;
    touches = now;
  });
  EXPECT_EQ(hits, 10);  // every 0.4 s
}

}  // namespace
}  // namespace cordis::test
