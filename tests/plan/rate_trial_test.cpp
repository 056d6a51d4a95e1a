// tests/plan/rate_trial_test.cpp -- that a rate which was tried out keeps what it promises.
#include "sim_node/plan/rate_trial.h"

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

constexpr double kStart = 0.01;     // [m]
constexpr double kFactor = 1.1;     // of the tolerance, and of the error that is stated
constexpr double kLowest = 1000.0;  // [Hz]

/// Masses of 1 kg, each on a spring of its own that vibrates at a frequency.
NetworkDescription oscillators(const std::vector<double>& frequencies_hz) {
  NetworkDescription scene = oscillator(1.0, 1.0, 0.0, kStart, 0.0, 1e-3);
  scene.mats.resize(1);
  scene.links.clear();
  for (const double frequency : frequencies_hz) {
    const double w = 2.0 * std::numbers::pi * frequency;
    scene.mats.push_back(mass(1.0, Vec3(kStart, 0, 0)));
    scene.links.push_back({0, static_cast<std::uint32_t>(scene.mats.size() - 1), w * w, 0.0, 0.0});
  }
  return scene;
}

/// Root of the mean square of position errors over all steps, over that of the motion.
double error_against_cosine(NetworkDescription scene, const std::string& integrator,
                            const std::vector<double>& frequencies_hz, double rate_hz,
                            double over_s) {
  scene.integrator = engine::integrator_named(integrator);
  scene.step = 1.0 / rate_hz;
  World world = make_world(scene);
  double off = 0.0;
  double motion = 0.0;
  for (long step = 1; step <= std::lround(over_s * rate_hz); ++step) {
    world.step();
    for (std::size_t i = 0; i < frequencies_hz.size(); ++i) {
      const double phase =
          2.0 * std::numbers::pi * frequencies_hz[i] * static_cast<double>(step) / rate_hz;
      const double exact = kStart * std::cos(phase);
      const double apart = world.position(static_cast<std::uint32_t>(i + 1)).x() - exact;
      off += apart * apart;
      motion += exact * exact;
    }
  }
  return std::sqrt(off / motion);
}

/// The lowest rate at which a `cordis` step is certainly stable, in whole gesture rates.
double lowest_rate(const std::vector<double>& frequencies_hz) {
  double lowest = kLowest;
  for (const double frequency : frequencies_hz)
    lowest = std::max(lowest, std::ceil(std::numbers::pi * frequency / 0.9 / kLowest) * kLowest);
  return lowest;
}

void expect_kept(const std::vector<double>& frequencies_hz, double over_s, double tolerance,
                 const std::string& integrator = "cordis") {
  std::string name = integrator + " at";
  for (const double frequency : frequencies_hz) name += " " + std::to_string(frequency);
  name += " Hz for " + std::to_string(over_s) + " s within " + std::to_string(tolerance);
  const NetworkDescription scene = oscillators(frequencies_hz);
  const plan::RateTrial trial =
      plan::find_rate(scene, integrator, {tolerance, over_s, lowest_rate(frequencies_hz), kLowest});
  if (trial.rate_hz == 0.0) {
    EXPECT_EQ(trial.refusal, "it takes too long to try it out") << name;
    return;
  }
  const double error =
      error_against_cosine(scene, integrator, frequencies_hz, trial.rate_hz, over_s);
  EXPECT_LE(error, kFactor * tolerance) << name << ": " << trial.rate_hz << " Hz";
  EXPECT_LE(error, kFactor * trial.error + 1e-9) << name << ": " << trial.rate_hz << " Hz";
}

TEST(RateTrial, KeepsTheToleranceOfWhatVibratesInTimeWithItsSteps) {
  expect_kept({150.0}, 1.0, 0.01);
  expect_kept({50.0}, 1.0, 0.05);
  expect_kept({100.0}, 1.0, 0.01);
  expect_kept({200.0}, 1.0, 0.01);
  expect_kept({250.0}, 1.0, 0.01);
  expect_kept({500.0}, 1.0, 0.05);
  expect_kept({1000.0}, 0.5, 0.05);
  expect_kept({125.0}, 2.0, 0.01);
  expect_kept({62.5}, 4.0, 0.01);
  expect_kept({200.0, 40.0}, 1.0, 0.01);
  for (const double frequency : {500.0, 1000.0, 2000.0})
    expect_kept({frequency}, 0.1, 0.01, "modal");
}

TEST(RateTrial, FindsARateForWhatVibratesInTimeWithItsSteps) {
  for (const double frequency : {50.0, 100.0, 150.0, 200.0, 250.0}) {
    EXPECT_EQ(
        plan::find_rate(oscillators({frequency}), "cordis", {0.05, 1.0, 1000.0, 1000.0}).refusal,
        "")
        << frequency << " Hz";
  }
}

TEST(RateTrial, KeepsTheToleranceOfRandomOscillators) {
  std::mt19937 random(20261130);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 40; ++round) {
    std::vector<double> frequencies(1 + random() % 3);
    for (double& frequency : frequencies) {
      frequency = std::pow(10.0, 1.0 + 1.7 * unit(random));  // to 500 Hz
      if (random() % 2 == 0) frequency = std::max(12.5, std::round(frequency / 12.5) * 12.5);
    }
    const double over_s = random() % 2 == 0 ? 0.5 : 0.1 + 0.4 * unit(random);
    const double tolerance = std::pow(10.0, -2.5 + 1.5 * unit(random));
    expect_kept(frequencies, over_s, tolerance, random() % 2 == 0 ? "cordis" : "symplectic4");
  }
}

