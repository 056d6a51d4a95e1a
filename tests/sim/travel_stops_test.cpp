// tests/sim/travel_stops_test.cpp -- a hand that presses a simulated mass against the end of the
// travel of its device.
#include "sim_node/devices/travel_stops.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/sim/hand_loop.h"

namespace cordis::sim {
namespace {

constexpr double kLowest = -0.03;   // [m]
constexpr double kHighest = 0.01;   // [m]
constexpr double kSettledBy = 1.0;  // [s]

DeviceReach key_reach() {
  DeviceReach reach;
  reach.lowest_m.fill(kLowest);
  reach.highest_m.fill(kHighest);
  return reach;
}

/// A device of role liaison that gives one force to every axis, tick by tick.
class PressedScene {
 public:
  explicit PressedScene(scene::Scene scene) {
    scene.step_rate_hz = 1.0 / scene.network.step;
    dt_ = scene.network.step;
    simulation_ =
        std::make_unique<Simulation>(std::make_shared<const scene::Scene>(std::move(scene)), 7);
  }

  void press(double force_n, double seconds, const DeviceReach& reach = key_reach()) {
    const int ticks = static_cast<int>(std::lround(seconds / kTick));
    for (int n = 0; n < ticks; ++n) {
      msg::GestureForces sample;
      sample.device_id(9);
      sample.epoch(5);
      sample.sample(++samples_);
      sample.axis_count(3);
      sample.force_n().fill(force_n);
      simulation_->devices().front().receive(sample, true, reach);
      do {
        const Vec3 before = place();
        done_ = simulation_->advance(1, events_);
        highest = std::max(highest, place().maxCoeff());
        lowest = std::min(lowest, place().minCoeff());
        fastest = std::max(fastest, (place() - before).cwiseAbs().maxCoeff() / dt_);
      } while (!done_);
    }
  }

  Vec3 place() const { return simulation_->world().position(0); }

  double highest = 0.0;  // [m]
  double lowest = 0.0;   // [m]
  double fastest = 0.0;  // [m/s]

 private:
  double dt_ = 0.0;
  bool done_ = false;
  std::unique_ptr<Simulation> simulation_;
  EventRoom events_;
  std::uint64_t samples_ = 0;
};

TEST(TravelStops, HoldAMassWithinTheTravelOfItsDevice) {
  using engine::IntegratorKind;
  constexpr double kShare = TravelStops::kShare;
  for (const IntegratorKind integrator :
       {IntegratorKind::kCordis, IntegratorKind::kLeapfrog, IntegratorKind::kImplicit}) {
    for (const int sub_steps : {1, 4}) {
      for (const double force : {20.0, -20.0, 0.3}) {
        scene::Scene scene = bare_scene(1, sub_steps);
        scene.network.integrator = integrator;
        const double dt = scene.network.step;
        PressedScene pressed(scene);
        pressed.press(force, kSettledBy);

        const double pressed_in = std::abs(force) * dt * dt / (kPortMass * kShare);
        const double beyond = 0.5 * pressed.fastest * dt + 2.0 * pressed_in;
        EXPECT_LT(pressed.highest, kHighest + beyond) << engine::to_string(integrator);
        EXPECT_GT(pressed.lowest, kLowest - beyond) << engine::to_string(integrator);
        const double end = force > 0.0 ? kHighest : kLowest;
        EXPECT_NEAR(pressed.place().x(), end, 1.01 * pressed_in) << engine::to_string(integrator);
      }
    }
  }
}

TEST(TravelStops, HoldEveryAxisOfAPort) {
  PressedScene pressed(bare_scene(2, 4));
  pressed.press(5.0, kSettledBy);

  EXPECT_NEAR(pressed.place().x(), kHighest, 1e-4);
  EXPECT_NEAR(pressed.place().y(), kHighest, 1e-4);
  EXPECT_LT(pressed.highest, kHighest + 1e-3);
}

TEST(TravelStops, LeaveAMassAloneThatIsWithinTheTravel) {
  scene::Scene scene = bare_scene(1);
  scene.network.links = {{0, 1, 100.0, 2.0, 0.0}};
  PressedScene pressed(scene);
  pressed.press(0.9, kSettledBy);

  EXPECT_NEAR(pressed.place().x(), 0.009, 1e-9);
}

TEST(TravelStops, KeepTheStepStableBesideAStiffLink) {
  // K' = 1.8 at the port, of at most 2 for any number of such links: the stop takes the rest
  scene::Scene scene = bare_scene(1);
  scene.network.links = {{0, 1, 1.8 * kPortMass / (kTick * kTick), 2.0, 0.012}};
  PressedScene pressed(scene);
  pressed.press(50.0, kSettledBy);
  const double rest = pressed.place().x();
  pressed.press(50.0, 0.2);

  EXPECT_NEAR(pressed.place().x(), rest, 1e-6);
  EXPECT_LT(pressed.highest, 0.015);
}

TEST(TravelStops, LeadBackAMassThatWasBeyondAnEndNobodyKnew) {
  scene::Scene scene = bare_scene(1);
  scene.network.links = {{0, 1, 0.0, 1.0, 0.0}};
  PressedScene pressed(scene);
  pressed.press(0.5, 1.0, DeviceReach());
  EXPECT_GT(pressed.place().x(), 0.3);
  pressed.press(0.0, 0.2, key_reach());  // stops it
  pressed.fastest = 0.0;
  const double from = pressed.place().x();
  pressed.press(0.0, 0.5);
  EXPECT_NEAR(pressed.place().x(), from - 0.5 * TravelStops::kReturn, 0.02);
  pressed.press(0.0, 10.0);

  EXPECT_LT(pressed.fastest, 1.1 * TravelStops::kReturn);
  EXPECT_LT(pressed.place().x(), kHighest + 1e-6);
  EXPECT_GT(pressed.lowest, kLowest - 1e-3);
}

TEST(TravelStops, StandWhereTheDeviceTells) {
  msg::DeviceDescription description;
  description.travel_m().fill(0.12);
  EXPECT_EQ(reach_of(description).highest_m[3], 0.12);  // they differ: either side
  EXPECT_EQ(reach_of(description).lowest_m[3], -0.12);
  description.lowest_m(-0.04);
  description.highest_m(0.0);
  EXPECT_EQ(reach_of(description).highest_m[3], 0.0);
  EXPECT_EQ(reach_of(description).lowest_m[3], -0.04);
  description.highest_m(std::nan(""));
  description.travel_m().fill(std::nan(""));
  EXPECT_EQ(reach_of(description).highest_m[3], DeviceReach::kFarthest);
  EXPECT_EQ(reach_of(description).lowest_m[3], -DeviceReach::kFarthest);
}

}  // namespace
}  // namespace cordis::sim
