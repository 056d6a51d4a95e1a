// tests/sim/limit_watch_test.cpp
#include "sim_node/checks/limit_watch.h"

#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/run/bound_text.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/filled.h"
#include "tests/support/watched_scenes.h"

namespace cordis::sim {
namespace {

/// A key that moves nothing of it.
const char* const kKey = R"(ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 1}
)";

TEST(LimitWatch, KeepsTheLargestThatAMassHasHad) {
  const auto loaded = loaded_scene_of(test::snatch("20000"));
  Simulation& simulation = loaded->simulation;
  EventRoom events(1);
  loaded->limits.update(simulation.world());
  EXPECT_NEAR(loaded->limits.largest(), 2.0 * 1e-3 / 0.1, 1e-12);  // 2 Z dt / m

  for (int tick = 0; tick < 5; ++tick) simulation.advance(1, events);
  ASSERT_EQ(simulation.world().state_of(0), 1u);
  loaded->limits.update(simulation.world());
  EXPECT_NEAR(loaded->limits.largest(), 2e4 * 1e-6 / 0.1, 1e-12);  // K dt^2 / m
}

TEST(LimitWatch, CountsTheNeighboursThatABallOfASetMayHave) {
  const auto loaded = loaded_scene_of(
      R"(cordis: 1
name: row
space: 1
step: {rate_hz: 1000}
liaisons: {touch: {states: {on: {stiffness_n_per_m: 3000, viscosity_n_s_per_m: 1, pulls: false, final: true}}}}
matter:
  balls: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.01}, at_m: [0, 0.03, 0.06]}
links:
  - {liaison: touch, within: balls, rest: radii, range_m: 0.02}
)");
  loaded->limits.update(loaded->simulation.world());
  const double one = 3000.0 * 1e-6 + 2.0 * 1e-3;                        // K dt^2 + 2 Z dt
  EXPECT_NEAR(loaded->limits.largest(), 2.0 * 2.0 * one / 0.1, 1e-12);  // one on each side
}

TEST(LimitWatch, LetsGoWhereTheNumberComesToFour) {
  // taut: K dt^2 / m = 4.1, by a state that nothing has entered at the start
  for (const bool has_key : {false, true}) {
    const auto loaded = loaded_scene_of(test::snatch("410000") + (has_key ? kKey : ""));
    Simulation& simulation = loaded->simulation;
    EXPECT_FALSE(loaded->is_certain);
    EXPECT_TRUE(loaded->watches_number);
    EventRoom events(1);
    while (simulation.world().state_of(0) == 0u) {
      EXPECT_EQ(loaded->passed_bound({}), PassedBound::kNone);
      ASSERT_TRUE(simulation.advance(1, events));
    }

    const PassedBound bound = loaded->passed_bound({});
    EXPECT_EQ(bound, PassedBound::kNumber);
    EXPECT_NEAR(loaded->limits.largest(), 4.1, 1e-9);
    simulation.let_devices_go(bound);
    EXPECT_EQ(bound_text(*loaded),
              std::string(has_key ? "has let go of the devices: " : "") +
                  "K' + 2 Z' came to 4, from where on the scene may be unstable");
  }
}

TEST(LimitWatch, LeavesASceneAloneWhoseNumberStaysBelowFour) {
  const auto loaded = loaded_scene_of(test::snatch("390000"));  // K dt^2 / m = 3.9
  EventRoom events(1);
  for (int tick = 0; tick < 100; ++tick) {
    ASSERT_TRUE(loaded->simulation.advance(1, events));
    EXPECT_EQ(loaded->passed_bound({}), PassedBound::kNone);
  }
  EXPECT_EQ(loaded->simulation.world().state_of(0), 1u);
}

