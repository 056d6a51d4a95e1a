// tests/scene/bend_test.cpp -- how a scene says that matter resists bending.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/scene/parameters.h"
#include "tests/scene/bad_scene.h"
#include "tests/support/filled.h"

namespace cordis::scene {
namespace {

using Triples = std::vector<std::array<std::uint32_t, 3>>;

constexpr const char* kScene = R"(liaisons:
  steel: {kind: bending, stiffness_n_m_per_rad: 0.02, viscosity_n_m_s_per_rad: 1.0e-4}
  bent: {like: steel, rest_rad: 0.5, length_m: 0.3}
matter:
  clamp: {kind: fixed, at_m: [-0.1, 0]}
  rod: {kind: string, count: 5, mass_kg: 0.01, from_m: [0, 0], to_m: [0.4, 0], stiffness_n_per_m: 100}
  net: {kind: grid, rows: 3, columns: 4, mass_kg: 0.01, corner_m: [0, 1], spacing_m: [0.1, 0.2], stiffness_n_per_m: 100}
  loop: {kind: ring, count: 5, mass_kg: 0.01, center_m: [0, 3], radius_m: 0.1, stiffness_n_per_m: 100}
links:
)";

std::vector<engine::Bend> bends_of(const std::string& link) {
  return sound_scene(2, kScene + ("  - " + link) + "\n").network.bends;
}

Triples triples_of(const std::string& link) {
  Triples triples;
  for (const engine::Bend& bend : bends_of(link))
    triples.push_back({bend.mat_a, bend.mat_b, bend.mat_c});
  return triples;
}

TEST(Bends, GoAlongAString) {
  const std::vector<engine::Bend> bends = bends_of("{liaison: steel, along: rod}");

  EXPECT_EQ(triples_of("{liaison: steel, along: rod}"), (Triples{{1, 2, 3}, {2, 3, 4}, {3, 4, 5}}));
  EXPECT_EQ(bends[0].stiffness, 0.02);
  EXPECT_EQ(bends[0].viscosity, 1e-4);
  EXPECT_EQ(bends[0].rest_angle, 0.0);
  EXPECT_NEAR(bends[0].length_ab, 0.1, 1e-15);
}

TEST(Bends, GoAlongAPartOfIt) {
  EXPECT_EQ(triples_of("{liaison: steel, along: \"rod[1..3]\"}"), (Triples{{2, 3, 4}}));
}

TEST(Bends, GoAlongTheRowsAndColumnsOfAGrid) {
  const Triples triples = triples_of("{liaison: steel, along: net}");

  ASSERT_EQ(triples.size(), 3u * 2u + 4u * 1u);
  EXPECT_EQ(triples[0], (std::array<std::uint32_t, 3>{6, 7, 8}));
  EXPECT_EQ(triples[6], (std::array<std::uint32_t, 3>{6, 10, 14}));
  const std::vector<engine::Bend> bends = bends_of("{liaison: steel, along: net}");
  EXPECT_NEAR(bends[0].length_ab, 0.1, 1e-15);
  EXPECT_NEAR(bends[6].length_bc, 0.2, 1e-15);
}

TEST(Bends, GoAroundARing) {
  EXPECT_EQ(triples_of("{liaison: steel, along: loop}"),
            (Triples{{18, 19, 20}, {19, 20, 21}, {20, 21, 22}, {21, 22, 18}, {22, 18, 19}}));
}

TEST(Bends, AreBetweenThreeEnds) {
  const std::vector<engine::Bend> bends = bends_of(
      "{liaison: bent, between: [clamp, \"rod[0]\", \"rod[1]\"], stiffness_n_m_per_rad: 2}");

  ASSERT_EQ(bends.size(), 1u);
  EXPECT_EQ(bends[0].mat_a, 0u);
  EXPECT_EQ(bends[0].mat_b, 1u);
  EXPECT_EQ(bends[0].mat_c, 2u);
  EXPECT_EQ(bends[0].stiffness, 2.0);
  EXPECT_EQ(bends[0].rest_angle, 0.5);
  EXPECT_EQ(bends[0].length_ab, 0.3);
  EXPECT_EQ(triples_of("{liaison: steel, between: [\"rod[0..1]\", \"rod[2..3]\", clamp]}"),
            (Triples{{1, 3, 0}, {2, 4, 0}}));
}

TEST(Bends, CountTheirMatsInEachCopyOfAPart) {
  const Scene scene = sound_scene(1, R"(parts:
  reed:
    matter: {tongue: {kind: string, count: 3, mass_kg: 0.01, stiffness_n_per_m: 0}}
    links: [{liaison: steel, along: tongue}]
liaisons:
  steel: {kind: bending, stiffness_n_m_per_rad: b_n_m, length_m: 0.01, parameters: {b_n_m: 0.5}}
matter:
  reeds: {part: reed, repeat: {count: 2, translate_m: 0}}
)");

  ASSERT_EQ(scene.network.bends.size(), 2u);
  EXPECT_EQ(scene.network.bends[1].mat_a, 3u);
  EXPECT_EQ(scene.network.bends[1].length_bc, 0.01);
  EXPECT_EQ(scene.network.bends[1].stiffness, 0.5);
  EXPECT_EQ(scene.bends[1].name, "reeds[1].steel");
}

/// Each copy looks for its own lines alone: those of 20,000 copies take no time of each other.
TEST(Bends, GoAlongTheLinesOfEachOfManyCopies) {
  const Scene scene = sound_scene(1, R"(parts:
  reed:
    matter:
      post: {kind: fixed, at_m: 0}
      tongue: {kind: string, count: 4, mass_kg: 0.01, stiffness_n_per_m: 0}
      tip: {kind: mass, mass_kg: 1, at_m: 0}
      net: {kind: grid, rows: 3, columns: 2, ball: {mass_kg: 0.001, radius_m: 0.001}, stiffness_n_per_m: 0, layout_spacing_m: 0.01}
    links:
      - {liaison: steel, along: tongue}
      - {liaison: steel, along: "net[0..4]"}
liaisons:
  steel: {kind: bending, stiffness_n_m_per_rad: 1, length_m: 0.01}
matter:
  reeds: {part: reed, repeat: {count: 20000, translate_m: 0}}
)");

  ASSERT_EQ(scene.network.bends.size(), 3u * 20000);
  for (std::uint32_t copy = 0; copy < 20000; ++copy) {
    const std::uint32_t first = 12 * copy;
    ASSERT_EQ(scene.network.bends[3 * copy].mat_a, first + 1) << copy;
    ASSERT_EQ(scene.network.bends[3 * copy + 1].mat_a, first + 2) << copy;
    ASSERT_EQ(scene.network.bends[3 * copy + 2].mat_a, first + 6) << copy;
    ASSERT_EQ(scene.network.bends[3 * copy + 2].mat_b, first + 8) << copy;
  }
}

TEST(Bends, OfARingWithTheAngleOfItsCornersAreAtRest) {
  const double corner = 2.0 * std::numbers::pi / 8.0;
  const Scene scene = sound_scene(
      2, test::filled(
             R"(liaisons: {hoop: {kind: bending, stiffness_n_m_per_rad: 1, rest_rad: <corner>}}
matter: {loop: {kind: ring, count: 8, mass_kg: 1, center_m: [0, 0], radius_m: 1,
                stiffness_n_per_m: 1}}
links: [{liaison: hoop, along: loop}]
)",
             {{"corner", config::number_text(corner)}}));
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  world.step();
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_LT(world.link_force(i).norm(), 1e-12);
}

