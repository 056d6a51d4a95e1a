// tests/device/pointer_test.cpp
#include "device_node/drivers/pointer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "device_node/pointer_link.h"
#include "tests/support/test_seed.h"

namespace cordis::device {
namespace {

constexpr double kRingFinger = 2000.0;
constexpr double kRingHand = 500.0;
constexpr double kLedPeriod = 0.001;
constexpr std::uint64_t kViz = 7;  // epoch of a viz_node

AxisLayout ring_layout() {
  AxisLayout layout;
  layout.count = 2;
  layout.lowest_m = -0.08;
  layout.highest_m = 0.08;
  return layout;
}

MockSettings ring_mechanics(bool is_ring) {
  MockSettings settings;
  settings.key.friction_n = 0.0;
  settings.hand.stiffness_n_per_m = kRingHand;
  settings.hand.finger_n_per_m = kRingFinger;
  settings.hand.holds = is_ring;
  return settings;
}

/// A pointer and the page that leads it.
struct Led {
  explicit Led(const PointerSettings& settings = {}, bool is_ring = true)
      : pointer(ring_mechanics(is_ring), settings, ring_layout(),
                []() noexcept { return now_nsec; }) {
    pointer.start(Role::kMass);
  }

  void say(bool holds, std::uint32_t held, double first_m, double second_m) {
    PointerTarget target;
    target.epoch = kViz;
    target.number = ++number;
    target.holds = holds;
    target.held = held;
    target.target_m = {first_m, second_m};
    pointer.pointer_port()->target.put(target);
  }

  /// Runs this many periods under a constant force. @return true if the device is present at the end
  bool live(int periods, double force_n = 0.0) {
    AxisValues command{};
    command[0] = force_n;
    bool present = true;
    for (int n = 0; n < periods; ++n) {
      now_nsec += period_nsec;
      const bool alive = pointer.begin_period();
      present = pointer.read(sensed) && alive;
      static_cast<void>(pointer.change_command(command, 0.2));
    }
    return present;
  }

  /// The page repeats itself, as it does while a hand does not move.
  bool live_held(int periods, double first_m, double second_m, double force_n = 0.0) {
    bool present = true;
    for (int n = 0; n < periods; n += 50) {
      say(true, 1, first_m, second_m);
      present = live(50, force_n);
    }
    return present;
  }

  PointerFeel feel() {
    PointerFeel newest;
    while (pointer.pointer_port()->feel.take(newest)) {
    }
    return newest;
  }