/// A pair of masses that flies, and vibrates by itself as little as a tenth of a millimetre.
TEST(RateTrial, StatesTheErrorOfWhatVibratesBesideWhatTravelsFar) {
  std::mt19937 random(20261201);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int hidden = 0;
  for (int round = 0; round < 20; ++round) {
    const double frequency = 20.0 + 60.0 * unit(random);
    const double start = std::pow(10.0, -4.0 - 2.0 * unit(random));
    const double over_s = 0.2 + 0.3 * unit(random);
    const double w = 2.0 * std::numbers::pi * frequency;
    NetworkDescription scene = oscillator(1.0, 1.0, 0.0, kStart, 0.0, 1e-3);
    scene.mats = {mass(1.0, Vec3(0, 0, 0)), mass(1.0, Vec3(1.0 + start, 0, 0))};
    for (auto& mat : scene.mats) mat.velocity = Vec3(10.0 * unit(random), 0, 0);
    scene.mats[1].velocity = scene.mats[0].velocity;
    scene.links = {{0, 1, 0.5 * w * w, 0.0, 1.0}};

    const plan::RateTrial trial =
        plan::find_rate(scene, "cordis", {0.01, over_s, kLowest, kLowest});

    ASSERT_GT(trial.rate_hz, 0.0) << trial.refusal;
    ASSERT_TRUE(trial.worst_body.has_value());
    EXPECT_EQ(trial.worst_body->mat, 0U);
    scene.step = 1.0 / trial.rate_hz;
    World world = make_world(scene);
    double off = 0.0;
    double motion = 0.0;
    for (long step = 1; step <= std::lround(over_s * trial.rate_hz); ++step) {
      world.step();
      const double exact = start * std::cos(w * static_cast<double>(step) / trial.rate_hz);
      const double apart = world.position(1).x() - world.position(0).x() - 1.0 - exact;
      off += apart * apart;
      motion += exact * exact;
    }
    const double own = std::sqrt(off / motion);
    EXPECT_LT(own, kFactor * trial.worst_body->error) << frequency << " Hz, " << start << " m";
    EXPECT_GT(own, 0.7 * trial.worst_body->error) << frequency << " Hz, " << start << " m";
    if (own > trial.error) ++hidden;
  }
  EXPECT_GT(hidden, 10) << "the whole hides it";
}

TEST(RateTrial, OfOneBodyThatIsHeldIsItsOwnError) {
  const plan::RateTrial trial =
      plan::find_rate(oscillators({40.0}), "cordis", {0.01, 0.5, kLowest, kLowest});
  ASSERT_TRUE(trial.worst_body.has_value());
  EXPECT_NEAR(trial.worst_body->error, trial.error, 1e-12);
}

TEST(RateTrial, MeasuresWhatDiesAtOnceByItsWholeMotion) {
  // The vibration of 60.3 Hz is gone after 2 ms: what is left of 10 s is rest.
  const double w = std::sqrt(143547.079467);
  const double half = 500.0;
  const NetworkDescription scene = oscillator(1.0, w * w, 2.0 * half, kStart, 0.0, 1e-3);
  const plan::RateTrial trial = plan::find_rate(scene, "cordis", {0.01, 10.0, 2000.0, 1000.0});
  ASSERT_EQ(trial.refusal, "");
  EXPECT_LE(trial.rate_hz, 3e5);
  NetworkDescription chosen = scene;
  chosen.step = 1.0 / trial.rate_hz;
  World world = make_world(chosen);
  const double fast = half + std::sqrt(half * half - w * w);
  const double slow = w * w / fast;
  double off = 0.0;
  double motion = 0.0;
  for (long step = 1; step <= std::lround(trial.rate_hz); ++step) {
    world.step();
    const double time = static_cast<double>(step) / trial.rate_hz;
    const double exact =
        kStart * (fast * std::exp(-slow * time) - slow * std::exp(-fast * time)) / (fast - slow);
    off += std::pow(world.position(1).x() - exact, 2);
    motion += exact * exact;
  }
  EXPECT_LE(std::sqrt(off / motion), kFactor * 0.01) << trial.rate_hz;
}

TEST(RateTrial, StaysWithinTheHighestRateThatASceneMayHave) {
  const plan::RateTrial trial =
      plan::find_rate(oscillators({200.0}), "cordis", {1e-6, 0.01, 1000.0, 1000.0, 20500.0});
  EXPECT_EQ(trial.rate_hz, 0.0);
  EXPECT_EQ(trial.refusal, "no rate is high enough");
  const plan::RateTrial just =
      plan::find_rate(oscillators({200.0}), "cordis", {0.01, 0.05, 1000.0, 1000.0, 20500.0});
  EXPECT_EQ(just.refusal, "");
  EXPECT_LE(just.rate_hz, 20000.0);
}

}  // namespace
}  // namespace cordis::test