class BadBends : public BadScenes {};

TEST_P(BadBends, HaveOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

constexpr const char* kSteel =
    R"(liaisons: {steel: {kind: bending, stiffness_n_m_per_rad: 1},
           s: {kind: spring, stiffness_n_per_m: 1}}
matter: {a: {kind: points, mass_kg: 1, at_m: [[0, 0], [1, 0], [2, 0], [2, 0]]},
         one: {kind: mass, mass_kg: 1, at_m: [5, 5]},
         floor: {kind: plane, at_m: [0, -9], normal: y}}
)";

INSTANTIATE_TEST_SUITE_P(
    Bends, BadBends,
    testing::Values(
        BadScene{kHead2,
                 R"(liaisons: {b: ^{kind: bending}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "missing key 'stiffness_n_m_per_rad' in liaison 'b'", ""},
        BadScene{kHead2,
                 R"(liaisons: {b: {kind: bending, states: ^{}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'states' in liaison 'b' must not be empty", ""},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, stiffness_n_m_per_rad: ^1, states: {whole: {final: true}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "each state of liaison 'b' has its own 'stiffness_n_m_per_rad'",
            "write it in the states"},
        BadScene{kHead2,
                 R"(liaisons: {b: {kind: bending, elasticity: "2 * ^angle_rad"}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "elasticity of liaison 'b' cannot ask for 'angle_rad'",
                 "it may ask for bend_rad, the angle beyond the rest angle, and speed_rad_per_s"},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, states: {on: {elasticity: "2 * ^elongation_m", final: true}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "elasticity of state 'on' of liaison 'b' cannot ask for 'elongation_m'",
            "it may ask for bend_rad, the angle beyond the rest angle, and speed_rad_per_s"},
        BadScene{kHead2,
                 R"(liaisons: {b: {kind: bending, elasticity: ^bend_rad + abs(bend_rad)}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'elasticity' in liaison 'b' must act alike both ways in 2 dimensions, got 2 N m "
                 "at 1 rad and 0 N m the other way",
                 "as max(bend_rad - 0.5, 0) + min(bend_rad + 0.5, 0) does; a table has its points "
                 "below 0 "
                 "too"},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, stiffness_n_m_per_rad: 1, dissipation: ^speed_rad_per_s^2}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "'dissipation' in liaison 'b' must act alike both ways in 2 dimensions, got 1 N m "
            "at 1 rad/s and 1 N m the other way",
            "as speed_rad_per_s * abs(speed_rad_per_s) does"},
        BadScene{
            kHead3,
            R"(liaisons: {b: {kind: bending, elasticity: ^bend_rad + 0.5}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0, 0]}}
)",
            "'elasticity' in liaison 'b' must be 0 where the bend is 0, got a moment of 0.5 N m",
            "in 3 dimensions a straight bend has no direction"},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, elasticity: {kind: table, at_rad: [-1, 0, 1], moment_n_m: ^[-1, 1]}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "'moment_n_m' in elasticity of liaison 'b' must have one number for each of 'at_rad', "
            "3, got 2",
            ""},
        BadScene{kHead2,
                 R"(liaisons: {b: {kind: bending, elasticity: {kind: ^rings, rings: []}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'kind' in elasticity of liaison 'b' must be one of table, power, got 'rings'",
                 ""},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, stiffness_n_m_per_rad: ^time_s, elasticity: 2 * bend_rad}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "'stiffness_n_m_per_rad' in liaison 'b' changes, and stands beside 'elasticity'",
            "write it there: its formula times sin(bend_rad)"},
        BadScene{kHead2,
                 R"(liaisons: {b: {kind: bending, stiffness_n_m_per_rad: 1, force_limit_n: ^2}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "a bending liaison has no 'force_limit_n'",
                 "limit its moment in an elasticity: max(-0.5, min(0.5, 2 * bend_rad))"},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, elasticity: ^2 * bend_rad, states: {on: {final: true}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "each state of liaison 'b' has its own 'elasticity'", "write it in the states"},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, states: {whole: {exits: [{to: whole, when: ^elongation_m > 1}]}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "'when' in exit of state 'whole' of liaison 'b' names 'elongation_m', which is no "
            "quantity and no parameter",
            "a bend has angle_rad, bend_rad, speed_rad_per_s, moment_n_m, rest_rad, age_s"},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, states: {whole: {exits: [{to: whole, when: ^angel_rad > 1}]}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "'when' in exit of state 'whole' of liaison 'b' names 'angel_rad', which is no "
            "quantity and no parameter",
            "did you mean 'angle_rad'?"},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, states: {whole: {^stiffness_n_per_m: 1, final: true}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "unknown key 'stiffness_n_per_m' in state 'whole' of liaison 'b'",
            "did you mean 'stiffness_n_m_per_rad'?"},
        BadScene{
            kHead2,
            R"(liaisons: {b: {kind: bending, states: {whole: {final: true}, ^cut: {final: true}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
            "state 'cut' of liaison 'b' cannot be reached from its start, 'whole'",
            "give 'whole' the exit {to: cut, when: ...}"},
        BadScene{kHead2,
                 R"(liaisons: {b: {kind: bending, states: {whole: {rest_rad: ^9, final: true}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'rest_rad' in state 'whole' of liaison 'b' must be between -3.2 and 3.2, got 9",
                 ""},
        BadScene{
            kHead3,
            R"(liaisons: {b: {kind: bending, states: {whole: {exits: [{to: whole, when: angle_rad > 1, rest: ^here}]}}}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0, 0]}}
)",
            "in 3 dimensions a bend has no sign, so its rest stays straight", "leave 'rest' out"},
        BadScene{kHead3,
                 R"(liaisons: {b: {kind: bending, stiffness_n_m_per_rad: 1, rest_rad: ^1}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0, 0]}}
)",
                 "in 3 dimensions a bend has no sign, so the rest of liaison 'b' is straight",
                 "a spring between the two ends holds an angle"},
        BadScene{kHead1,
                 R"(liaisons: {b: {kind: ^bending, stiffness_n_m_per_rad: 1}}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "in 1 dimension liaison 'b' needs a 'length_m'",
                 "MATs move across the line on which they stand, so its length is not known"},
        BadScene{kHead2,
                 R"(liaisons: {b: {kind: bending, stiffness_n_m_per_rad: 1}, p: {parallel: [^b]}}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "a bending liaison joins three MATs, so it stands in no 'parallel'",
                 "write a link of its own with it"},
        BadScene{kHead2,
                 R"(liaisons: {b: {kind: bending, stiffness_n_m_per_rad: 1}}
matter: {a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], liaison: ^b}}
)",
                 "a bending liaison joins three MATs, not two neighbours",
                 "write a link with it: along: matter"}));

