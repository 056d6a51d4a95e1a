// tests/sim/settling_test.cpp -- scenes that are at rest when they start.
#include "sim_node/checks/settling.h"

#include <cmath>
#include <memory>
#include <string>

#include "sim_node/engine/world.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/filled.h"

namespace cordis::sim {
namespace {

std::string chain(const std::string& settle, const std::string& ends = "first_fixed") {
  return test::filled(R"(cordis: 1
space: 2
step: {rate_hz: 1000}
<settle>
world: {gravity_m_per_s2: [0, -10]}
matter:
  chain: {kind: string, count: 5, from_m: [0, 0], to_m: [0, -0.4], ends: <ends>, mass_kg: 0.01,
          stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.01,
          velocity_m_per_s: [1, 0]}
)",
                      {{"settle", settle}, {"ends", ends}});
}

scene::Scene scene_at_rest(const std::string& text, config::Problems& problems) {
  scene::Scene scene = scene::load_scene_text(text, "t", problems);
  if (!problems.has_errors()) settle(scene, problems);
  return scene;
}

TEST(Settling, MovesTheStartOfTheScene) {
  config::Problems problems;
  const scene::Scene scene = scene_at_rest(chain("settle: {until_n: 1.0e-9}"), problems);

  ASSERT_EQ(problems.text(), "");
  // the four links carry 4, 3, 2 and 1 weights of 0.1 N
  EXPECT_NEAR(scene.network.mats[4].position.y(), -0.4 - 0.001 * (4 + 3 + 2 + 1), 1e-9);
  EXPECT_EQ(scene.network.mats[4].velocity, engine::Vec3(1, 0, 0));
  EXPECT_DOUBLE_EQ(scene.network.links[0].rest_length, 0.1);
  ASSERT_TRUE(scene.settled);
  EXPECT_EQ(scene.settled->mat, 4u);
  EXPECT_NEAR(scene.settled->way, 0.01, 1e-9);
  EXPECT_EQ(settled_text(scene).find("in "), 0u);
  EXPECT_NE(settled_text(scene).find("; chain[4] moved the farthest, 0.01 m"), std::string::npos);
}

/// A block on a slope, pressed to where it floats.
std::string block_on_a_slope(double tangent, const std::string& more = "") {
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
  const double depth = 0.02 - 0.1 * 10.0 * cosine / 5000.0;
  return test::filled(R"(cordis: 1
space: 2
step: {rate_hz: 20000}
settle: {until_n: 1.0e-10<more>}
world: {gravity_m_per_s2: [0, -10]}
matter:
  slope: {kind: plane, at_m: [0, 0], normal: [<nx>, <ny>]}
  block: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.02}, at_m: [<x>, <y>]}
liaisons:
  rub: {stiffness_n_per_m: 5000, viscosity_n_s_per_m: 10, pulls: false, range: rest,
        friction: {static: 0.5, kinetic: 0.5, stiffness_n_per_m: 5000, viscosity_n_s_per_m: 40}}
links: [{liaison: rub, between_sets: [block, slope]}]
)",
                      {{"more", more},
                       {"nx", std::to_string(-tangent * cosine)},
                       {"ny", std::to_string(cosine)},
                       {"x", std::to_string(-tangent * cosine * depth)},
                       {"y", std::to_string(cosine * depth)}});
}

