// tests/device/mock_key_test.cpp
#include "device_node/drivers/mock_key.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

/// A key without any friction, 20 cm of travel to either side, and stops of the given damping.
KeySettings bare_key(double damping_ratio_of_stops) {
  KeySettings key;
  key.mass_kg = 0.1;
  key.viscosity_n_s_per_m = 0.0;
  key.friction_n = 0.0;
  key.stop_n_per_m = 1000.0;
  key.stop_viscosity_n_s_per_m = damping_ratio_of_stops * 2.0 * std::sqrt(1000.0 * 0.1);
  key.motor_limit_n = 1e6;
  key.lowest_m = -0.2;
  key.highest_m = 0.2;
  return key;
}

/// Gives a resting key a speed: one push of the motor over one short sub-step.
void launch(MockKey& key, const KeySettings& settings, double speed_m_per_s) {
  const double h = 1e-3;
  key.advance(h, settings.mass_kg * speed_m_per_s / h, 0.0);
}

/// Speed left after the first bounce, for a key sent upward (1) or downward (-1) at 0.5 m/s.
double speed_after_bounce(double damping_ratio, double h, double direction) {
  const KeySettings settings = bare_key(damping_ratio);
  MockKey key(settings);
  launch(key, settings, direction * 0.5);
  for (double t = 0.0; t < 2.0; t += h) {
    key.advance(h, 0.0, 0.0);
    if (std::abs(key.position_m()) < 0.19 && direction * key.speed_m_per_s() < 0.0) break;
  }
  return -direction * key.speed_m_per_s();
}

/// Share of the speed left by a bounce at a spring-damper that does not pull: with w = 1,
/// u(t) = exp(-z t) sin(d t) / d, d = sqrt(1 - z^2), until K u + Z du/dt = 0, that is at
/// d t = pi - atan2(2 z d, 1 - 2 z^2).
double restitution(double z) {
  const double d = std::sqrt(1.0 - z * z);
  const double angle = M_PI - std::atan2(2.0 * z * d, 1.0 - 2.0 * z * z);
  return -std::exp(-z * angle / d) * (std::cos(angle) - z / d * std::sin(angle));
}

TEST(MockKey, BouncesOffAStopLikeADampedOscillatorThatDoesNotPull) {
  for (const double direction : {1.0, -1.0}) {
    for (const double damping_ratio : {0.02, 0.1, 0.3, 0.5}) {
      const double expected = 0.5 * restitution(damping_ratio);

      const double coarse = speed_after_bounce(damping_ratio, 1e-4, direction) - expected;
      const double fine = speed_after_bounce(damping_ratio, 1e-5, direction) - expected;

      // First order: the damper sees the speed of half a sub-step before. Relative error
      // 2 zeta w h, with w h = 0.01.
      EXPECT_LT(std::abs(coarse), 0.5 * 2.0 * damping_ratio * 0.01 + 1e-4) << damping_ratio;
      EXPECT_LT(std::abs(fine), std::abs(coarse) / 3.0) << damping_ratio;
    }
  }
}

TEST(MockKey, SwingsOnItsReturnSpringLikeADampedOscillator) {
  KeySettings settings = bare_key(0.1);
  settings.return_n_per_m = 40.0;
  settings.viscosity_n_s_per_m = 0.4;
  MockKey key(settings);
  key.carry_to(0.05, 1.0);  // drawn out slowly, 0.05 m in a second,
  key.carry_to(0.05, 1.0);  // held,
  const double h = 1e-5;    // and let go

  const double s = 0.4 / (2.0 * 0.1);
  const double w = std::sqrt(40.0 / 0.1 - s * s);
  for (int n = 1; n <= 100000; ++n) {
    key.advance(h, 0.0, 0.0);
    const double t = n * h;
    const double expected = 0.05 * std::exp(-s * t) * (std::cos(w * t) + s / w * std::sin(w * t));
    ASSERT_NEAR(key.position_m(), expected, 0.05 * 20.0 * h) << n;  // amplitude * w * h
  }
}

TEST(MockKey, SlidesAsFarAsDryFrictionLetsIt) {
  // Speed falls by F h/m per sub-step: it moves h (v - k F h/m) in sub-step k, until nothing is
  // left; in the limit v^2 m / 2 F.
  KeySettings settings = bare_key(0.1);
  settings.friction_n = 0.5;
  MockKey key(settings);
  const double h = 1e-4;
  key.carry_to(0.3 * h, h);  // 0.3 m/s

  const double loss = settings.friction_n * h / settings.mass_kg;
  double expected = key.position_m();
  for (double speed = 0.3 - loss; speed > 0.0; speed -= loss) expected += h * speed;
  for (int n = 0; n < 2000; ++n) key.advance(h, 0.0, 0.0);

  EXPECT_NEAR(key.position_m(), expected, 1e-12);
  EXPECT_NEAR(key.position_m(), 0.3 * 0.3 * 0.1 / (2.0 * 0.5), 0.3 * h);
  EXPECT_EQ(key.speed_m_per_s(), 0.0);
}

TEST(MockKey, DoesNotMoveUnderLessThanItsDryFriction) {
  KeySettings settings = bare_key(0.1);
  settings.friction_n = 0.5;
  MockKey key(settings);

  for (int n = 0; n < 1000; ++n) key.advance(1e-3, 0.3, 0.199);
  EXPECT_EQ(key.position_m(), 0.0);

  for (int n = 0; n < 1000; ++n) key.advance(1e-3, 0.3, 0.201);
  EXPECT_GT(key.position_m(), 0.0);
}