TEST(Bends, SayWhatIsWrongWithALink) {
  struct Bad {
    const char* link;
    const char* message;
  };
  for (const Bad& bad : {
           Bad{"{liaison: steel, along: one}", "no three neighbours of a line are picked"},
           Bad{"{liaison: s, along: a}", "only a bending liaison acts along lines"},
           Bad{"{liaison: steel, along: a}",
               "'a[2]' and 'a[3]' start at the same point, so the length between them is not "
               "known"},
           Bad{"{liaison: steel, along: \"a[0..2]\", rest_m: 1}", "a bending has no 'rest_m'"},
           Bad{"{liaison: steel, along: \"a[0..2]\", between: [one, \"a[0]\", \"a[1]\"]}",
               "either 'along' or 'between' can be given in link"},
           Bad{"{liaison: steel, between: [\"a[0]\", \"a[1]\"]}",
               "a bending liaison is between 3 ends, the middle one second, got 2"},
           Bad{"{liaison: steel, between: [\"a[0]\", one, \"a[0]\"]}",
               "the ends of a bending liaison must differ, got 'a[0]' twice"},
           Bad{"{liaison: steel, between: [\"a[0..1]\", one, \"a[0..2]\"]}",
               "the 3 ends must be equally many MATs, or one"},
           Bad{"{liaison: steel, between: [one, \"a[0]\", floor]}", "a surface does not bend"},
           Bad{"{liaison: steel, within: a}",
               "a bending liaison acts between three MATs, not in sets"},
           Bad{"{liaison: steel, along: \"a[0..2]\", stiffness_n_m_per_rad: -1}",
               "'stiffness_n_m_per_rad' in link must be >= 0, got -1"},
       }) {
    config::Problems problems;
    load_scene_text(scene_head(2) + kSteel + "links:\n  - " + bad.link + "\n", "t", problems);
    ASSERT_FALSE(problems.all().empty()) << bad.link;
    EXPECT_EQ(problems.in_order()[0].message, bad.message) << bad.link;
    EXPECT_EQ(problems.in_order()[0].place.line, 10) << bad.link;
  }
}

