// tests/scene/condition_test.cpp -- conditions over variables of other things than their link.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/variables.h"
#include "sim_node/engine/world.h"
#include "sim_node/scene/parameters.h"
#include "tests/scene/bad_scene.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/filled.h"
#include "tests/support/test_seed.h"

namespace cordis::scene {
namespace {

using engine::World;

World world_of(const Scene& scene, engine::VectorWidth width = engine::best_vector_width()) {
  return World(std::make_shared<const engine::Network>(scene.network), width);
}

/// The links of a name, which are of one kind.
LinkGroup group_of(const Scene& scene, const std::string& name) {
  for (const LinkGroup& group : scene.link_groups) {
    if (group.name == name) return group;
  }
  ADD_FAILURE() << name;
  return {};
}

/// The step in which the first link of a name changes its state; none in so many steps.
std::optional<std::uint64_t> first_change(const Scene& scene, World& world, const std::string& name,
                                          int steps) {
  const std::uint32_t link = group_of(scene, name).first;
  for (int n = 0; n < steps; ++n) {
    world.step();
    for (const engine::LinkEvent& event : world.events()) {
      if (event.link == link) return event.step;
    }
  }
  return std::nullopt;
}

/// A bolt that breaks under a falling weight, and what is asked of it.
std::string falling(const std::string& liaisons, const std::string& links) {
  return R"(world: {gravity_m_per_s2: [0, -9.81]}
liaisons:
  brittle: {states: {whole: {stiffness_n_per_m: 500,
                             exits: [{to: broken, when: elongation_m > 0.01}]},
                     broken: {final: true}}}
)" + liaisons +
         R"(matter:
  wall: {kind: fixed, at_m: [[0, 0], [1, 0]]}
  bob: {kind: mass, mass_kg: 1, at_m: [[0, -1], [1, -1]]}
links:
  - {liaison: brittle, between: ["wall[0]", "bob[0]"], name: bolt}
)" + links;
}

/// A liaison that holds until a condition comes true.
std::string until(const std::string& name, const std::string& condition) {
  return "  " + name + ": {states: {held: {stiffness_n_per_m: 500, exits: [{to: free, when: \"" +
         condition + "\"}]}, free: {final: true}}}\n";
}

TEST(Variable, TimeLetsGoAtItsStep) {
  const Scene scene =
      sound_scene(2, falling(until("gate", "time_s >= 0.016"),
                             "  - {liaison: gate, between: [\"wall[1]\", \"bob[1]\"], name: g}\n"));
  World world = world_of(scene);
  EXPECT_EQ(first_change(scene, world, "g", 100), 16u);  // whose positions are those of 16 ms
}

TEST(Variable, AStateIsSeenOneStepAfterItHasChanged) {
  const std::string links =
      R"(  - {liaison: latch, between: ["wall[1]", "bob[1]"], name: l}
  - {liaison: late, between: ["wall[1]", "bob[1]"], name: d}
)";
  const Scene scene =
      sound_scene(2, falling(until("latch", "bolt.state == broken") +
                                 until("late", "broken_for > 0.0045 and whole != bolt.state"),
                             links) +
                         "signals:\n  broken_for: {of: bolt, quantity: age}\n");
  World world = world_of(scene);
  World again = world_of(scene);
  World once_more = world_of(scene);
  const std::optional<std::uint64_t> broken = first_change(scene, world, "bolt", 1000);
  ASSERT_TRUE(broken.has_value());
  EXPECT_EQ(first_change(scene, again, "l", 1000), *broken + 1);
  // the state is 4 ms old 4 steps later, and 5 ms old after 5
  EXPECT_EQ(first_change(scene, once_more, "d", 1000), *broken + 5);
}

TEST(Variable, LinksThatAskEachOtherSeeTheStepBefore) {
  // Each goes where the other was: from 0 and 1 they change places in every step. If one saw the present
  // step of the other, both would soon be the same.
  const auto follows = [](const std::string& other, const std::string& start) {
    return "{start: " + start + ", states: {low: {exits: [{to: high, when: " + other +
           ".state == high}]}, high: {exits: [{to: low, when: " + other + ".state == low}]}}}";
  };
  const Scene scene = sound_scene(
      2, test::filled(R"(liaisons:
  l: <l>
  r: <r>
matter:
  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
links:
  - {liaison: l, between: ["m[0]", "m[1]"], name: left}
  - {liaison: r, between: ["m[0]", "m[1]"], name: right}
)",
                      {{"l", follows("right", "low")}, {"r", follows("left", "high")}}));
  World world = world_of(scene);
  for (std::uint32_t n = 0; n < 20; ++n) {
    EXPECT_EQ(world.state_of(0), n % 2);
    EXPECT_EQ(world.state_of(1), 1 - n % 2);
    world.step();
    EXPECT_EQ(world.events().size(), 2u);
  }
}

