// tests/gallery/mechanisms_test.cpp
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr const char* kLaunch = "mechanisms.yaml";

/// The change of state of the last tick, at the link from this MAT.
std::optional<engine::LinkEvent> change_at(const GallerySession& session, const std::string& mat) {
  const std::uint32_t index = session.mats(mat).first;
  for (const engine::LinkEvent& event : session.events()) {
    if (event.mat_a == index) return event;
  }
  return std::nullopt;
}

/// Half of the way that the bob of the clock goes in its swing after 15 seconds [m].
double swing_of_the_clock(GallerySession& session) {
  session.play_until(15.0);
  return 0.5 * session.range_until(16.1, "bob_x");
}

TEST(Mechanisms, AClockGoesOnForItIsPushedOnOneWayAlone) {
  GallerySession session(kLaunch);
  // the push gives 0.05 N * 4 mm, the medium takes pi Z w A^2 a turn
  const double w = std::sqrt(2.0 / 0.05);
  const double amplitude = std::sqrt(0.05 * 0.004 / (std::numbers::pi * 0.05 * w));
  EXPECT_NEAR(swing_of_the_clock(session), amplitude, 0.05 * amplitude);

  const ChangedScene changed("mechanisms", {{" and rising(elongation_m)", ""}});
  GallerySession both_ways(kLaunch, changed.overrides());
  EXPECT_LT(swing_of_the_clock(both_ways), 0.1 * amplitude);
}

struct Break {
  double after_s = 0.0;      ///< since the touch
  double impulse_n_s = 0.0;  ///< taken since then
};

Break break_of_the_seal(GallerySession& session) {
  Break broken;
  double touched = -1.0;
  session.play_until(3.0, [&] {
    const auto change = change_at(session, "wall");
    if (change && change->to == 1) touched = session.time_s();
    if (change && change->to == 2) broken.after_s = session.time_s() - touched;
    if (touched >= 0.0 && broken.after_s == 0.0) {
      broken.impulse_n_s -= 1.0e-3 * session.signal("finger_force");
    }
  });
  return broken;
}

TEST(Mechanisms, ASealBreaksWhenItHasBorneItsShareBeTheHandStrongOrWeak) {
  GallerySession session(kLaunch);
  const Break strong = break_of_the_seal(session);
  EXPECT_NEAR(strong.impulse_n_s, 0.4, 0.01);

  const ChangedScene changed("mechanisms", {{"wax_n_per_m: 1000", "wax_n_per_m: 500"}});
  GallerySession softly(kLaunch, changed.overrides());
  const Break weak = break_of_the_seal(softly);
  EXPECT_NEAR(weak.impulse_n_s, 0.4, 0.01);
  EXPECT_GT(weak.after_s, 1.8 * strong.after_s);
}

/// The distance from the glove to the burr after it was shaken [m].
double distance_of_the_burr(GallerySession& session) {
  session.play_until(2.1);
  return (session.position("glove") - session.position("burr")).norm();
}

TEST(Mechanisms, ABurrComesAlongAndFallsOffWhenItIsShaken) {
  GallerySession session(kLaunch);
  session.play_until(1.6);
  EXPECT_NEAR(session.signal("burr_x"), -0.014, 1e-3);  // carried by 58 mm
  EXPECT_GT(distance_of_the_burr(session), 0.05);

  const ChangedScene changed("mechanisms", {{"slip_m_per_s > lets_go_m_per_s", "age_s > 100"}});
  GallerySession held(kLaunch, changed.overrides());
  EXPECT_LT(distance_of_the_burr(held), 0.025);
}

TEST(Mechanisms, ASledgeStopsWhereDryFrictionStopsIt) {
  GallerySession session(kLaunch);
  double speed = 0.0;
  double from = 0.0;
  session.play_until(2.0, [&] {
    const auto change = change_at(session, "palm");
    if (!change || change->to != 0) return;
    speed = session.velocity("sledge").x();
    from = session.signal("sledge_x");
  });
  ASSERT_GT(speed, 0.3);
  // m dv/dt = -(F + Z v)
  constexpr double kMass = 0.1;
  constexpr double kFriction = 0.3;
  constexpr double kMedium = 0.05;
  const double way =
      kMass / kMedium * (speed - kFriction / kMedium * std::log1p(kMedium * speed / kFriction));
  EXPECT_NEAR(session.signal("sledge_x") - from, way, 0.01 * way);
  EXPECT_LT(std::abs(session.velocity("sledge").x()), 1e-6);
}

}  // namespace
}  // namespace cordis::test