/// A liaison with a mistake is not yet one of two ends.
TEST(Bends, OfALiaisonWithAMistakeHaveNoOtherProblem) {
  for (const char* const mistake : {"rest_rad: 120", "length_m: 0"}) {
    config::Problems problems;
    load_scene_text(test::filled(R"(cordis: 1
name: t
space: 2
step: {rate_hz: 20000}
liaisons:
  b: {kind: bending, stiffness_n_m_per_rad: 0.05, <mistake>}
matter:
  q: {kind: points, at_m: [[0, 0], [1, 0], [2, 0]], mass_kg: 1}
links:
  - {liaison: b, between: ["q[0]", "q[1]", "q[2]"]}
)",
                                 {{"mistake", std::string(mistake)}}),
                    "t", problems);
    EXPECT_EQ(problems.all().size(), 1u) << problems.text();
  }
}

TEST(Bends, HaveOneProblemForARestInSpaceThatIsTooLarge) {
  for (const char* const rest : {"9", "1"}) {
    config::Problems problems;
    load_scene_text(test::filled(R"(cordis: 1
space: 3
step: {rate_hz: 20000}
liaisons: {b: {kind: bending, stiffness_n_m_per_rad: 1, rest_rad: <rest>}}
matter: {q: {kind: points, at_m: [[0, 0, 0], [1, 0, 0], [2, 0, 0]], mass_kg: 1}}
links: [{liaison: b, along: q}, {liaison: b, along: q}]
)",
                                 {{"rest", std::string(rest)}}),
                    "t", problems);
    EXPECT_EQ(problems.all().size(), 1u) << problems.text();
  }
}

