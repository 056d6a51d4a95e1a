// tests/sim/port_brake_test.cpp -- a hand that holds a simulated mass over a wire that is late.
#include "sim_node/port_brake.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "sim_node/device_exchange.h"
#include "tests/support/rounds.h"

namespace cordis::sim {
namespace {

using engine::Vec3;

constexpr double kTick = 1e-3;        // T [s]
constexpr double kPortMass = 0.05;    // m [kg]
constexpr double kMostForce = 100.0;  // of the device [N]

struct Hold {
  double viscosity = 5.0;  // Z of the scene at the port [N s/m]
  int delay = 1;           // d [periods]
  double stiffness = 0.0;  // k of the hand [N/m]
  int sub_steps = 1;
  bool tells_work = true;
  bool braked = true;
};

scene::Scene scene_of(const Hold& hold) {
  scene::Scene scene;
  scene.gesture_rate_hz = 1.0 / kTick;
  scene.network.dimension = 1;
  scene.network.step = kTick / hold.sub_steps;
  engine::Mat mass;
  mass.mass = kPortMass;
  engine::Mat ground;
  ground.kind = engine::MatKind::kFixed;
  scene.network.mats = {mass, ground};
  scene.network.links = {{0, 1, 0.0, hold.viscosity, 0.0}};
  scene::Port port;
  port.axes = {0};
  port.directions = {Vec3::UnitX()};
  scene.ports = {port};
  return scene;
}

/// The mass, its device and the hand, in lockstep; answers are felt `delay` periods late.
class Loop {
 public:
  explicit Loop(const Hold& hold)
      : hold_(hold),
        scene_(scene_of(hold)),
        world_(std::make_shared<const engine::Network>(scene_.network)),
        exchange_("key", 9, Role::kLiaison, scene_.ports, scene_.gesture_rate_hz, 77),
        answers_(static_cast<std::size_t>(hold.delay) + 1) {
    if (hold.braked) exchange_.brake_with(PortBrake(scene_, scene_.ports));
  }

  /// @param hand  where the hand wants to be [m]
  /// @param hears  false: the answer is lost, and the hand stays where it is
  void tick(double hand, bool hears = true) {
    if (hears) felt_ = answers_.front();
    answers_.pop_front();
    const msg::GesturePositions& felt = felt_;
    const double carried = felt.position_m()[0];
    const double force = std::clamp(hold_.stiffness * (hand - carried), -kMostForce, kMostForce);
    work_ += 0.5 * (force + force_) * (carried - carried_);
    carried_ = carried;
    force_ = force;
    msg::GestureForces sample;
    sample.device_id(9);
    sample.run(5);
    sample.sample(++samples_);
    sample.answered_run(felt.run());
    sample.answered_sample(felt.sample());
    sample.axis_count(1);
    sample.force_n()[0] = force;
    if (hold_.tells_work) sample.work_j(work_);
    exchange_.receive(sample);
    live();
  }

  /// A tick, with or without a new sample.
  void live() {
    exchange_.begin_tick();
    for (int n = 1; n <= hold_.sub_steps; ++n) {
      exchange_.play(world_, n, hold_.sub_steps);
      world_.step();
    }
    answers_.push_back(exchange_.answer_positions(world_, true, 0));
  }

  double position() const { return world_.position(0).x(); }
  std::uint64_t braked_ticks() const { return exchange_.braked_ticks(); }