/// A port, masses and a link of each kind, of which conditions may ask; `watch` has no force.
std::string many(const std::string& condition) {
  return test::filled(R"(world: {gravity_m_per_s2: [0, -9.81]}
liaisons:
  s: {kind: spring_damper, stiffness_n_per_m: 90, viscosity_n_s_per_m: 0.2}
  m: {kind: maxwell, stiffness_n_per_m: 50, viscosity_n_s_per_m: 2}
  jumps: {states: {a: {stiffness_n_per_m: 40,
                       exits: [{to: b, when: elongation_m > 0.02, rest: here}]},
                   b: {stiffness_n_per_m: 20, exits: [{to: a, when: elongation_m < -0.01}]}}}
  watching: {states: {no: {exits: [{to: yes, when: "<condition>"}]}, yes: {final: true}}}
matter:
  wall: {kind: fixed, at_m: [0, 0]}
  bob: {kind: mass, mass_kg: 0.2, at_m: [[0.3, 0.1], [0.5, 0]]}
ports:
  key: {device: k, axes: [0], role: mass, coupling: direct, at_m: [0.1, 0.2], along: y}
links:
  - {liaison: s, between: [wall, "bob[0]"], name: spring}
  - {liaison: m, between: ["bob[0]", "bob[1]"], name: soft}
  - {liaison: jumps, between: [key, "bob[1]"], name: jumper}
  - {liaison: watching, between: [wall, "bob[0]"], name: watch}
signals:
  stored: {quantity: elastic_energy}
  push: {of: "bob[1]", quantity: force, axis: x}
  changed: {quantity: changes}
)",
                      {{"condition", condition}});
}

/// A hand that moves the key to and fro.
void play(World& world, int n) {
  world.impose_position(3, {0.1, 0.2 + 0.05 * (1.0 - std::cos(0.01 * n)), 0.0});
}