  static inline std::int64_t now_nsec = 0;
  std::int64_t period_nsec = 1'000'000;  // longer in slow motion
  Pointer pointer;
  AxisValues sensed{};
  std::uint64_t number = 0;
};

TEST(Pointer, IsHeldBackByAForceAsItsSpringsAre) {
  // As of a mock: x = target + F / K_h + F / K_f at rest.
  Led led;
  const double target = 0.03;
  led.live_held(5000, target, 0.0, -2.0);
  EXPECT_NEAR(led.sensed[0], target - 2.0 / kRingHand - 2.0 / kRingFinger, 1e-9);
  const PointerFeel feel = led.feel();
  EXPECT_TRUE(feel.holds);
  EXPECT_EQ(feel.force_n[0], -2.0);
  EXPECT_NEAR(feel.target_m[0], target, 1e-9);
}

TEST(Pointer, AppearsWhereThePortIs) {
  PointerSettings settings;
  settings.only_while_held = true;
  Led led(settings);
  EXPECT_FALSE(led.live(10)) << "no page holds it";
  EXPECT_TRUE(led.pointer.is_yielding());

  led.say(true, 1, 0.05, -0.04);
  EXPECT_TRUE(led.live(1));
  EXPECT_FALSE(led.pointer.is_yielding());
  EXPECT_EQ(led.sensed[0], 0.05);
  EXPECT_EQ(led.sensed[1], -0.04);
}

TEST(Pointer, LetsGoWhenThePageIsSilentAndThenIsAway) {
  PointerSettings settings;
  settings.only_while_held = true;
  Led led(settings);
  led.say(true, 1, 0.01, 0.0);
  led.live(1);
  EXPECT_TRUE(led.live(499)) << "499 ms since the last word";
  EXPECT_TRUE(led.feel().holds);
  led.live(2);
  EXPECT_FALSE(led.feel().holds);
  EXPECT_TRUE(led.live(145)) << "the hand fades";
  EXPECT_FALSE(led.live(10));
  EXPECT_TRUE(led.pointer.is_yielding());
}

TEST(Pointer, InSlowMotionThePageIsSilentAfterTheSameRealTime) {
  Led led;
  led.period_nsec = 100'000'000;
  led.say(true, 1, 0.01, 0.0);
  led.live(1);
  led.live(4);
  EXPECT_TRUE(led.feel().holds) << "400 ms since the last word";
  led.live(1);
  EXPECT_FALSE(led.feel().holds);
}

TEST(Pointer, ARingThatIsNotHeldStaysAndAKeyIsFree) {
  // A force on the first axis; the second is the one that is held.
  for (const bool is_ring : {true, false}) {
    Led led({}, is_ring);
    for (int n = 0; n < 20; ++n) {
      led.say(true, 2, 0.0, 0.02);
      led.live(50, 1.0);
    }
    EXPECT_NEAR(led.sensed[1], 0.02, 1e-4);
    if (is_ring) {
      EXPECT_NEAR(led.sensed[0], 1.0 / kRingHand + 1.0 / kRingFinger, 1e-4);
    } else {
      EXPECT_GT(led.sensed[0], 0.07) << "1 N carries a free key of 50 g to its stop";
    }
  }
}

TEST(Pointer, SaysWhichTargetIsFelt) {
  Led led;
  led.say(true, 1, 0.0, 0.0);
  led.live(1);
  EXPECT_EQ(led.feel().felt_number, 0u) << "the sample of its period knows nothing of it";
  led.live(1);
  led.live(1);
  const PointerFeel feel = led.feel();
  EXPECT_EQ(feel.felt_number, 1u);
  EXPECT_GT(feel.felt_nsec, 0);
}

/// What may come instead of a place.
double wild_number(std::mt19937& lot) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array kOdd{kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN(), 1e300,
                            -1e300};
  if (lot() % 4 == 0) return kOdd[lot() % kOdd.size()];
  return std::uniform_real_distribution(-1.0, 1.0)(lot);
}

TEST(Pointer, ATargetThatIsNoNumberCountsAsSilence) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Led led;
  led.live_held(1000, 0.02, 0.0);
  const double before = led.sensed[0];
  for (int n = 0; n < 200; ++n) {
    led.say(true, 1, kNan, 0.0);
    led.live(1);
  }
  EXPECT_NEAR(led.sensed[0], before, 1e-6) << "the hand stays";
  EXPECT_TRUE(led.feel().holds);
  for (int n = 0; n < 350; ++n) {
    led.say(true, 1, 0.0, std::numeric_limits<double>::infinity());
    led.live(1);
  }
  EXPECT_FALSE(led.feel().holds);
}

TEST(Pointer, NoTargetMakesItsHandJumpWhateverThePageSays) {
  // Whatever a page says, the target keeps its speed limit, and so the springs of the hand their share
  // of it: the key gets no more speed than the limit and what its force gives it. While nothing holds a
  // key its target follows the key.
  const std::uint32_t seed = test::test_seed();
  std::mt19937 lot(seed);
  PointerSettings settings;
  settings.speed_limit_m_per_s = 0.5;
  for (int round = 0; round < 40; ++round) {
    Led led(settings, round % 2 == 0);
    double last = std::numeric_limits<double>::quiet_NaN();
    double sensed = 0.0;
    bool gripped_before = false;
    for (int n = 0; n < 400; ++n) {
      if (n > 200 || lot() % 16 == 0) {  // from there on a flood
        const double wild = wild_number(lot);
        led.say(lot() % 5 != 0, static_cast<std::uint32_t>(lot() % 4), wild, -wild);
      }
      led.live(1);
      const PointerFeel feel = led.feel();
      const bool is_gripped = feel.target_m[0] != feel.position_m[0];
      if (gripped_before && is_gripped && !std::isnan(last)) {
        ASSERT_LE(std::abs(feel.target_m[0] - last), 0.5 * kLedPeriod + 1e-12)
            << "seed " << seed << ", round " << round << ", period " << n;
      }
      ASSERT_LE(std::abs(led.sensed[0]), 0.09) << "seed " << seed;
      ASSERT_LE(std::abs(feel.target_m[0]), 0.08) << "seed " << seed;
      // Key and hand hang on the target by springs: they overshoot its speed, but not fourfold.
      ASSERT_LE(std::abs(led.sensed[0] - sensed), 4.0 * 0.5 * kLedPeriod) << "seed " << seed;
      sensed = led.sensed[0];
      last = feel.target_m[0];
      gripped_before = is_gripped;
    }
  }
}