 private:
  Hold hold_;
  scene::Scene scene_;
  engine::World world_;
  DeviceExchange exchange_;
  std::deque<msg::GesturePositions> answers_;
  msg::GesturePositions felt_;
  std::uint64_t samples_ = 0;
  double carried_ = 0.0;
  double force_ = 0.0;
  double work_ = 0.0;
};

/// Largest distance of the mass from the hand in the last of six seconds; the hand steps by 5 mm
/// after the first.
double swing(Loop& loop) {
  double largest = 0.0;
  for (int n = 0; n < 6000; ++n) {
    const double hand = n < 1000 ? 0.0 : 0.005;
    loop.tick(hand);
    if (n >= 5000) largest = std::max(largest, std::abs(loop.position() - hand));
  }
  return largest;
}

class Late : public ::testing::TestWithParam<int> {};

TEST_P(Late, AHandUpToTenTimesTooStiffNoLongerSwings) {
  for (const double viscosity : {0.5, 5.0}) {
    for (const double times : {1.5, 3.0, 10.0}) {
      Hold hold{viscosity, GetParam(), times * viscosity / (GetParam() * kTick)};
      Loop braked(hold);
      hold.braked = false;
      Loop unbraked(hold);

      EXPECT_GT(swing(unbraked), 0.01) << viscosity << " " << times;
      EXPECT_LT(swing(braked), 1e-5) << viscosity << " " << times;
      EXPECT_GT(braked.braked_ticks(), 0u);
    }
  }
}

TEST_P(Late, AHandWithinTheLimitIsNeverBraked) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  const std::function<double(double)> gestures[] = {
      [](double s) { return s < 1.0 ? 0.0 : 0.005; },                          // a jerk
      [](double s) { return 0.03 * std::sin(kTwoPi * s); },                    // to and fro
      [](double s) { return 0.002 * std::sin(kTwoPi * 8.0 * s) + 0.01 * s; },  // a tremor
      [](double s) { return 0.1 * s; }};  // a hand that pushes on
  for (const double viscosity : {2.0, 5.0}) {
    for (const int sub_steps : {1, 5}) {
      // What is held over a period is half a period older still when it is taken in parts.
      const double age = GetParam() + 0.5 * (1.0 - 1.0 / sub_steps);
      Hold hold{viscosity, GetParam(), 0.85 * viscosity / (age * kTick), sub_steps};
      for (std::size_t g = 0; g < std::size(gestures); ++g) {
        Loop loop(hold);
        for (int n = 0; n < test::rounds(6000); ++n) loop.tick(gestures[g](n * kTick));
        EXPECT_EQ(loop.braked_ticks(), 0u) << viscosity << " " << sub_steps << " gesture " << g;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PortBrake, Late, ::testing::Values(1, 2, 3));

TEST(PortBrake, KeepsToItselfWhenTheDeviceTellsNoWork) {
  Loop loop({5.0, 1, 10000.0, 1, false});

  swing(loop);

  EXPECT_EQ(loop.braked_ticks(), 0u);
}

TEST(PortBrake, ForgetsWhatAMomentWithoutAnswersHasMade) {
  for (const int lost : {8, 15, 30}) {
    Loop loop({5.0, 1, 0.5 * 5.0 / kTick});
    const auto hand = [](int n) { return 0.03 * std::sin(2.0 * std::numbers::pi * n * kTick); };
    int n = 0;
    for (; n < 2000; ++n) loop.tick(hand(n));
    for (; n < 2000 + lost; ++n) loop.tick(hand(n), false);
    for (; n < 3000; ++n) loop.tick(hand(n));
    const std::uint64_t braked = loop.braked_ticks();

    for (; n < 6000; ++n) loop.tick(hand(n));

    EXPECT_EQ(loop.braked_ticks(), braked) << lost;
    EXPECT_LT(std::abs(loop.position() - hand(n)), 0.001);
  }
}

TEST(PortBrake, LetsGoOfAMassThatNobodyHolds) {
  Loop loop({5.0, 1, 10.0 * 5.0 / kTick});
  for (int n = 0; n < 700; ++n) loop.tick(0.005);
  ASSERT_GT(loop.braked_ticks(), 0u);
  for (int n = 0; n < 25; ++n) loop.live();  // the device is lost
  const std::uint64_t braked = loop.braked_ticks();

  for (int n = 0; n < 100; ++n) loop.live();

  EXPECT_EQ(loop.braked_ticks(), braked);
}

TEST(PortBrake, HoldsAMassOfManySmallStepsToo) {
  Loop loop({5.0, 2, 10.0 * 5.0 / (2.0 * kTick), 10});

  EXPECT_LT(swing(loop), 1e-5);
}

}  // namespace
}  // namespace cordis::sim