TEST(MockKey, FallsToItsFinalSpeedInAViscousGuide) {
  KeySettings settings = bare_key(0.1);
  settings.viscosity_n_s_per_m = 8.0;
  settings.lowest_m = -1.0;
  settings.highest_m = 1.0;
  MockKey key(settings);

  for (int n = 0; n < 500; ++n) key.advance(1e-3, 0.8, 0.0);

  EXPECT_NEAR(key.speed_m_per_s(), 0.8 / 8.0, 1e-12);
}

TEST(MockKey, RestsOnItsStopUnderAForce) {
  KeySettings settings = bare_key(0.3);
  settings.viscosity_n_s_per_m = 1.0;
  MockKey key(settings);

  for (int n = 0; n < 20000; ++n) key.advance(1e-3, -5.0, -3.0);

  EXPECT_NEAR(key.position_m(), settings.lowest_m - 8.0 / settings.stop_n_per_m, 1e-12);
}

TEST(MockKey, MotorSaturates) {
  KeySettings settings = bare_key(0.1);
  settings.motor_limit_n = 3.0;
  MockKey key(settings);
  MockKey other(settings);

  key.advance(1e-3, 1e9, 0.0);
  other.advance(1e-3, 3.0, 0.0);
  EXPECT_EQ(key.speed_m_per_s(), other.speed_m_per_s());

  key.advance(1e-3, -1e9, 0.0);
  other.advance(1e-3, -3.0, 0.0);
  EXPECT_EQ(key.speed_m_per_s(), other.speed_m_per_s());
}

TEST(MockKey, EveryBounceLosesEnergy) {
  // The least damping there may be, at the longest sub-step the mock would take (K h^2/m = 0.01),
  // at every phase of the sub-step: sampling the contact could add 0.25 % of energy.
  KeySettings settings = bare_key(0.01);
  settings.lowest_m = -0.01;
  settings.highest_m = 0.01;
  const double h = 0.1 * std::sqrt(settings.mass_kg / settings.stop_n_per_m);

  for (int trial = 0; trial < 500; ++trial) {
    MockKey key(settings);
    launch(key, settings, 0.2 + 0.001 * trial);
    double speed = std::abs(key.speed_m_per_s());
    int bounces = 0;
    for (int n = 0; n < 2000; ++n) {
      key.advance(h, 0.0, 0.0);
      const bool flying = std::abs(key.position_m()) < 0.0099;
      if (!flying || std::abs(key.speed_m_per_s()) == speed) continue;
      ASSERT_LT(std::abs(key.speed_m_per_s()), speed) << "trial " << trial << " step " << n;
      speed = std::abs(key.speed_m_per_s());
      ++bounces;
    }
    ASSERT_GT(bounces, 5);
  }
}

TEST(MockKey, NeverGivesMoreEnergyThanItWasGiven) {
  std::mt19937_64 random(1990);
  std::uniform_real_distribution<double> force(-6.0, 6.0);
  for (int trial = 0; trial < 200; ++trial) {
    KeySettings settings = bare_key(trial % 2 == 0 ? 0.01 : 0.4);
    settings.friction_n = trial % 3 == 0 ? 0.05 : 0.0;
    settings.viscosity_n_s_per_m = trial % 5 == 0 ? 0.5 : 0.0;
    settings.lowest_m = -0.02;
    settings.highest_m = 0.02;
    const double h = 0.1 * std::sqrt(settings.mass_kg / settings.stop_n_per_m);
    MockKey key(settings);
    double given_j = 0.0;
    double motor = 0.0;
    double hand = 0.0;
    for (int n = 0; n < 5000; ++n) {
      if (n % 7 == 0) motor = force(random);
      if (n % 11 == 0) hand = force(random);
      const double speed_before = key.speed_m_per_s();
      key.advance(h, motor, hand);
      given_j += (motor + hand) * h * 0.5 * (speed_before + key.speed_m_per_s());
      if (std::abs(key.position_m()) >= 0.02) continue;  // part of the energy is in a stop
      const double kinetic_j = 0.5 * settings.mass_kg * key.speed_m_per_s() * key.speed_m_per_s();
      ASSERT_LE(kinetic_j, given_j + 1e-12) << "trial " << trial << " step " << n;
    }
  }
}

TEST(MockKey, IsCarriedToTheLastBit) {
  MockKey key(bare_key(0.1));

  key.carry_to(-0.0123, 1e-3);

  EXPECT_EQ(key.position_m(), -0.0123);
  EXPECT_DOUBLE_EQ(key.speed_m_per_s(), -12.3);
}

TEST(MockKey, RestsAtTheEndOfTravelNearestToZero) {
  KeySettings settings;
  settings.lowest_m = 0.01;
  settings.highest_m = 0.05;

  EXPECT_EQ(MockKey(settings).position_m(), 0.01);
}

TEST(MockKey, RefusesSettingsOutOfRange) {
  const auto refuses = [](auto change) {
    KeySettings settings;
    change(settings);
    EXPECT_THROW(MockKey{settings}, std::invalid_argument);
  };
  refuses([](KeySettings& key) { key.mass_kg = 0.0; });
  refuses([](KeySettings& key) { key.mass_kg = NAN; });
  refuses([](KeySettings& key) { key.friction_n = -0.1; });
  refuses([](KeySettings& key) { key.stop_viscosity_n_s_per_m = 0.0; });
  refuses([](KeySettings& key) { key.lowest_m = key.highest_m; });
}

}  // namespace
}  // namespace cordis::device
