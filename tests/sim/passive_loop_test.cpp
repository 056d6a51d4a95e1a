// tests/sim/passive_loop_test.cpp -- hands on scenes of every kind: loops that come to rest feel no
// damp, and loops that swing are ended.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/sim/hand_loop.h"
#include "tests/support/rounds.h"

namespace cordis::sim {
namespace {

using Gesture = std::function<double(double)>;  // where a hand wants to be, by time [m], [s]

/// The way from 0 to 1 with the least jerk.
double min_jerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
}

const Gesture kGestures[] = {
    [](double s) { return s < 1.0 ? 0.0 : 0.005; },                        // a jerk
    [](double s) { return 0.03 * std::sin(2.0 * std::numbers::pi * s); },  // to and fro
    [](double s) { return 0.1 * s; },                                      // pushes on
    [](double s) { return 0.02 * min_jerk((s - 1.0) / 0.2); },             // reaches
    [](double s) { return 0.01 * min_jerk((0.35 - std::abs(std::fmod(s, 0.7) - 0.35)) / 0.06); },
    [](double s) { return std::fmod(s, 0.5) < 0.25 ? 0.02 : 0.015; }};  // knocks

constexpr double kFast = 100.0;  // decays in no time

class Chance {
 public:
  explicit Chance(std::uint32_t seed) : random_(seed) {}
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  double between(double least, double most) {
    return least * std::pow(most / least, static_cast<double>(random_()) / 4294967296.0);
  }

 private:
  std::mt19937 random_;
};

/// A port on up to three more masses, in a tree of springs and dampers, fixed here and there.
scene::Scene random_scene(Chance& chance) {
  scene::Scene scene = bare_scene(1, chance.below(3) == 0 ? 5 : 1);
  const std::uint32_t masses = 1 + chance.below(4);
  std::vector<std::uint32_t> mats = {0};
  scene.network.mats[0].mass = chance.between(0.02, 0.3);
  for (std::uint32_t i = 1; i < masses; ++i) {
    mats.push_back(i + 1);  // behind the fixed point
    scene.network.mats.push_back(mass_at(Vec3::Zero(), chance.between(0.02, 0.3)));
    const std::uint32_t other = mats[chance.below(i)];
    const double stiffness = chance.between(20.0, 3000.0);
    scene.network.links.push_back(
        {other, i + 1, stiffness, chance.below(2) == 0 ? chance.between(0.05, 5.0) : 0.0, 0.0});
  }
  for (const std::uint32_t mat : mats) {
    if (masses > 1 && chance.below(2) == 0) continue;
    const double stiffness = chance.below(2) == 0 ? chance.between(10.0, 2000.0) : 0.0;
    scene.network.links.push_back({mat, 1, stiffness, chance.between(0.05, 8.0), 0.0});
  }
  return scene;
}

/// By which power of e the swing of the port falls in a second after a hand has moved by so little
/// that nothing saturates; below 0 when it grows.
double decay(const scene::Scene& scene, int delay, double stiffness) {
  Loop loop({0.0, delay, stiffness, 1, false}, scene);
  const auto swing_of_two_seconds = [&loop] {
    return swing_along(loop, Vec3(1e-5, 0.0, 0.0), 0, 2000);
  };
  swing_of_two_seconds();
  const double before = swing_of_two_seconds();
  const double after = swing_of_two_seconds();
  if (after > 1e-4) return -kFast;
  return before < 1e-12 ? kFast : 0.5 * std::log(before / after);
}

/// So do hands that are a little stiffer and a little softer.
bool comes_to_rest(const scene::Scene& scene, const Hold& hold) {
  for (const double times : {1.0, 0.97, 1.03}) {
    if (decay(scene, hold.delay, times * hold.stiffness) < 0.1) return false;
  }
  return true;
}

TEST(PassiveLoop, IsNotDampedAndASwingIsEnded) {
  Chance chance(33);
  int at_rest = 0;
  int swinging = 0;
  const int scenes = std::max(test::rounds(30), 10);
  for (int i = 0; i < scenes; ++i) {
    const scene::Scene scene = random_scene(chance);
    const int delay = 1 + static_cast<int>(chance.below(3));
    Hold hold{0.0, delay, chance.between(50.0, 10000.0)};
    const double late = decay(scene, delay, hold.stiffness);
    if (comes_to_rest(scene, hold)) {
      for (std::size_t g = 0; g < std::size(kGestures); ++g) {
        Loop loop(hold, scene);
        for (int n = 0; n < 5000; ++n) loop.tick(kGestures[g](n * kTick));
        EXPECT_EQ(loop.passivity_ticks(), 0u) << "scene " << i << " gesture " << g;
      }
      ++at_rest;
    } else if (late == -kFast) {
      Loop damped(hold, scene);
      hold.reports_work = false;
      Loop undamped(hold, scene);
      EXPECT_LT(swing(damped), 0.2 * swing(undamped)) << "scene " << i;
      ++swinging;
    }
  }
  EXPECT_GT(at_rest, scenes / 6);
  EXPECT_GT(swinging, scenes / 6);
}

}  // namespace
}  // namespace cordis::sim