constexpr const char* kBranch = R"(liaisons:
  wood:
    kind: bending
    parameters: {b_n_m: 2, yield_rad: 0.3}
    states:
      whole: {stiffness_n_m_per_rad: b_n_m, viscosity_n_m_s_per_rad: 0.01, rest_rad: 0.1,
              exits: [{to: broken, when: abs(bend_rad) > yield_rad},
                      {to: bent, when: "rod.links[0].force_n > 1000 and time_s > 1", rest: here},
                      {to: bent, when: moment_n_m > 5 or speed_rad_per_s > 1e3, rest: rest_rad + 0.5 * bend_rad}]}
      bent: {stiffness_n_m_per_rad: 1, exits: [{to: whole, when: "falling(angle_rad) and age_s > 1", rest: keep}]}
      broken: {final: true}
  steel: {kind: bending, stiffness_n_m_per_rad: 0.5}
  watched: {states: {on: {exits: [{to: off, when: "twig.angle_rad > 0.2 or twig.state == broken"}]}, off: {final: true}}}
matter:
  rod: {kind: string, count: 5, mass_kg: 0.1, from_m: [0, 0], to_m: [0.4, 0], stiffness_n_per_m: 100}
links:
  - {liaison: wood, between: ["rod[0]", "rod[1]", "rod[2]"], name: twig}
  - {liaison: wood, along: rod, b_n_m: 3, name: limb}
  - {liaison: steel, along: "rod[0..2]", name: reed}
  - {liaison: steel, along: "rod[1..4]"}
  - {liaison: watched, between: ["rod[0]", "rod[4]"]}
)";

