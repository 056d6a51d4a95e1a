// tests/scene/signal_test.cpp
#include "sim_node/scene/signal.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"
#include "tests/support/allocation_guard.h"

namespace cordis::scene {
namespace {

/// The signals of a scene after some steps, by name.
class Observed {
 public:
  explicit Observed(Scene scene)
      : scene_(std::move(scene)), world_(std::make_shared<const engine::Network>(scene_.network)) {}

  void step(int count) {
    for (int i = 0; i < count; ++i) world_.step();
  }
  double value(const std::string& name) const {
    std::vector<double> values(scene_.signals.count());
    scene_.signals.read(world_, values.data());
    for (std::size_t s = 0; s < values.size(); ++s) {
      if (scene_.signals.signals()[s].name == name) return values[s];
    }
    ADD_FAILURE() << "no signal " << name;
    return 0.0;
  }
  engine::World& world() { return world_; }
  const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
  engine::World world_;
};

TEST(SignalReader, ReportsWhatPartIsAwakeAndKeepsAwakeWhoseForceIsAskedFor) {
  config::Problems problems;
  Observed run(load_scene_text(
      R"(cordis: 1
space: 2
step: {rate_hz: 1000, freeze: {tolerance_m: 1e-6}}
matter:
  s: {kind: string, count: 5, mass_kg: 0.01, from_m: [0, 0], to_m: [1, 0],
    ends: fixed, stiffness_n_per_m: 100, tension_n: 1}
signals:
  f: {of: "s[2]", quantity: force, axis: x}
  a: {quantity: awake}
)",
      "t", problems));
  ASSERT_EQ(problems.text(), "");

  EXPECT_EQ(run.value("a"), 1.0);
  run.step(110);