TEST(Variable, OfEveryKindHasTheValueAtTheEndOfTheStepBefore) {
  constexpr std::uint32_t kKey = 3;
  constexpr int kSteps = 800;
  struct Word {
    std::string text;
    std::function<double(const World&)> value;
  };
  const auto distance = [](const World& world, std::uint32_t a, std::uint32_t b) {
    return (world.position(b) - world.position(a)).norm();
  };
  const std::vector<Word> words{
      {"bob[0].position_x_m", [](const World& w) { return w.position(1).x(); }},
      {"bob[1].position_y_m", [](const World& w) { return w.position(2).y(); }},
      {"bob[1].velocity_x_m_per_s", [](const World& w) { return w.velocity(2).x(); }},
      {"bob[0].speed_m_per_s", [](const World& w) { return w.velocity(1).norm(); }},
      {"bob[0].force_y_n", [](const World& w) { return w.link_force(1).y(); }},
      {"key.position_m", [](const World& w) { return w.position(kKey).y() - 0.2; }},
      {"key.velocity_m_per_s", [](const World& w) { return w.velocity(kKey).y(); }},
      {"key.force_n", [](const World& w) { return w.link_force(kKey).y(); }},
      {"spring.distance_m", [&](const World& w) { return distance(w, 0, 1); }},
      {"soft.distance_m", [&](const World& w) { return distance(w, 1, 2); }},
      {"soft.force_n", [](const World& w) { return w.tension_of_maxwell(0); }},
      {"jumper.elongation_m",
       [&](const World& w) { return distance(w, kKey, 2) - w.rest_length_of(0); }},
      {"jumper.rest_length_m", [](const World& w) { return w.rest_length_of(0); }},
      {"jumper.force_n", [](const World& w) { return w.tension_of(0); }},
      {"jumper.state", [](const World& w) { return double(w.state_of(0)); }},
      {"time_s", [](const World& w) { return 0.001 * double(w.step_count()); }},
      {"stored", [](const World& w) { return w.energy().elastic; }},
      {"push", [](const World& w) { return w.link_force(2).x(); }},
      {"changed",
       [](const World& w) { return double(w.change_count(0, 0, 1) + w.change_count(0, 1, 0)); }},
  };
  std::mt19937 random(test::test_seed());
  for (const Word& word : words) {
    std::vector<double> values;  // before each step
    {
      const Scene scene = sound_scene(2, many("time_s < -1"));
      World world = world_of(scene);
      for (int n = 0; n < kSteps; ++n) {
        values.push_back(word.value(world));
        play(world, n);
        world.step();
      }
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    ASSERT_LT(*least, *most) << word.text;
    for (int round = 0; round < 4; ++round) {
      const double share = 0.02 + 0.9 * static_cast<double>(random()) / 4294967296.0;
      const double limit = *least + share * (*most - *least);
      const bool rises = values.front() < limit;
      const std::string condition =
          word.text + (rises ? " > " : " < ") + config::number_text(limit);
      const auto expected = std::find_if(values.begin(), values.end(), [&](double value) {
        return rises ? value > limit : value < limit;
      });
      const Scene scene = sound_scene(2, many(condition));
      World world = world_of(scene);
      std::optional<std::int64_t> changed;
      for (int n = 0; n < kSteps && !changed; ++n) {
        play(world, n);
        world.step();
        if (world.state_of(1) == 1) changed = n;
      }
      ASSERT_TRUE(changed.has_value()) << condition;
      EXPECT_EQ(*changed, expected - values.begin()) << condition;
    }
  }
}

TEST(Variable, HasOneHashOnAllWidthsAndOverASnapshot) {
  const Scene scene =
      sound_scene(2, many("rising(jumper.force_n) and bob[1].velocity_x_m_per_s > stored - 0.1"));
  std::vector<std::uint64_t> hashes;
  {
    World world = world_of(scene);
    for (int n = 0; n < 600; ++n) {
      play(world, n);
      world.step();
      hashes.push_back(world.state_hash());
    }
    EXPECT_EQ(world.state_of(1), 1u);
  }
  for (const engine::VectorWidth width : engine::supported_vector_widths()) {
    World world = world_of(scene, width);
    for (int n = 0; n < 600; ++n) {
      World restored = world_of(scene, width);
      if (n % 7 == 0) {
        restored.restore(world.snapshot());
        std::swap(restored, world);
      }
      play(world, n);
      world.step();
      ASSERT_EQ(world.state_hash(), hashes[static_cast<std::size_t>(n)]) << to_string(width) << n;
    }
  }
}

TEST(Variable, OfChangesIsTheSumOverAllStateMachinesAlsoWhenItIsRestored) {
  const auto ticks = [](const char* every_s) {
    const std::string exit = ", when: age_s > " + std::string(every_s) + "}]}";
    return "{states: {tick: {exits: [{to: tock" + exit + ", tock: {exits: [{to: tick" + exit + "}}";
  };
  const Scene scene =
      sound_scene(2, test::filled(R"(liaisons:
  slow: <slow>
  fast: <fast>
matter:
  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
links:
  - {liaison: slow, between: ["m[0]", "m[1]"]}
  - {liaison: fast, between: ["m[0]", "m[1]"]}
)",
                                  {{"slow", ticks("0.0065")}, {"fast", ticks("0.0015")}}));
  const engine::Variable changes{.quantity = engine::VariableKind::kChanges,
                                 .direction = engine::Vec3::Zero()};
  World world = world_of(scene);
  double last = 0.0;
  for (int n = 0; n < 200; ++n) {
    if (n % 50 == 0) {
      World restored = world_of(scene);
      restored.restore(world.snapshot());
      std::swap(restored, world);
    }
    world.step();
    std::uint64_t sum = 0;
    for (const std::uint32_t from : {0U, 1U})
      sum += world.change_count(0, from, 1 - from) + world.change_count(1, from, 1 - from);
    last = value_of(changes, world, {});
    ASSERT_EQ(last, static_cast<double>(sum)) << n;
  }
  EXPECT_GT(last, 100.0);
}

TEST(Variable, CostsNoAllocation) {
  const Scene scene = sound_scene(2, many("stored > bob[0].position_x_m + jumper.age_s"));
  World world = world_of(scene);
  const test::AllocationGuard guard;
  for (int n = 0; n < 100; ++n) world.step();
  EXPECT_EQ(guard.count(), 0u);
}

TEST(Variable, ThatSeveralConditionsAskForIsOne) {
  const Scene scene =
      sound_scene(2, many("time_s > 1 and time_s < 2 or stored > 3 and stored < 4"));
  EXPECT_EQ(scene.network.variables.size(), 2u);
  EXPECT_TRUE(sound_scene(2, many("age_s > 1")).network.variables.empty());
}