TEST(BendsWithStates, AreReadWithTheirNames) {
  const Scene scene = sound_scene(2, kBranch);
  const engine::NetworkDescription& network = scene.network;

  ASSERT_EQ(network.bends.size(), 1u + 3u + 1u + 2u);
  EXPECT_TRUE(network.bends[0].has_states());
  EXPECT_FALSE(network.bends[4].has_states());
  EXPECT_EQ(network.bends[0].rest_angle, 0.1);
  const engine::StateMachine& twig = network.state_machines[network.bends[0].state_machine];
  const engine::StateMachine& limb = network.state_machines[network.bends[1].state_machine];
  EXPECT_EQ(twig.name, "wood");
  EXPECT_EQ(twig.states[0].stiffness, 2.0);
  EXPECT_EQ(limb.states[0].stiffness, 3.0);
  EXPECT_EQ(twig.states[0].rest_angle, 0.1);
  EXPECT_EQ(twig.states[2].name, "broken");
  EXPECT_EQ(twig.exits[0].triggered, engine::Quantity::kBend);
  EXPECT_EQ(twig.exits[1].rest, engine::RestRule::kHere);
  ASSERT_EQ(scene.link_groups.size(), 6u);
  ASSERT_EQ(scene.links.size(), 6u);
  EXPECT_EQ(scene.links[2].name, "twig");
  EXPECT_EQ(scene.links[2].first, scene.link_count());
  EXPECT_EQ(scene.links[5].name, "steel");
  engine::World world(std::make_shared<const engine::Network>(network));
  world.step();
}

TEST(BendsWithStates, HaveSignals) {
  const Scene scene = sound_scene(2, std::string(kBranch) + R"(signals:
  a: {of: twig, quantity: angle}
  b: {of: limb, quantity: moment, take: largest}
  c: {of: limb, quantity: state, take: sum}
  d: {of: "limb[2]", quantity: age}
  e: {of: reed, quantity: bend}
  f: {of: steel, quantity: speed, take: mean}
  g: {of: reed, quantity: rest_angle}
)");
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  for (int n = 0; n < 3; ++n) world.step();
  std::vector<double> values(scene.signals.count());
  scene.signals.read(world, values.data());
  const auto value = [&](std::size_t index) { return values[index]; };
  const auto side = [&](std::uint32_t a, std::uint32_t b) -> engine::Vec3 {
    return world.position(b) - world.position(a);
  };
  const auto angle_of = [&](const engine::Bend& bend) {
    const engine::Vec3 u = side(bend.mat_a, bend.mat_b);
    const engine::Vec3 v = side(bend.mat_b, bend.mat_c);
    return std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
  };
  EXPECT_GT(std::abs(value(0)), 1e-4);
  EXPECT_NEAR(value(0), angle_of(scene.network.bends[0]), 1e-14);
  EXPECT_EQ(value(1),
            std::max({world.moment_of_bend(1), world.moment_of_bend(2), world.moment_of_bend(3)}));
  EXPECT_EQ(value(2), 0.0);
  EXPECT_NEAR(value(3), 3.0 * scene.network.step, 1e-15);
  EXPECT_NEAR(value(4), angle_of(scene.network.bends[4]), 1e-14);
  EXPECT_NE(value(5), 0.0);
  EXPECT_EQ(value(6), 0.0);
}

TEST(BendsWithStates, ShareQuantitiesWithNoLink) {
  for (const auto& [signal, message] :
       {std::pair{"{of: reed, quantity: force}", "a bend has no quantity 'force'"},
        std::pair{"{of: reed, quantity: state}", "a bend has no quantity 'state'"},
        std::pair{"{of: twig, quantity: bonds}", "a bend with states has no quantity 'bonds'"},
        std::pair{"{of: [twig, reed], quantity: state, take: sum}",
                  "a bend has no quantity 'state'"},
        std::pair{"{of: rod.links, quantity: angle, take: sum}",
                  "a link has no quantity 'angle'"}}) {
    config::Problems problems;
    load_scene_text(scene_head(2) + kBranch + "signals:\n  a: " + signal + "\n", "t", problems);
    ASSERT_EQ(problems.all().size(), 1u) << problems.text();
    EXPECT_EQ(problems.all()[0].message, message);
  }
}

