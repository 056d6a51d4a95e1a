// tests/sim/tick_division_test.cpp -- steps in gesture periods that they do not fit into.
#include "sim_node/run/tick_division.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/sim/loaded_scenes.h"
#include "tests/support/filled.h"

namespace cordis::sim {
namespace {

TEST(TickDivision, OfAnIntegerRatioAllTicksAreAlike) {
  TickDivision division(4000.0, 1000.0);
  EXPECT_TRUE(division.is_even());
  for (int tick = 0; tick < 3; ++tick, division.next()) {
    ASSERT_EQ(division.steps(), 4);
    for (int j = 1; j <= 4; ++j) EXPECT_EQ(division.share(j), j / 4.0);
  }
}

TEST(TickDivision, StepsLieInTheirTicksAndTheirCountIsExact) {
  struct Case {
    double step_hz, gesture_hz;
    std::int64_t ticks, steps;  // so many ticks have exactly so many steps
  };
  for (const Case& c : {Case{44100, 1000, 10'000, 441'000}, Case{22050, 1000, 20, 441},
                        Case{48000, 1100, 11, 480}, Case{44100, 3000, 10, 147},
                        Case{1000.5, 1000, 2000, 2001}, Case{1000, 999.9, 9999, 10'000}}) {
    TickDivision division(c.step_hz, c.gesture_hz);
    std::int64_t step = 0;
    std::set<int> counts;
    for (std::int64_t tick = 0; tick < c.ticks; ++tick, division.next()) {
      counts.insert(division.steps());
      for (int j = 1; j <= division.steps(); ++j) {
        ++step;
        const double share = division.share(j);
        EXPECT_GT(share, 0.0);
        EXPECT_LE(share, 1.0);
        const double exact =
            static_cast<double>(step) * c.gesture_hz / c.step_hz - static_cast<double>(tick);
        EXPECT_NEAR(share, exact, 4e-16 * static_cast<double>(tick + 2));
      }
    }
    EXPECT_EQ(step, c.steps) << c.step_hz;
    EXPECT_LE(counts.size(), 2u);
    EXPECT_EQ(division.share(division.steps()) == 1.0, division.is_even());
  }
}

TEST(TickDivision, GoesToAnyTickAsByCounting) {
  const std::pair<double, double> rates[] = {{44100, 1000}, {4000, 1000},   {48000, 1100},
                                             {1000, 999.9}, {1000.5, 1000}, {96000, 96000}};
  for (const auto& [step_hz, gesture_hz] : rates) {
    TickDivision counted(step_hz, gesture_hz);
    std::uint64_t step = 0;
    for (std::uint64_t tick = 0; tick < 3000; ++tick) {
      TickDivision division(step_hz, gesture_hz);
      EXPECT_EQ(division.go_behind(step), tick) << step_hz << " of step " << step;
      ASSERT_EQ(division.steps(), counted.steps());
      EXPECT_EQ(division.share(1), counted.share(1));
      for (int j = 1; j < counted.steps(); ++j)
        EXPECT_EQ(TickDivision(step_hz, gesture_hz).go_behind(step + static_cast<std::uint64_t>(j)),
                  std::nullopt);
      step += static_cast<std::uint64_t>(counted.steps());
      counted.next();
    }
  }
}

/// A key alone on a spring, and its position as a signal of each step.
std::string key_text(double step_rate_hz) {
  return test::filled(R"(cordis: 1
name: key
space: 1
step: {rate_hz: <step_rate_hz>}
liaisons: {spring: {kind: spring_damper, stiffness_n_per_m: 1, viscosity_n_s_per_m: 0}}
matter: {bob: {kind: mass, mass_kg: 1, at_m: 0}}
ports: {key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 0}}
links: [{liaison: spring, between: [key, bob], rest_m: 0}]
signals:
  bob: {of: bob, quantity: position}
  key: {of: key, quantity: position, rate: step}
)",
                      {{"step_rate_hz", std::to_string(step_rate_hz)}});
}

/// The largest distance of a key from the straight line v t that its samples lie on, once it is
/// taken over; over ten seconds.
double largest_distance(double step_rate_hz, std::uint64_t& steps) {
  constexpr double kSpeed = 0.01;  // [m/s]
  const auto loaded = loaded_scene_of(key_text(step_rate_hz));
  Simulation& simulation = loaded->simulation;
  EventRoom events(0);
  double largest = 0.0;
  for (std::uint64_t tick = 1; tick <= 10'000; ++tick) {
    simulation.devices()[0].receive(key_sample(tick, kSpeed * static_cast<double>(tick) / 1000.0));
    loaded->step_rows.clear();
    EXPECT_TRUE(simulation.advance(simulation.steps_left_in_tick(), events, &loaded->step_rows));
    for (std::size_t r = 0; tick > 200 && r < loaded->step_rows.count(); ++r) {
      const auto step = static_cast<double>(loaded->step_rows.first_step() + r);
      largest =
          std::max(largest, std::abs(*loaded->step_rows.row(r) - kSpeed * step / step_rate_hz));
    }
  }
  steps = simulation.world().step_count();
  return largest;
}

TEST(TickDivision, APortOnAStraightLineIsThereAtEveryStep) {
  for (const double rate : {44'100.0, 22'050.0, 4000.0, 1000.5}) {
    std::uint64_t steps = 0;
    EXPECT_LT(largest_distance(rate, steps), 1e-15) << rate;
    EXPECT_EQ(steps, static_cast<std::uint64_t>(10.0 * rate));
  }
}

TEST(TickDivision, AScenePlayedInOtherPortionsIsTheSame) {
  std::vector<std::uint64_t> hashes;
  for (const int portion : {1, 7, 100}) {
    const auto loaded = loaded_scene_of(key_text(44'100.0));
    EventRoom events(0);
    for (std::uint64_t tick = 1; tick <= 1000; ++tick) {
      loaded->simulation.devices()[0].receive(
          key_sample(tick, 0.01 * std::sin(0.01 * static_cast<double>(tick))));
      while (!loaded->simulation.advance(portion, events)) {
      }
    }
    EXPECT_EQ(loaded->simulation.world().step_count(), 44'100u);
    hashes.push_back(loaded->simulation.world().state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace cordis::sim