TEST(Variable, OfAPartIsThatOfItsOwnCopyAndThenThatOfTheScene) {
  const Scene scene = sound_scene(2,
                                  R"(liaisons:
  loose: {states: {on: {stiffness_n_per_m: 1, final: true},
                   off: {exits: [{to: on, when: age_s > 9}]}}, start: off}
)" + until("latch", "bolt.state == on and lever.position_x_m > 4") +
                                      R"(parts:
  door:
    matter: {frame: {kind: mass, mass_kg: 1, at_m: [[0, 0], [0, 1]]}}
    links:
      - {liaison: loose, between: ["frame[0]", "frame[1]"], name: bolt}
      - {liaison: latch, between: ["frame[0]", "frame[1]"], name: catch}
matter:
  lever: {kind: fixed, at_m: [5, 0]}
  doors: {part: door, repeat: {count: 3, translate_m: [1, 0]}}
)");
  World world = world_of(scene);
  world.force_state(group_of(scene, "doors[1].bolt").first, 0);
  for (int n = 0; n < 3; ++n) world.step();
  for (const int door : {0, 1, 2}) {
    const std::string name = "doors[" + std::to_string(door) + "].catch";
    EXPECT_EQ(world.state_of(group_of(scene, name).first), door == 1 ? 1u : 0u) << name;
  }
}

TEST(Variable, OfLinksWithoutANameComesAfterWhatTheSceneHasOfThatName) {
  const Scene scene = sound_scene(2, R"(liaisons:
  lever: {kind: spring, stiffness_n_per_m: 1, rest_m: 1}
)" + until("latch", "lever.position_x_m > 4") +
                                         R"(parts:
  door:
    matter: {frame: {kind: mass, mass_kg: 1, at_m: [[0, 0], [0, 1]]}}
    links:
      - {liaison: lever, between: ["frame[0]", "frame[1]"]}
      - {liaison: latch, between: ["frame[0]", "frame[1]"], name: catch}
matter:
  lever: {kind: fixed, at_m: [5, 0]}
  door: {part: door}
)");
  World world = world_of(scene);
  for (int n = 0; n < 3; ++n) world.step();
  EXPECT_EQ(world.state_of(group_of(scene, "door.catch").first), 1u);
}

TEST(Variable, IsAskedForByAPartOfAParallelLiaisonAndByLinksOfMatter) {
  std::string text =
      falling(until("latch", "bolt.state == broken") + "  both: {parallel: [brittle, latch]}\n",
              "  - {liaison: both, between: [\"wall[1]\", \"bob[1]\"], name: b}\n") +
      R"(parts:
  chain:
    matter: {row: {kind: string, count: 3, mass_kg: 1, from_m: [3, 0], to_m: [4, 0], ends: fixed,
                   liaison: latch}}
    links: [{liaison: brittle, between: ["row[0]", "row[2]"], name: bolt}]
)";
  text.insert(text.find("links:\n"), "  c: {part: chain}\n");
  const Scene scene = sound_scene(2, text);
  World world = world_of(scene);
  World again = world_of(scene);
  const std::optional<std::uint64_t> broken = first_change(scene, world, "bolt", 1000);
  ASSERT_TRUE(broken.has_value());
  EXPECT_EQ(first_change(scene, again, "b.latch", 1000), *broken + 1);
  EXPECT_EQ(again.state_of(group_of(scene, "c.row.links").first), 0u);  // its own bolt holds
}

TEST(Variable, IsAskedForByPairsOfSets) {
  const Scene scene = sound_scene(2,
                                  R"(liaisons:
  glue: {states: {wet: {exits: [{to: dry, when: time_s > 0.0045}]},
                  dry: {stiffness_n_per_m: 1, final: true}}}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0], [2, 0]]}
links:
  - {liaison: glue, within: m, range_m: 1.1, rest_m: 1, name: bonds}
)");
  World world = world_of(scene);
  for (int n = 0; n < 5; ++n) world.step();
  EXPECT_TRUE(world.bound_pairs(0).empty());
  world.step();
  EXPECT_EQ(world.bound_pairs(0).size(), 2u);
}

TEST(Variable, WakesALinkThatSleeps) {
  const std::string text =
      R"(cordis: 1
space: 2
step: {rate_hz: 1000, freeze: {tolerance_m: 1e-4}}
world: {gravity_m_per_s2: [0, -9.81]}
liaisons:
)" + until("gate", "time_s >= 3") +
      R"(  s: {kind: spring_damper, stiffness_n_per_m: 500, viscosity_n_s_per_m: 20}