TEST(BendsWithStates, TakeParametersDuringARun) {
  const auto scene = std::make_shared<const Scene>(sound_scene(2, kBranch));
  Parameters parameters(scene);
  const Parameters::Outcome of_limb = parameters.set("limb", "b_n_m", 7.0);
  ASSERT_EQ(of_limb.problem, "");
  ASSERT_EQ(of_limb.changes.size(), 1u);
  EXPECT_EQ(of_limb.changes[0].state_machine.states[0].stiffness, 7.0);
  const Parameters::Outcome of_steel = parameters.set("steel", "stiffness_n_m_per_rad", 4.0);
  ASSERT_EQ(of_steel.problem, "");
  engine::NetworkDescription network = scene->network;
  for (const Change& change : of_steel.changes) apply(change, network);
  EXPECT_EQ(network.bends[4].stiffness, 4.0);
  EXPECT_EQ(network.bends[5].stiffness, 4.0);
  EXPECT_EQ(network.bends[0].stiffness, 0.0);
  const Parameters::Outcome of_reed = parameters.set("reed", "stiffness_n_m_per_rad", 5.0);
  ASSERT_EQ(of_reed.problem, "");
  ASSERT_EQ(of_reed.changes.size(), 1u);
  EXPECT_EQ(of_reed.changes[0].count, 1u);
  ASSERT_EQ(parameters.get("reed.stiffness_n_m_per_rad").entries.size(), 1u);
  EXPECT_EQ(parameters.set("twig", "stiffness_n_m_per_rad", 1.0).problem,
            "'twig' has no parameter 'stiffness_n_m_per_rad'");
}

TEST(BendsWithLaws, AreReadWithTheirKeys) {
  const Scene scene = sound_scene(2, R"(liaisons:
  cubic: {kind: bending, parameters: {b: 2}, elasticity: b * bend_rad + bend_rad^3, dissipation: 0.1 * speed_rad_per_s}
  pumped: {kind: bending, elasticity: (1 + time_s) * bend_rad}
  tin:
    kind: bending
    states:
      whole: {stiffness_n_m_per_rad: 1, elasticity: {kind: table, at_rad: [-1, 0, 1], moment_n_m: [-3, 0, 3]},
              exits: [{to: limp, when: abs(bend_rad) > 1}]}
      limp: {dissipation: {kind: table, at_rad_per_s: [-1, 1], moment_n_m: [-3, 3]}, final: true}
matter:
  rod: {kind: string, count: 3, mass_kg: 0.1, from_m: [0, 0], to_m: [0.4, 0], stiffness_n_per_m: 100}
links:
  - {liaison: cubic, along: rod, b: 5, name: cubic_rod}
  - {liaison: pumped, along: rod}
  - {liaison: tin, along: rod}
)");
  const auto& bends = scene.network.bends;
  const auto state = [&](std::size_t bend, std::size_t index) -> const engine::LinkState& {
    return scene.network.state_machines[bends[bend].state_machine].states[index];
  };
  ASSERT_EQ(bends.size(), 3u);
  EXPECT_EQ(bends[0].stiffness, 0.0);
  EXPECT_EQ(elastic_tension(state(0, 0).elasticity, {0.5, 0.5}), 5.0 * 0.5 + 0.125);
  engine::LawPoint moving;
  moving.speed = 3.0;
  EXPECT_EQ(viscous_tension(state(0, 0).dissipation, moving), 0.1 * 3.0);
  // A factor of time is no stiffness here, which would be of the sine.
  EXPECT_NE(laws_of_bend(state(1, 0)).elasticity, nullptr);
  EXPECT_EQ(state(2, 0).stiffness, 1.0);
  EXPECT_EQ(elastic_tension(state(2, 0).elasticity, {0.5, 0.5}), 1.5);
  EXPECT_EQ(viscous_tension(state(2, 1).dissipation, moving), 3.0);
}