TEST(Pointer, TheHandFadesWhenItIsLetGoAndWhenThePageIsGone) {
  // The spring of the hand carries 2 N. Let go, the force of the hand on the key falls by no more than
  // a share of 1 / 150 per millisecond, but for what the motion of key and hand changes.
  for (const bool page_is_gone : {false, true}) {
    Led led;
    led.live_held(3000, 0.03, 0.0, -2.0);
    if (page_is_gone) {
      led.live_held(100, 0.08, 0.0, -2.0);  // in mid-drag
      led.live_held(500, 0.03, 0.0, -2.0);
      while (led.feel().holds) led.live(1, -2.0);
    } else {
      led.say(false, 0, 0.0, 0.0);
    }
    const double before = led.sensed[0];
    double largest = 0.0;
    double last = before;
    for (int n = 0; n < 20; ++n) {
      led.live(1, -2.0);
      largest = std::max(largest, std::abs(led.sensed[0] - last));
      last = led.sensed[0];
    }
    // Without any hand 2 N would carry 50 g by 8 mm in 20 ms.
    EXPECT_LT(before - last, 0.001) << page_is_gone;
    EXPECT_LT(largest, 0.0002) << page_is_gone;
  }
}

TEST(Pointer, TheSameTargetsGiveTheSameBits) {
  const auto run = [] {
    Led led;
    std::vector<double> seen;
    for (int n = 0; n < 500; ++n) {
      if (n % 16 == 0) led.say(n < 400, 3, 0.0001 * n, -0.0001 * n);
      led.live(1, 0.5);
      seen.push_back(led.sensed[0]);
    }
    return seen;
  };
  const std::vector<double> once = run();
  EXPECT_EQ(once, run());
  EXPECT_GT(*std::ranges::max_element(once), 0.03);
}

constexpr std::uint32_t kDevice = 42;
constexpr std::int64_t kMsec = 1'000'000;

msg::PointerTarget said(std::uint64_t epoch, std::uint64_t number, bool holds = true) {
  msg::PointerTarget target;
  target.device_id(kDevice);
  target.epoch(epoch);
  target.sequence_number(number);
  target.holds(holds);
  target.coordinate_count(2);
  return target;
}

TEST(PointerChoice, FollowsOneHandAtATime) {
  PointerChoice choice(0.25);
  const auto accepts = [&](const msg::PointerTarget& target, std::int64_t msec) {
    return choice.accept(target, kDevice, 2, msec * kMsec);
  };
  EXPECT_FALSE(accepts(said(1, 1, /*holds=*/false), 0)) << "there is nothing to let go of";
  EXPECT_TRUE(accepts(said(1, 2), 0));
  EXPECT_FALSE(accepts(said(1, 2), 10)) << "twice";
  EXPECT_FALSE(accepts(said(2, 1), 100)) << "another viz_node";
  EXPECT_TRUE(accepts(said(1, 3, /*holds=*/false), 200));
  EXPECT_TRUE(accepts(said(2, 2), 210)) << "the first has let go";
  EXPECT_FALSE(accepts(said(1, 4), 400));
  EXPECT_TRUE(accepts(said(1, 5), 461)) << "the second is silent";
}

TEST(PointerChoice, RefusesWhatIsNotForItOrNoNumber) {
  PointerChoice choice(0.25);
  msg::PointerTarget other = said(1, 1);
  other.device_id(kDevice + 1);
  msg::PointerTarget short_one = said(1, 1);
  short_one.coordinate_count(1);
  msg::PointerTarget wild = said(1, 1);
  wild.target_m()[1] = std::numeric_limits<double>::quiet_NaN();
  for (const msg::PointerTarget& target : {other, short_one, wild, said(0, 1)})
    EXPECT_FALSE(choice.accept(target, kDevice, 2, 0));
}

}  // namespace
}  // namespace cordis::device