matter:
  wall: {kind: fixed, at_m: [0, 0]}
  bob: {kind: mass, mass_kg: 1, at_m: [0, -1]}
links:
  - {liaison: s, between: [wall, bob], rest_m: 0.98}
  - {liaison: gate, between: [wall, bob], name: g}
)";
  config::Problems problems;
  const Scene scene = load_scene_text(text, "t", problems);
  ASSERT_EQ(problems.text(), "");
  World world = world_of(scene);
  for (int n = 0; n < 2999; ++n) world.step();
  EXPECT_EQ(world.asleep_count(), 1u);
  EXPECT_EQ(first_change(scene, world, "g", 10), 3000u);
  EXPECT_EQ(world.asleep_count(), 0u);
}

TEST(Variable, StaysAskedForWhenAParameterIsSet) {
  const auto scene = std::make_shared<const Scene>(sound_scene(
      2,
      falling("  latch: {parameters: {after_s: 9}, states: {held: {stiffness_n_per_m: 500, exits: "
              "[{to: free, when: bolt.state == broken and bolt.age_s > after_s}]}, free: {final: "
              "true}}}\n",
              "  - {liaison: latch, between: [\"wall[1]\", \"bob[1]\"], name: l}\n")));
  Parameters parameters(scene);
  const Parameters::Outcome outcome = parameters.set("latch", "after_s", 0.0025);
  ASSERT_EQ(outcome.changes.size(), 1u) << outcome.problem;
  World world = world_of(*scene);
  world.replace_state_machine(outcome.changes[0].first, outcome.changes[0].state_machine);
  World same = world_of(*scene);
  const std::optional<std::uint64_t> broken = first_change(*scene, same, "bolt", 1000);
  ASSERT_TRUE(broken.has_value());
  EXPECT_EQ(first_change(*scene, world, "l", 1000), *broken + 3);
}

TEST(Variable, GivesWayToAParameterAndAQuantityOfTheLink) {
  const Scene scene = sound_scene(
      2,
      falling("  latch: {parameters: {time_s: 5}, states: {held: {stiffness_n_per_m: 500, exits: "
              "[{to: free, when: distance_m > time_s}]}, free: {final: true}}}\n",
              "  - {liaison: latch, between: [\"wall[1]\", \"bob[1]\"]}\n") +
          "signals:\n  distance_m: {quantity: energy}\n");
  EXPECT_TRUE(scene.network.variables.empty());
}

/// A scene whose one liaison asks for something, after the marked place.
struct BadCondition {
  const char* condition;
  const char* message;
  const char* hint;
};

void PrintTo(const BadCondition& bad, std::ostream* stream) {
  *stream << bad.condition;
}

class BadConditions : public testing::TestWithParam<BadCondition> {};

TEST(Variable, ThatThousandsOfCopiesMisspellIsOneProblemAtOnce) {
  // Each copy used to look through all names of the scene for what may be meant, which took minutes.
  const std::string text = scene_head(2) + "liaisons:\n" +
                           until("latch", "bold.state == held or bold.age_s > 1") + R"(parts:
  door:
    matter: {frame: {kind: mass, mass_kg: 1, at_m: [[0, 0], [0, 1]]}}
    links: [{liaison: latch, between: ["frame[0]", "frame[1]"], name: bolt}]
matter:
  doors: {part: door, repeat: {count: 3000, translate_m: [1, 0]}}
)";
  config::Problems problems;
  load_scene_text(text, "t", problems);
  ASSERT_EQ(problems.error_count(), 2u);
  EXPECT_EQ(problems.all().front().message, "no matter, port or links are named 'bold'");
}

TEST(Variable, OfThousandsOfCopiesAreOneEach) {
  const Scene scene = sound_scene(
      2,
      "liaisons:\n" + until("latch", "bolt.age_s > 1 and bolt.age_s < 2 and time_s > 1") + R"(parts:
  door:
    matter: {frame: {kind: mass, mass_kg: 1, at_m: [[0, 0], [0, 1]]}}
    links: [{liaison: latch, between: ["frame[0]", "frame[1]"], name: bolt}]
matter:
  doors: {part: door, repeat: {count: 5000, translate_m: [1, 0]}}
)");
  EXPECT_EQ(scene.network.variables.size(), 5001u);
}