TEST(BendsWithLaws, TakeParametersDuringARun) {
  const auto scene = std::make_shared<const Scene>(sound_scene(2, R"(liaisons:
  cubic: {kind: bending, parameters: {b: 2}, elasticity: b * bend_rad, viscosity_n_m_s_per_rad: 0.1}
matter:
  rod: {kind: string, count: 3, mass_kg: 0.1, from_m: [0, 0], to_m: [0.4, 0], stiffness_n_per_m: 100}
links:
  - {liaison: cubic, along: rod, name: limb}
)"));
  Parameters parameters(scene);
  engine::World world(std::make_shared<const engine::Network>(scene->network));
  for (const auto& [name, value] :
       {std::pair{"b", 7.0}, std::pair{"viscosity_n_m_s_per_rad", 0.2}}) {
    const Parameters::Outcome outcome = parameters.set("limb", name, value);
    ASSERT_EQ(outcome.problem, "");
    ASSERT_EQ(outcome.changes.size(), 1u);
    world.replace_state_machine(outcome.changes[0].first, outcome.changes[0].state_machine);
  }
  const engine::NetworkDescription& network = scene->network;
  const std::uint32_t index = network.bends[0].state_machine;
  engine::StateMachine without_law = network.state_machines[index];
  without_law.states[0].elasticity = engine::NoLaw{};
  EXPECT_THROW(world.replace_state_machine(index, without_law), std::invalid_argument);
}

TEST(Bends, NameThemselvesInARefusal) {
  config::Problems problems;
  load_scene_text(
      R"(cordis: 1
space: 1
step: {rate_hz: 1000, integrator: modal}
liaisons: {steel: {kind: bending, stiffness_n_m_per_rad: 1, length_m: 1}}
matter: {rod: {kind: string, count: 3, mass_kg: 1, stiffness_n_per_m: 1}}
links: [{liaison: steel, along: rod}]
)",
      "t", problems);
  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  EXPECT_EQ(problems.all()[0].message,
            "the integrator modal does not take stiffness against bending, which steel has");
}

TEST(BendsWithLaws, NameThemselvesInARefusal) {
  config::Problems problems;
  load_scene_text(
      R"(cordis: 1
space: 2
step: {rate_hz: 1000, integrator: symplectic4}
liaisons: {cord: {kind: bending, elasticity: bend_rad^3}}
matter: {rod: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 1}}
links: [{liaison: cord, along: rod}]
)",
      "t", problems);
  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  EXPECT_EQ(problems.all()[0].message,
            "the integrator symplectic4 does not take a law or a parameter of a bend that is no "
            "number, which cord has");
}

TEST(BendsWithLaws, OfTheLibraryAreRead) {
  const std::string library =
      std::string(CORDIS_SOURCE_DIR) + "/launch_configs/liaisons/bends.yaml";
  for (const char* const liaison : {"cord", "tin", "rubber"}) {
    const Scene scene =
        sound_scene(2, test::filled(R"(liaisons: {include: <library>}
matter: {rod: {kind: string, count: 4, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 1}}
links: [{liaison: <liaison>, along: rod}]
)",
                                    {{"library", library}, {"liaison", std::string(liaison)}}));
    ASSERT_EQ(scene.network.bends.size(), 2u);
    const engine::StateMachine& machine =
        scene.network.state_machines[scene.network.bends[0].state_machine];
    const auto moment = [&](double bend) {
      return elastic_tension(machine.states[0].elasticity, {bend, bend});
    };
    EXPECT_GT(moment(1.0), moment(0.2)) << liaison;
    EXPECT_EQ(moment(-1.0), -moment(1.0)) << liaison;
  }
}

}  // namespace
}  // namespace cordis::scene