TEST(LimitWatch, StaysBelowFourWhereTheStepIsCertified) {
  // Five equal masses between walls: 2 - 2 cos(5 pi / 6) = 3.73 of 4 K dt^2 / m.
  const auto row = [](const std::string& stiffness) {
    const auto loaded = loaded_scene_of(
        R"(cordis: 1
name: row
space: 1
step: {rate_hz: 1000}
liaisons: {s: {kind: spring, stiffness_n_per_m: )" +
        stiffness +
        R"(, rest_m: 0}}
matter:
  wall: {kind: fixed, at_m: [0, 0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: [0, 0, 0, 0, 0]}
links:
  - {liaison: s, between: ["wall[0]", "bob[0]"]}
  - {liaison: s, between: ["wall[1]", "bob[4]"]}
  - {liaison: s, between: ["bob[0..3]", "bob[1..4]"]}
)");
    loaded->limits.update(loaded->simulation.world());
    return loaded->limits.largest();
  };
  const double exact = 2.0 - 2.0 * std::cos(5.0 * M_PI / 6.0);
  EXPECT_GE(row("100000"), exact - 1e-9);
  EXPECT_LT(row("100000"), exact + 0.1);
}

/// Balls that lie apart, of the stiffness given, and one of them on a rope that is slack.
std::string loose_balls(const std::string& touch, const std::string& rope) {
  return test::filled(R"(cordis: 1
name: loose
space: 2
step: {rate_hz: 1000}
liaisons:
  touch: {states: {on: {stiffness_n_per_m: <touch>, viscosity_n_s_per_m: 1, pulls: false, final: true}}}
  rope:
    start: slack
    states:
      slack: {viscosity_n_s_per_m: 0.01, exits: [{to: taut, when: "elongation_m > 1"}]}
      taut: {stiffness_n_per_m: <rope>, final: true}
matter:
  balls: {kind: pack, count: 40, seed: 5, region: {from_m: [-0.1, 0], to_m: [0.1, 0.2]}, ball: {mass_kg: 0.1, radius_m: 0.01}}
  bob: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.01}, at_m: [0.5, 0.5]}
  wall: {kind: fixed, at_m: [-0.5, 0]}
links:
  - {liaison: touch, within: [balls, bob], rest: radii, range_m: 0.02}
  - {liaison: rope, between: [wall, bob]}
)",
                      {{"touch", touch}, {"rope", rope}});
}

TEST(LimitWatch, IsANumberOfTheLiaisonsThatActWhereNothingIsCertified) {
  const auto largest_of = [](const std::string& touch, const std::string& rope) {
    config::Problems problems;
    auto scene = std::make_shared<scene::Scene>(
        scene::load_scene_text(loose_balls(touch, rope), "t", problems));
    LoadedScene loaded(scene, kEpochOfSim, 1);
    loaded.limits.update(loaded.simulation.world());
    return loaded.limits.largest();
  };
  // A ball counts with as many others as lie around it in a plane, 6, each as 2 (K dt^2 + 2 Z dt) / m.
  const auto of_balls = [](double stiffness) {
    return 6.0 * 2.0 * (stiffness * 1e-6 + 2.0 * 1e-3) / 0.1;
  };
  const double of_slack_rope = 2.0 * 0.01 * 1e-3 / 0.1;

  const double stiff_balls = largest_of("1e9", "10");
  EXPECT_NEAR(stiff_balls, of_balls(1e9), 1.0);
  const double stiff_rope = largest_of("3000", "1e9");
  EXPECT_NEAR(stiff_rope, of_balls(3000.0) + of_slack_rope, 1e-9) << "the rope is slack";
}

TEST(Divergence, IsReportedWithTheLinkAndTheReason) {
  const auto loaded = loaded_scene_of(test::snatch("900000"));
  Simulation& simulation = loaded->simulation;
  EventRoom events(1);
  EXPECT_EQ(simulation.failure(), "");
  for (int tick = 0; tick < 2000 && !simulation.failed(); ++tick) simulation.advance(1, events);

  ASSERT_TRUE(simulation.failed());
  const std::string message = simulation.failure();
  EXPECT_NE(message.find("its energy is no finite number below 1e100 J; the fastest is 'bob'"),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("too stiff for 1000 Hz (K' + 2 Z' = 9.02 of 4)"), std::string::npos)
      << message;
  EXPECT_NE(message.find("rope (t:14)"), std::string::npos) << message;
}

}  // namespace
}  // namespace cordis::sim