TEST_P(BadConditions, AreReportedOnceAtTheirPlace) {
  const std::string text = test::filled(R"(liaisons:
  glue: {states: {apart: {exits: [{to: stuck, when: distance_m < 0.1}]}, stuck: {final: true}}}
  s: {kind: spring, stiffness_n_per_m: 1}
  l: {states: {x: {exits: [{to: y, when: "<condition>"}]}, y: {final: true}}}
parts:
  door:
    matter: {leaf: {kind: mass, mass_kg: 1, at_m: [[0, 0], [0, 1]]}}
    links: [{liaison: s, between: ["leaf[0]", "leaf[1]"], name: hinge}]
matter:
  w: {part: door}
  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0], [2, 0]]}
links:
  - {liaison: l, between: ["m[0]", "m[1]"], name: bolt}
  - {liaison: l, between: ["m[1]", "m[2]"]}
  - {liaison: glue, within: m, range_m: 0.2, rest_m: 0.1, name: bonds}
signals:
  lumps: {of: bonds, quantity: pieces}
)",
                                        {{"condition", std::string(GetParam().condition)}});
  expect_only_problem({kHead2, text.c_str(), GetParam().message, GetParam().hint});
}

INSTANTIATE_TEST_SUITE_P(
    Condition, BadConditions,
    testing::Values(
        BadCondition{"^blot.state == x", "no matter, port or links are named 'blot'",
                     "did you mean 'bolt'?"},
        BadCondition{"age_s > 1 and ^leaf[0].position_x_m > 2",
                     "no matter, port or links are named 'leaf'",
                     "it stands in a part: write w.leaf[0].position_x_m"},
        BadCondition{"^m.position_x_m > 2", "one MAT or one link may be asked for, and 'm' has 3",
                     "pick one: m[0].position_x_m, the whole expression in quotes"},
        BadCondition{"^m[7].position_x_m > 2", "'m' has the MATs 0 to 2, got 7", ""},
        BadCondition{"^m[1].position_z_m > 2",
                     "a MAT has no quantity 'position_z_m' that others may ask for",
                     "did you mean 'position_x_m'?"},
        BadCondition{"^m[1].position_m > 2",
                     "'m[1]' has no axis of its own, so 'position_m' has no direction",
                     "write the axis: position_x_m"},
        BadCondition{"^m[1].state == x", "a MAT has no quantity 'state' that others may ask for",
                     "it has position_x_m, position_y_m, velocity_x_m_per_s, velocity_y_m_per_s, "
                     "force_x_n, force_y_n, speed_m_per_s"},
        BadCondition{"bolt.state == ^z", "'bolt' has no state 'z'", "it has x, y"},
        BadCondition{"^w.hinge.age_s > 1", "a link has no quantity 'age_s' that others may ask for",
                     "it has distance_m, elongation_m, speed_m_per_s, force_n"},
        BadCondition{"^bonds.force_n > 1",
                     "'bonds' is a liaison of sets, and one MAT or one link may be asked for", ""},
        BadCondition{"^lumps > 1",
                     "the signal 'lumps' counts pieces or bonds, which no condition asks for",
                     "ask for the state of a named link"},
        BadCondition{
            "^time > 1",
            "'when' in exit of state 'x' of liaison 'l' names 'time', which is no quantity "
            "and no parameter",
            "did you mean 'time_s'?"},
        BadCondition{"force_n^[3] > 2",
                     "'when' in exit of state 'x' of liaison 'l' does not expect '[' here", ""},
        BadCondition{"age_s > 1 and 2 < lumps^[0][1]",
                     "'when' in exit of state 'x' of liaison 'l' does not expect '[' here", ""},
        BadCondition{"^sin[4](age_s) > 0",
                     "'when' in exit of state 'x' of liaison 'l' needs brackets after 'sin'",
                     "write sin(...)"},
        BadCondition{"bolt^. > 1",
                     "'when' in exit of state 'x' of liaison 'l' does not expect '.' here", ""}));

INSTANTIATE_TEST_SUITE_P(
    OutsideOfConditions, BadScenes,
    testing::Values(BadScene{kHead2,
                             R"(liaisons:
  l: {force_limit_n: "3 * ^m.position_x_m"}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                             "'force_limit_n' in liaison 'l' cannot ask for 'm.position_x_m'",
                             "a condition or a law of a liaison asks for what is outside its link"},
                    BadScene{kHead2,
                             R"(liaisons:
  l: {parameters: {k: 3}, elasticity: "k^[2] * elongation_m"}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                             "elasticity of liaison 'l' does not expect '[' here", ""}));

}  // namespace
}  // namespace cordis::scene