  EXPECT_LT(run.value("a"), 0.5);
  EXPECT_GT(run.value("a"), 0.1);
  EXPECT_FALSE(run.world().is_asleep(run.scene().network.kept_awake.at(0)));
}

TEST(SignalReader, ReportsPositionVelocityAndSpeedOfAFreeMass) {
  Observed run(sound_scene(2,
                           R"(matter:
  a: {kind: mass, mass_kg: 2, at_m: [1, 2], velocity_m_per_s: [3, -4]}
signals:
  x: {of: a, quantity: position, axis: x}
  y: {of: "a[0]", quantity: position, axis: y}
  vy: {of: a, quantity: velocity, axis: y}
  v: {of: a, quantity: speed}
  e: {quantity: energy}
  k: {quantity: kinetic_energy}
)"));

  run.step(100);  // 0.1 s of straight motion

  EXPECT_NEAR(run.value("x"), 1.3, 1e-12);
  EXPECT_NEAR(run.value("y"), 1.6, 1e-12);
  EXPECT_NEAR(run.value("vy"), -4.0, 1e-9);
  EXPECT_NEAR(run.value("v"), 5.0, 1e-9);
  EXPECT_NEAR(run.value("k"), 25.0, 1e-8);
  EXPECT_NEAR(run.value("e"), 25.0, 1e-8);
  EXPECT_EQ(run.scene().signals.signals()[0].unit, "m");
  EXPECT_EQ(run.scene().signals.signals()[2].unit, "m/s");
  EXPECT_EQ(run.scene().signals.signals()[4].unit, "J");
}

TEST(SignalReader, ReportsDistanceElongationSpeedAndTensionOfALink) {
  Observed run(sound_scene(2,
                           R"(liaisons:
  s: {kind: spring_damper, stiffness_n_per_m: 10, viscosity_n_s_per_m: 2, rest_m: 4}
matter:
  wall: {kind: fixed, at_m: [0, 0]}
  a: {kind: mass, mass_kg: 1000000, at_m: [3, 4], velocity_m_per_s: [6, 8]}
links:
  - {liaison: s, name: rope, between: [wall, a]}
signals:
  d: {of: rope, quantity: distance}
  e: {of: "rope[0]", quantity: elongation}
  g: {of: rope, quantity: speed}
  f: {of: rope, quantity: force}
  onwall: {of: wall, quantity: force, axis: y}
  stored: {quantity: elastic_energy}
)"));

  run.step(1);  // so heavy a mass goes straight on: 10 m/s along the link

  EXPECT_NEAR(run.value("d"), 5.01, 1e-6);
  EXPECT_NEAR(run.value("e"), 1.01, 1e-6);
  EXPECT_NEAR(run.value("g"), 10.0, 1e-3);
  EXPECT_NEAR(run.value("f"), 10 * 1.01 + 2 * 10.0, 1e-2);
  EXPECT_NEAR(run.value("onwall"), 0.8 * (10 * 1.0 + 2 * 10.0), 1e-2);  // of the step done: at 5 m
  // the scheme stores K e(n) e(n-1) / 2: the elongation grew from 1 to 1.01 m
  EXPECT_NEAR(run.value("stored"), 0.5 * 10 * 1.01 * 1.0, 1e-4);
}

TEST(SignalReader, ReportsOfEachLiaisonOfSeveralInParallel) {
  Observed run(sound_scene(1,
                           R"(matter:
  a: {kind: fixed, at_m: 0}
  b: {kind: mass, mass_kg: 1, at_m: 0.5}
liaisons:
  thread: {kind: spring, stiffness_n_per_m: 10, rest_m: 0.2}
  cord: {parallel: [thread, {kind: spring, stiffness_n_per_m: 100, rest_m: 0.5}]}
links:
  - {liaison: cord, between: [a, b], name: rope}
signals:
  soft: {of: rope.thread, quantity: elongation}
  hard: {of: rope.spring, quantity: elongation}
)"));

  EXPECT_DOUBLE_EQ(run.value("soft"), 0.3);
  EXPECT_DOUBLE_EQ(run.value("hard"), 0.0);
}

TEST(SignalReader, GivesLinksInOneDimensionTheirSign) {
  Observed run(sound_scene(1,
                           R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 10, rest_m: -1}
matter:
  wall: {kind: fixed, at_m: 0}
  a: {kind: mass, mass_kg: 1, at_m: -3}
links:
  - {liaison: s, name: rope, between: [wall, a]}
signals:
  d: {of: rope, quantity: distance}
  e: {of: rope, quantity: elongation}
  f: {of: rope, quantity: force}
  x: {of: a, quantity: position}
)"));
  EXPECT_EQ(run.value("d"), -3.0);
  EXPECT_EQ(run.value("e"), -2.0);
  EXPECT_EQ(run.value("f"), -20.0);
  EXPECT_EQ(run.value("x"), -3.0);
}

TEST(SignalReader, OfAPortOfOneAxisIsSeenAlongItFromItsRest) {
  Observed run(sound_scene(2,
                           R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 100, rest_m: 1}
matter:
  a: {kind: mass, mass_kg: 1000000, at_m: [1, 3]}
ports:
  p: {device: d, axes: [0], role: mass, coupling: direct, at_m: [1, 2], along: -y}
links:
  - {liaison: s, between: [p, a]}
signals:
  p: {of: p, quantity: position}
  y: {of: p, quantity: position, axis: y}
  f: {of: p, quantity: force}
)"));

  run.world().impose_position(1, engine::Vec3(1.0, 1.75, 0.0));
  run.step(1);

  EXPECT_NEAR(run.value("p"), 0.25, 1e-15);  // downwards
  EXPECT_NEAR(run.value("y"), 1.75, 1e-15);
  EXPECT_NEAR(run.value("f"), -25.0, 1e-6);  // the spring pulls it up again
}

TEST(SignalReader, ReportsTheAccountOfEnergy) {
  Observed run(sound_scene(2,
                           R"(world: {gravity_m_per_s2: [0, -10], viscosity_n_s_per_m: 0.5}
matter:
  a: {kind: mass, mass_kg: 2, at_m: [0, 1]}
signals:
  k: {quantity: kinetic_energy}
  g: {quantity: gravity_energy}
  d: {quantity: dissipated_energy}
  w: {quantity: port_work}
  e: {quantity: energy}
)"));
  const double before = run.value("e");

  run.step(200);

  EXPECT_NEAR(before, 20.0, 1e-2);  // m g h; the velocity of the half-step before is not quite 0
  EXPECT_GT(run.value("d"), 0.1);
  EXPECT_EQ(run.value("w"), 0.0);
  EXPECT_DOUBLE_EQ(run.value("e"), run.value("k") + run.value("g"));
  EXPECT_NEAR(run.value("e") + run.value("d"), before, 1e-2);
}

/// Two pairs of balls that touch, and one that flies at the second; what touches sticks.
const char* const kGlue =
    R"(liaisons:
  spring: {kind: spring, stiffness_n_per_m: 1}
  stick:
    range: rest
    states:
      apart: {exits: [{to: stuck, when: elongation_m < 0}]}
      stuck: {stiffness_n_per_m: 1, exits: [{to: apart, when: elongation_m > 1}]}
matter:
  row: {kind: mass, at_m: [[0, 0], [1.5, 0], [6, 0], [7.5, 0]], ball: {mass_kg: 1, radius_m: 1}}
  thrown: {kind: mass, at_m: [6, 2.5], velocity_m_per_s: [0, -10], ball: {mass_kg: 1, radius_m: 1}}
links:
  - {liaison: stick, within: [row, thrown], name: glue}
)";

TEST(SignalReader, CountsThePiecesAndBondsOfASetOfBalls) {
  Observed run(sound_scene(2, kGlue + std::string(R"(signals:
  p: {of: glue, quantity: pieces}
  b: {of: glue, quantity: bonds}
  near: {of: glue, quantity: pieces, near_m: 2.4}
  row: {of: ["row[1..2]", thrown], quantity: pieces, near_m: 4}
)")));
  EXPECT_EQ(run.value("p"), 5.0);  // nothing has touched yet
  EXPECT_EQ(run.value("b"), 0.0);
  EXPECT_EQ(run.value("near"), 3.0);
  EXPECT_EQ(run.value("row"), 2.0);  // 2.5 m from the thrown one to its target

  run.step(1);
  EXPECT_EQ(run.value("p"), 3.0);
  EXPECT_EQ(run.value("b"), 2.0);

  run.step(70);  // 0.7 m further down
  EXPECT_EQ(run.value("p"), 2.0);
  EXPECT_EQ(run.value("near"), 2.0);
  EXPECT_EQ(run.value("b"), 3.0);
}

TEST(SignalReader, CountsThePiecesAndBondsOfLinksThatBreak) {
  Observed run(sound_scene(2,
                           R"(liaisons:
  fuse:
    parameters: {life_s: 1}
    states:
      whole: {stiffness_n_per_m: 1, exits: [{to: broken, when: age_s >= life_s}]}
      broken: {final: true}
matter:
  a: {kind: string, count: 4, mass_kg: 1, from_m: [0, 0], to_m: [3, 0], liaison: fuse}
  b: {kind: mass, mass_kg: 1, at_m: [0, 1]}
links:
  - {liaison: fuse, between: ["a[0]", b], name: early, life_s: 0.01}
signals:
  all: {of: [a.links, early], quantity: pieces}
  p: {of: a.links, quantity: pieces}
  b: {of: [a.links, early], quantity: bonds}
)"));
  EXPECT_EQ(run.value("all"), 1.0);
  EXPECT_EQ(run.value("b"), 4.0);

  run.step(100);  // 0.1 s
  EXPECT_EQ(run.value("all"), 2.0);
  EXPECT_EQ(run.value("p"), 1.0);
  EXPECT_EQ(run.value("b"), 3.0);

  run.step(1000);
  EXPECT_EQ(run.value("p"), 4.0);
  EXPECT_EQ(run.value("b"), 0.0);
}

TEST(SignalReader, SaysWhatCannotBeCounted) {
  const auto problem = [](const std::string& signal) {
    config::Problems problems;
    load_scene_text(scene_head(2) + kGlue +
                        R"(  - {liaison: spring, within: row, range_m: 1, name: s}
  - {liaison: spring, between: [thrown, row], name: stiff}
signals:
  p: )" + signal,
                    "t", problems);
    return problems.all().empty() ? std::string() : problems.all()[0].message;
  };
  EXPECT_EQ(problem("{of: row, quantity: pieces}"), "missing key 'near_m' in signal 'p'");
  EXPECT_EQ(problem("{of: glue, quantity: pieces, near_m: 0}"),
            "'near_m' in signal 'p' must be > 0, got 0");
  EXPECT_EQ(problem("{of: s, quantity: pieces}"),
            "pairs of a liaison of one state are never bound");
  EXPECT_EQ(problem("{of: stiff, quantity: pieces}"), "a link has no quantity 'pieces'");
  EXPECT_EQ(problem("{of: glue, quantity: bonds, near_m: 1}"),
            "unknown key 'near_m' in signal 'p'");
}

TEST(SignalReader, SaysWhatIsWrongWithASignalOfMatterThatIsWrongItself) {
  config::Problems problems;
  load_scene_text(scene_head(2) + R"(matter:
  a: {kind: mass, mass_kg: -1, at_m: [0, 0]}
signals:
  w: {of: a, quantity: postion, axis: x}
  x: {of: a, quantity: position}
  y: {of: a, quantity: speed, unit: m}
  z: {of: a, quantity: position, axis: y, take: mean}
)",
                  "t", problems);
  std::vector<std::string> said;
  for (const config::Problem& problem : problems.in_order()) said.push_back(problem.message);
  EXPECT_EQ(said,
            (std::vector<std::string>{
                "'mass_kg' in matter 'a' must be > 0, got -1", "nothing has a quantity 'postion'",
                "missing key 'axis' in signal 'x'", "unknown key 'unit' in signal 'y'"}));
}

TEST(SignalReader, SaysWhatIsWrongWithASignalOfAPartThatIsWrongItself) {
  config::Problems problems;
  load_scene_text(scene_head(1) + R"(parts:
  note: {matter: {s: {kind: string, count: 3, mass_kg: -1, stiffness_n_per_m: 1}}}
matter: {harp: {part: note, repeat: {count: 2}}}
signals:
  a: {of: harp.s, quantity: force, take: sum, axis: y}
  b: {of: harp.s, quantity: force, take: most, sound: maybe}
  c: {of: harp.s, quantity: speed, take: mean, rate: often, full_scale: 2}
  d: {of: harp.s, quantity: pieces, near_m: 0}
  e: {of: harp.s, quantity: contact_force, by: bow}
)",
                  "t", problems);
  std::vector<std::string> said;
  for (const config::Problem& problem : problems.in_order()) said.push_back(problem.message);
  EXPECT_EQ(said, (std::vector<std::string>{
                      "'mass_kg' in matter 's' of part 'note' must be > 0, got -1",
                      "'axis' in signal 'a' must be one of x, got 'y'",
                      "'take' in signal 'b' must be one of largest, smallest, mean, sum, got "
                      "'most'",
                      "'sound' in signal 'b' must be true or false, got 'maybe'",
                      "'rate' in signal 'c' must be one of gesture, step, got 'often'",
                      "'full_scale' is of a sound", "'near_m' in signal 'd' must be > 0, got 0",
                      "no matter or port is named 'bow'"}));
}

TEST(SignalReader, OfEachStepAreThoseThatSayRateStepOrSound) {
  Observed run(sound_scene(2,
                           R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [3, 4]}
signals:
  x: {of: a, quantity: position, axis: x}
  y: {of: a, quantity: position, axis: y, rate: step}
  e: {quantity: energy, rate: gesture}
  s: {of: a, quantity: speed, sound: true, full_scale: 2.5}
)"));
  const SignalReader& reader = run.scene().signals;
  EXPECT_EQ(reader.by_step(), (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(reader.sounds(), (std::vector<std::size_t>{1}));
  EXPECT_EQ(reader.signals()[3].full_scale, 2.5);
  EXPECT_EQ(reader.signals()[1].full_scale, 1.0);
  run.step(3);
  std::vector<double> all(4);
  std::vector<double> some(2);
  reader.read(run.world(), all.data());
  reader.read_by_step(run.world(), some.data());
  EXPECT_EQ(some, (std::vector<double>{all[1], all[3]}));
}

TEST(SignalReader, RefusesARateThatDoesNotGoWithASound) {
  const auto problem = [](const std::string& words) {
    config::Problems problems;
    load_scene_text(
        scene_head(1) + "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nsignals:\n" + words, "t",
        problems);
    return problems.all().empty() ? std::string() : problems.all()[0].message;
  };
  const std::string head = "  p: {of: a, quantity: position, ";
  EXPECT_EQ(problem(head + "sound: true, rate: gesture}\n"), "a sound is taken after each step");
  EXPECT_EQ(problem(head + "full_scale: 2}\n"), "'full_scale' is of a sound");
  EXPECT_EQ(problem(head + "sound: true, full_scale: 0}\n"),
            "'full_scale' in signal 'p' must be > 0, got 0");
  EXPECT_NE(problem(head + "rate: often}\n").find("often"), std::string::npos);
  std::string nine;
  for (int i = 0; i < 9; ++i)
    nine += "  p" + std::to_string(i) + ": {of: a, quantity: position, sound: true}\n";
  EXPECT_EQ(problem(nine), "a scene has at most 8 signals with 'sound: true'");
}

TEST(SignalReader, ReadsWithoutAllocating) {
  Observed run(sound_scene(2,
                           R"(matter:
  a: {kind: string, count: 9, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 10}
signals:
  p: {of: a, quantity: pieces, near_m: 0.2}
  x: {of: "a[3]", quantity: position, axis: x}
  f: {of: "a.links[2]", quantity: force}
  e: {quantity: energy}
)"));
  std::vector<double> values(4);
  run.step(3);

  const test::AllocationGuard guard;
  run.scene().signals.read(run.world(), values.data());

  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace cordis::scene