TEST(Settling, LetsFrictionHoldWhatItCan) {
  config::Problems problems;
  const scene::Scene scene = scene_at_rest(block_on_a_slope(0.49), problems);

  ASSERT_EQ(problems.text(), "");
  ASSERT_EQ(scene.network.sets[0].stretches.size(), 1u);
  const double along = 0.1 * 10.0 * 0.49 / std::sqrt(1.0 + 0.49 * 0.49);
  EXPECT_NEAR(scene.network.sets[0].stretches[0].stretch.norm(), along / 5000.0, 1e-9);
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  for (int n = 0; n < 100'000; ++n) world.step();
  const std::uint32_t block = scene.network.sets[0].set_q[0];
  EXPECT_LT((world.position(block) - scene.network.mats[block].position).norm(), 1e-9);

  scene::Scene other = scene::load_scene_text(block_on_a_slope(0.49), "t", problems);
  keep_settled(scene, other);
  EXPECT_EQ(engine::Network(other.network).fingerprint(),
            engine::Network(scene.network).fingerprint());
  other.network.state_machines[0].friction = {};
  other.network.sets[0].stretches.clear();
  keep_settled(scene, other);
  EXPECT_TRUE(other.network.sets[0].stretches.empty());
}

TEST(Settling, SaysWhatSlides) {
  config::Problems problems;
  scene_at_rest(block_on_a_slope(0.51), problems);
  EXPECT_NE(problems.text().find("the scene has not come to rest in 200001 steps: "),
            std::string::npos)
      << problems.text();
  EXPECT_NE(problems.text().find(" N pull block, which slides on slope\n"), std::string::npos)
      << problems.text();
  EXPECT_NE(problems.text().find("hint: let friction hold block, fix it, or write an until_n"),
            std::string::npos)
      << problems.text();

  config::Problems smooth;
  scene_at_rest(block_on_a_slope(0.1, ", friction: false, steps: 500"), smooth);
  EXPECT_NE(smooth.text().find(" N pull block\n"), std::string::npos) << smooth.text();
}

TEST(Settling, IsNothingUnlessAsked) {
  config::Problems problems;
  const scene::Scene scene = scene_at_rest(chain(""), problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_DOUBLE_EQ(scene.network.mats[4].position.y(), -0.4);
  EXPECT_EQ(settled_text(scene), "");
}

TEST(Settling, RefusesWhatDoesNotComeToRest) {
  config::Problems problems;
  scene_at_rest(chain("settle: {until_n: 1.0e-9, steps: 50}", "free"), problems);

  EXPECT_EQ(problems.text(),
            R"(t:4:9: error: the scene has not come to rest in 51 steps: 0.1 N pull chain[0]
settle: {until_n: 1.0e-9, steps: 50}
        ^
  hint: nothing holds chain[0]: it falls. Give it a liaison or a surface to rest on, or fix it; write more steps if it still falls onto one)");
}

TEST(Settling, SaysThatMoreStepsHelp) {
  config::Problems few;
  scene_at_rest(chain("settle: {until_n: 1.0e-9, steps: 60}"), few);
  EXPECT_NE(few.text().find("hint: it comes nearer to rest: write more steps, or write an until_n"),
            std::string::npos)
      << few.text();

  config::Problems enough;
  scene_at_rest(chain("settle: {until_n: 1.0e-9, steps: 6000}"), enough);
  EXPECT_EQ(enough.text(), "");
}

TEST(Settling, TellsWhatRoundingKeepsFromRest) {
  config::Problems problems;
  scene_at_rest(chain("settle: {until_n: 1.0e-19}"), problems);

  EXPECT_NE(problems.text().find("the scene comes no nearer to rest than "), std::string::npos)
      << problems.text();
  EXPECT_NE(problems.text().find("hint: positions are rounded: write an until_n of "),
            std::string::npos);
}

/// A ball on a plane: its weight is held by 5e-4 m of the contact.
std::string ball_on_a_plane(const std::string& settle, const std::string& friction = {}) {
  return test::filled(R"(cordis: 1
space: 2
step: {rate_hz: 20000}
<settle>
world: {gravity_m_per_s2: [0, -9.81]}
matter:
  floor: {kind: plane, at_m: [0, 3], normal: y}
  b: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.05}, at_m: [-4, 3.05]}
liaisons:
  land: {stiffness_n_per_m: 3000, viscosity_n_s_per_m: 1, pulls: false, range: rest<friction>}
links: [{liaison: land, between_sets: [b, floor]}]
)",
                      {{"settle", settle}, {"friction", friction}});
}

TEST(Settling, EndsWhereRoundingStopsAllMotion) {
  for (const char* const friction :
       {"", ", friction: {static: 0.5, stiffness_n_per_m: 3000, viscosity_n_s_per_m: 5}"}) {
    config::Problems problems;
    scene_at_rest(ball_on_a_plane("settle: {until_n: 1.0e-20}", friction), problems);

    const std::string text = problems.text();
    EXPECT_NE(text.find("the scene comes no nearer to rest than "), std::string::npos) << text;
    const std::string hint = "hint: positions are rounded: write an until_n of ";
    const std::size_t begin = text.find(hint);
    ASSERT_NE(begin, std::string::npos) << text;
    const std::string reached =
        text.substr(begin + hint.size(), text.find(" or more") - begin - hint.size());
    config::Problems none;
    scene_at_rest(ball_on_a_plane("settle: {until_n: " + reached + "}", friction), none);
    EXPECT_EQ(none.text(), "");
  }
}

TEST(Settling, ComesAsNearToRestAsRoundingLets) {
  for (const char* const until : {"1.0e-10", "1.0e-11"}) {
    config::Problems problems;
    const scene::Scene scene =
        scene_at_rest(ball_on_a_plane(std::string("settle: {until_n: ") + until + "}"), problems);
    EXPECT_EQ(problems.text(), "");
    ASSERT_TRUE(scene.settled);
    EXPECT_LT(scene.settled->steps, 20'000u) << until;
  }
}

TEST(Settling, SaysThatNothingHoldsWhatFalls) {
  config::Problems problems;
  scene_at_rest(R"(cordis: 1
space: 2
step: {rate_hz: 1000}
settle: {until_n: 1.0e-6}
world: {gravity_m_per_s2: [0, -9.81]}
matter:
  b: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.05}, at_m: [0, 0.1]}
)",
                problems);
  EXPECT_NE(problems.text().find("0.981 N pull b\n"), std::string::npos) << problems.text();
  EXPECT_NE(
      problems.text().find(
          "hint: nothing holds b: it falls. Give it a liaison or a surface to rest on, or fix it; "
          "write more steps if it still falls onto one"),
      std::string::npos)
      << problems.text();
}

TEST(Settling, ReadsItsKeys) {
  config::Problems problems;
  scene_at_rest(chain("settle: {until_n: 0, steps: 0, until: 3}"), problems);

  EXPECT_NE(problems.text().find("t:4:19: error: 'until_n' in settle must be > 0, got 0"),
            std::string::npos)
      << problems.text();
  EXPECT_NE(problems.text().find("t:4:29: error: 'steps' in settle"), std::string::npos);
  EXPECT_NE(problems.text().find("t:4:32: error: unknown key 'until'"), std::string::npos);
}

}  // namespace
}  // namespace cordis::sim
