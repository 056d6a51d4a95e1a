// tests/scene/whole_signal_test.cpp -- signals of a whole: bodies, many values, contacts, several
// liaisons.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sim_node/engine/core/vector_width.h"
#include "sim_node/scene/signal.h"
#include "tests/scene/scene_text.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/filled.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

/// A scene in motion, with its signals by name.
class WholeRun {
 public:
  explicit WholeRun(Scene scene, engine::VectorWidth width = engine::best_vector_width())
      : scene_(std::move(scene)),
        world_(std::make_shared<const engine::Network>(scene_.network), width) {}

  void step(int count) {
    for (int i = 0; i < count; ++i) world_.step();
  }
  std::map<std::string, double> values() const {
    std::vector<double> row(scene_.signals.count());
    scene_.signals.read(world_, row.data());
    std::map<std::string, double> values;
    for (std::size_t s = 0; s < row.size(); ++s) {
      values[scene_.signals.signals()[s].name] = row[s];
    }
    return values;
  }
  engine::World& world() { return world_; }
  const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
  engine::World world_;
};

std::string problem_of(int space, const std::string& text) {
  config::Problems problems;
  load_scene_text(scene_head(space) + text, "t", problems);
  return problems.all().empty() ? "" : problems.all()[0].message;
}

const char* const kFlyingDisc = R"(matter:
  disc: {kind: disc, center_m: [1, 2], radius_m: 0.05, spacing_m: 0.02, mass_kg: 0.003,
         stiffness_n_per_m: 300, viscosity_n_s_per_m: 0.02, velocity_m_per_s: [3, -1], spin_rad_per_s: 30}
  other: {kind: mass, mass_kg: 5, at_m: [0, 0], velocity_m_per_s: [1, 1]}
signals:
  px: {of: disc, quantity: momentum, axis: x}
  py: {of: disc, quantity: momentum, axis: y}
  spin: {of: disc, quantity: angular_momentum}
  turn: {of: disc, quantity: angular_momentum, about_m: [0.5, 0]}
  cx: {of: disc, quantity: center_of_mass, axis: x}
  cy: {of: disc, quantity: center_of_mass, axis: y}
)";

TEST(SignalOfAWhole, MomentaOfAFreeBodyStayConstant) {
  WholeRun run(sound_scene(2, kFlyingDisc));
  const auto before = run.values();
  const double mass = 0.003 * static_cast<double>(run.scene().network.mats.size() - 1);
  EXPECT_NEAR(before.at("px"), 3.0 * mass, 1e-12);
  EXPECT_GT(before.at("spin"), 1e-4);

  run.step(2000);

  const auto after = run.values();
  for (const char* name : {"px", "py", "spin", "turn"}) {
    // rounding alone; what turns is 1000 times smaller than what the axes are away
    EXPECT_NEAR(after.at(name), before.at(name), 1e-12) << name;
  }
  EXPECT_NEAR(after.at("cx"), before.at("cx") + 3.0 * 2.0, 1e-10);
  EXPECT_NEAR(after.at("cy"), before.at("cy") - 1.0 * 2.0, 1e-10);
}

TEST(SignalOfAWhole, AngularMomentumIsKeptByIntegratorsAsTheDocumentsSay) {
  const auto change = [](const std::string& integrator) {
    std::string text = kFlyingDisc;
    const std::string damper = ", viscosity_n_s_per_m: 0.02";
    text.erase(text.find(damper), damper.size());  // symplectic4 takes none
    config::Problems problems;
    Scene scene = load_scene_text(test::filled(R"(cordis: 1
space: 2
step: {rate_hz: 1000, integrator: <integrator>}
)",
                                               {{"integrator", integrator}}) +
                                      text,
                                  "t", problems);
    EXPECT_EQ(problems.text(), "");
    WholeRun run(std::move(scene));
    const double before = run.values().at("spin");
    run.step(2000);
    return std::abs(run.values().at("spin") / before - 1.0);
  };
  for (const char* integrator : {"cordis", "symplectic4"}) {
    EXPECT_LT(change(integrator), 1e-8) << integrator;
  }
  EXPECT_GT(change("implicit"), 1e-6);
}

TEST(SignalOfAWhole, MomentaAgreeWithSumsOverPositions) {
  WholeRun run(sound_scene(2, kFlyingDisc));
  run.step(99);
  const Eigen::Matrix4Xd before = run.world().positions();  // no view
  run.step(1);
  const engine::Columns& after = run.world().positions();

  Vec3 momentum = Vec3::Zero();
  Vec3 center = Vec3::Zero();
  Vec3 turn = Vec3::Zero();
  const auto count = static_cast<Eigen::Index>(run.scene().network.mats.size() - 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec3 x = after.col(i).head<3>();
    const Vec3 velocity = (x - Vec3(before.col(i).head<3>())) * 1000.0;
    momentum += 0.003 * velocity;
    center += x / static_cast<double>(count);
    turn += 0.003 * (x - Vec3(0.5, 0.0, 0.0)).cross(velocity);
  }
  const Vec3 spin = turn - (center - Vec3(0.5, 0.0, 0.0)).cross(momentum);
  const auto values = run.values();
  EXPECT_NEAR(values.at("px"), momentum.x(), 1e-12);
  EXPECT_NEAR(values.at("py"), momentum.y(), 1e-12);
  EXPECT_NEAR(values.at("cx"), center.x(), 1e-12);
  EXPECT_NEAR(values.at("cy"), center.y(), 1e-12);
  EXPECT_NEAR(values.at("turn"), turn.z(), 1e-12);
  EXPECT_NEAR(values.at("spin"), spin.z(), 1e-12);
}

TEST(SignalOfAWhole, CenterOfMassFallsAsAPoint) {
  WholeRun run(sound_scene(3, R"(world: {gravity_m_per_s2: [0, 0, -9.81]}
matter:
  jelly: {kind: lattice, structure: cubic, counts: [3, 3, 3], corner_m: [0, 0, 5], spacing_m: 0.1, mass_kg: 0.01,
          stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.1, spin_rad_per_s: [1, 2, 3]}
  wall: {kind: fixed, at_m: [9, 9, 9]}
signals:
  z: {of: [jelly, wall], quantity: center_of_mass, axis: z}
  lx: {of: jelly, quantity: angular_momentum, axis: x}
)"));
  const auto before = run.values();
  EXPECT_NEAR(before.at("z"), 5.1, 1e-12);  // fixed points have no mass

  run.step(500);

  const auto after = run.values();
  EXPECT_NEAR(after.at("z"), 5.1 - 0.5 * 9.81 * 0.25, 1e-11);  // the scheme is exact for a parabola
  EXPECT_NEAR(after.at("lx"), before.at("lx"), 1e-12);
}

TEST(SignalOfAWhole, TakesTheLargestSmallestMeanAndSumOfMatsAndLinks) {
  WholeRun run(sound_scene(2, R"yaml(matter:
  s: {kind: string, count: 7, mass_kg: 0.01, from_m: [0, 0], to_m: [1, 0], ends: fixed, stiffness_n_per_m: 100,
      displacement_m: [0, "0.1 * sin(pi * x_m)"]}
signals:
  fast: {of: s, quantity: speed, take: largest}
  low: {of: "s[1..5]", quantity: position, axis: y, take: smallest}
  mean: {of: s, quantity: position, axis: y, take: mean}
  force_sum: {of: s, quantity: force, axis: y, take: sum}
  tight: {of: s.links, quantity: elongation, take: largest}
)yaml"));
  run.step(77);

  const auto values = run.values();
  double fast = 0.0;
  double low = 1.0;
  double sum = 0.0;
  double force_sum = 0.0;
  double tight = -1.0;
  for (std::uint32_t i = 0; i < 7; ++i) {
    fast = std::max(fast, run.world().velocity(i).norm());
    if (i > 0 && i < 6) low = std::min(low, run.world().position(i).y());
    sum += run.world().position(i).y();
    force_sum += run.world().link_force(i).y();
    if (i == 6) continue;
    const double length = (run.world().position(i + 1) - run.world().position(i)).norm();
    tight = std::max(tight, length - run.scene().network.links[i].rest_length);
  }
  EXPECT_EQ(values.at("fast"), fast);
  EXPECT_EQ(values.at("low"), low);
  EXPECT_EQ(values.at("mean"), sum / 7.0);
  EXPECT_EQ(values.at("force_sum"), force_sum);
  EXPECT_EQ(values.at("tight"), tight);
}

/// Random balls that fall on a floor of fixed balls and on each other, by one of several laws.
std::string heap(std::mt19937& random, const std::string& extra) {
  const std::array<const char*, 5> laws{
      "{kind: state_machine, stiffness_n_per_m: 900, viscosity_n_s_per_m: 0.5, pulls: false, "
      "range: rest}",
      "{kind: state_machine, elasticity: {kind: lennard_jones, depth_j: 0.0005, diameter_m: 0.09, "
      "cut_m: 0.2}}",
      "{kind: state_machine, elasticity: '-40 * max(0, 0.1 - distance_m)', viscosity_n_s_per_m: "
      "0.1, range_m: 0.1}",
      "{kind: state_machine, stiffness_n_per_m: 600, viscosity_n_s_per_m: 0.3, pulls: false, "
      "range: rest, "
      "friction: {static: 0.6, stiffness_n_per_m: 300, viscosity_n_s_per_m: 0.5}}",
      "{range: rest, states: {apart: {exits: [{to: stuck, when: elongation_m < 0}]}, stuck: "
      "{stiffness_n_per_m: 300, viscosity_n_s_per_m: 0.3, exits: [{to: apart, when: elongation_m > "
      "0.01}]}}}"};
  std::string text =
      R"(world: {gravity_m_per_s2: [0, -9.81], viscosity_n_s_per_m: 0.02}
liaisons:
  land: )";
  text += laws[random() % laws.size()];
  text += "\nmatter:\n  floor: {kind: fixed, ball: {radius_m: 0.05}, at_m: [";
  for (int i = 0; i < 12; ++i) text += "[" + std::to_string(0.08 * i) + ", 0], ";
  text += "]}\n";
  for (const char* name : {"a", "b"}) {
    text +=
        std::string("  ") + name + ": {kind: mass, ball: {mass_kg: 0.01, radius_m: 0.05}, at_m: [";
    for (int i = 0; i < 5; ++i) {
      text += "[" + std::to_string(0.1 + 0.17 * i + 0.0001 * static_cast<double>(random() % 300)) +
              ", " + std::to_string(*name == 'a' ? 0.13 : 0.25) + "], ";
    }
    text += "]}\n";
  }
  const char* const kLinks =
      random() % 2 == 0 ? "links:\n  - {liaison: land, within: [floor, a, b]}\n" : R"(links:
  - {liaison: land, within: [a, b]}
  - {liaison: land, between_sets: [[a, b], floor]}
)";
  return text + kLinks + extra;
}

const char* const kHeapSignals = R"(signals:
  on_floor: {of: floor, quantity: force, axis: y, take: sum}
  on_floor_x: {of: floor, quantity: force, axis: x, take: sum}
  a: {of: a, by: floor, quantity: contact_force, axis: y}
  b: {of: b, by: floor, quantity: contact_force, axis: y}
  ab: {of: [a, b], by: floor, quantity: contact_force, axis: y}
  ab_x: {of: [a, b], by: floor, quantity: contact_force, axis: x}
  of_a: {of: a, quantity: force, axis: y, take: sum}
  a_by_b: {of: a, by: b, quantity: contact_force, axis: y}
  b_by_a: {of: b, by: a, quantity: contact_force, axis: y}
)";

TEST(SignalOfAWhole, ContactForceIsWhatTheOtherBodyTakes) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (int trial = 0; trial < 20; ++trial) {
    const std::string text = heap(random, kHeapSignals);
    SCOPED_TRACE(text);
    WholeRun run(sound_scene(2, text));
    bool has_touched = false;
    for (int n = 0; n < 400; ++n) {
      run.step(1);
      auto values = run.values();
      // sums of at most 60 pairs, each below 100 N, in another order
      constexpr double kRounding = 1e-11;
      ASSERT_NEAR(values["ab"], -values["on_floor"], kRounding) << n;
      ASSERT_NEAR(values["ab_x"], -values["on_floor_x"], kRounding) << n;
      ASSERT_NEAR(values["a"] + values["b"], values["ab"], kRounding) << n;
      ASSERT_NEAR(values["a"] + values["a_by_b"], values["of_a"], kRounding) << n;
      ASSERT_EQ(values["a_by_b"], -values["b_by_a"]) << n;
      has_touched = has_touched || values["ab"] != 0.0;
    }
    EXPECT_TRUE(has_touched);
  }
}

TEST(SignalOfAWhole, ContactForceIsThereWithEveryIntegratorThatTakesSets) {
  for (const char* law : {"{stiffness_n_per_m: 1000, pulls: false, range: rest}",
                          "{elasticity: {kind: lennard_jones, depth_j: 0.001, diameter_m: 0.1, "
                          "cut_m: 0.3}, range_m: 0.3}"}) {
    for (const char* integrator : {"cordis", "leapfrog", "symplectic4", "implicit"}) {
      SCOPED_TRACE(std::string(law) + integrator);
      config::Problems problems;
      Scene scene = load_scene_text(test::filled(R"(cordis: 1
space: 2
step: {rate_hz: 2000, integrator: <integrator>}
liaisons: {land: <law>}
matter:
  floor: {kind: fixed, ball: {radius_m: 0.05}, at_m: [[0, 0], [0.08, 0]]}
  a: {kind: mass, ball: {mass_kg: 1, radius_m: 0.05}, at_m: [0.03, 0.07]}
links: [{liaison: land, between_sets: [a, floor]}]
signals:
  of_a: {of: a, quantity: force, axis: y}
  a: {of: a, by: floor, quantity: contact_force, axis: y}
)",
                                                 {{"integrator", integrator}, {"law", law}}),
                                    "t", problems);
      ASSERT_EQ(problems.text(), "");
      WholeRun run(std::move(scene));
      run.step(3);
      auto values = run.values();
      EXPECT_NE(values["a"], 0.0);
      EXPECT_NEAR(values["a"], values["of_a"], 1e-12 * std::abs(values["of_a"]));
    }
  }
}

TEST(SignalOfAWhole, HasTheSameBitsAtEveryVectorWidthAndLeavesNoTraceInTheHash) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 8; ++trial) {
    std::mt19937 same = random;
    const std::string text = heap(random, kHeapSignals);
    WholeRun plain(sound_scene(2, heap(same, "")));
    plain.step(300);
    std::map<std::string, double> known;
    for (const engine::VectorWidth width : engine::supported_vector_widths()) {
      WholeRun run(sound_scene(2, text), width);
      run.step(300);
      if (known.empty()) known = run.values();
      EXPECT_EQ(run.values(), known) << to_string(width);
      EXPECT_EQ(run.world().state_hash(), plain.world().state_hash());
    }
  }
}

TEST(SignalOfAWhole, ContactForceStandsInASnapshot) {
  std::mt19937 random(3);
  WholeRun run(sound_scene(2, heap(random, kHeapSignals)));
  run.step(250);
  const auto values = run.values();
  const engine::Snapshot snapshot = run.world().snapshot();
  run.step(20);
  run.world().restore(snapshot);
  EXPECT_EQ(run.values(), values);
}

TEST(SignalOfAWhole, ContactForceOfWhatHasComeToRestIsItsWeight) {
  config::Problems problems;
  WholeRun run(load_scene_text(R"(cordis: 1
space: 2
step: {rate_hz: 2000, freeze: {tolerance_m: 1.0e-6}}
world: {gravity_m_per_s2: [0, -10]}
liaisons:
  land: {kind: state_machine, stiffness_n_per_m: 600, viscosity_n_s_per_m: 3, pulls: false, range: rest}
matter:
  floor: {kind: plane, at_m: [0, 0], normal: y}
  balls: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.02}, at_m: [[0, 0.02], [1, 0.03]]}
links:
  - {liaison: land, between_sets: [balls, floor]}
signals:
  f: {of: balls, by: floor, quantity: contact_force, axis: y}
)",
                               "t", problems));
  ASSERT_EQ(problems.text(), "");
  run.step(8000);
  EXPECT_NEAR(run.values().at("f"), 2.0, 1e-3);
}

TEST(SignalOfAWhole, ConditionsMayAskForIt) {
  WholeRun run(sound_scene(2, R"(world: {gravity_m_per_s2: [0, -10]}
liaisons:
  fuse: {states: {whole: {stiffness_n_per_m: 1, exits: [{to: gone, when: height < 0.5 or fast > 100}]}, gone: {final: true}}}
matter:
  pair: {kind: mass, mass_kg: 1, at_m: [[0, 1], [1, 1]]}
  wall: {kind: fixed, at_m: [[5, 5], [6, 5]]}
links:
  - {liaison: fuse, between: ["wall[0]", "wall[1]"]}
signals:
  height: {of: pair, quantity: center_of_mass, axis: y}
  fast: {of: pair, quantity: speed, take: largest}
  state: {of: fuse, quantity: state}
)"));
  for (int n = 0; n < 400; ++n) {
    const bool was_low = run.values().at("height") < 0.5;
    run.step(1);
    ASSERT_EQ(run.values().at("state") == 1.0, was_low) << n;
  }
  EXPECT_EQ(run.values().at("state"), 1.0);
}

TEST(SignalOfAWhole, LinksWithoutANameAreCalledAfterTheirLiaison) {
  WholeRun run(sound_scene(1, R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 10, rest_m: 0}
  t: {kind: spring, stiffness_n_per_m: 20, rest_m: 0}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 1, 3, 6, 10]}
links:
  - {liaison: s, between: ["a[0]", "a[1]"]}
  - {liaison: t, between: ["a[0]", "a[2]"]}
  - {liaison: s, between: ["a[1]", "a[2]"]}
  - {liaison: s, between: ["a[2]", "a[3]"], name: own}
  - {liaison: s, between: ["a[3]", "a[4]"]}
signals:
  t: {of: t, quantity: distance}
  s0: {of: "s[0]", quantity: distance}
  s1: {of: "s[1]", quantity: distance}
  s2: {of: "s[2]", quantity: distance}
  all: {of: s, quantity: distance, take: sum}
  own: {of: own, quantity: distance}
)"));
  auto values = run.values();
  EXPECT_EQ(values["t"], 3.0);
  EXPECT_EQ(values["s0"], 1.0);
  EXPECT_EQ(values["s1"], 2.0);
  EXPECT_EQ(values["s2"], 4.0);
  EXPECT_EQ(values["all"], 7.0);
  EXPECT_EQ(values["own"], 3.0);
}

TEST(SignalOfAWhole, PiecesAreCountedOverSeveralLiaisons) {
  WholeRun run(sound_scene(2, R"(liaisons:
  stick: {range: rest, states: {apart: {exits: [{to: stuck, when: elongation_m < 0}]}, stuck: {stiffness_n_per_m: 1, final: true}}}
  fuse: {states: {whole: {stiffness_n_per_m: 1, exits: [{to: gone, when: age_s >= 0.1}]}, gone: {final: true}}}
matter:
  row: {kind: mass, at_m: [[0, 0], [1.9, 0], [3.8, 0]], ball: {mass_kg: 1, radius_m: 1}}
  far: {kind: mass, at_m: [[0, 9], [1.9, 9], [9, 9]], ball: {mass_kg: 1, radius_m: 1}}
links:
  - {liaison: stick, within: row}
  - {liaison: stick, within: far}
  - {liaison: fuse, between: ["row[0]", "far[0]"]}
signals:
  stuck: {of: stick, quantity: pieces}
  all: {of: [stick, fuse], quantity: pieces}
  bonds: {of: [fuse, stick], quantity: bonds}
)"));
  EXPECT_EQ(run.values().at("all"), 5.0);  // the fuse alone joins
  run.step(1);
  EXPECT_EQ(run.values().at("stuck"), 3.0);
  EXPECT_EQ(run.values().at("all"), 2.0);
  EXPECT_EQ(run.values().at("bonds"), 4.0);
  run.step(150);
  EXPECT_EQ(run.values().at("all"), 3.0);
  EXPECT_EQ(run.values().at("bonds"), 3.0);
}

TEST(SignalOfAWhole, SaysWhatCannotBeAskedFor) {
  const std::string head = R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 1, rest_m: 1}
  m: {kind: maxwell, stiffness_n_per_m: 1, viscosity_n_s_per_m: 1}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
  wall: {kind: fixed, at_m: [[5, 5], [6, 5]]}
links:
  - {liaison: s, between: ["wall[0]", "a[0]"]}
  - {liaison: m, between: ["wall[1]", "a[0]"]}
signals:
  p: )";
  EXPECT_EQ(problem_of(2, head + "{of: wall, quantity: momentum, axis: x}"),
            "it has no mass that moves, so it has no momentum");
  EXPECT_EQ(problem_of(2, head + "{of: a, quantity: momentum}"),
            "missing key 'axis' in signal 'p'");
  EXPECT_EQ(problem_of(2, head + "{of: a, quantity: angular_momentum, axis: z}"),
            "unknown key 'axis' in signal 'p'");
  EXPECT_EQ(problem_of(2, head + "{of: a, by: a, quantity: contact_force, axis: x}"),
            "'a[0]' is in both bodies");
  EXPECT_EQ(problem_of(2, head + "{of: a, by: wall, quantity: contact_force, axis: x}"),
            "no liaison of sets acts between these bodies");
  EXPECT_EQ(problem_of(2, head + "{of: [s, m], quantity: distance, take: mean}"),
            "these links are of several kinds");
  EXPECT_EQ(problem_of(2, head + "{of: a, quantity: pieces, take: sum}"),
            "a number of pieces is one value");
  EXPECT_EQ(problem_of(2, head + "{of: a, quantity: speed}"),
            "a signal is of one MAT or one link, and 'a' has 2");
  const std::string sets = R"(liaisons:
  soft: {stiffness_n_per_m: 1, pulls: false, range: rest}
  hard: {stiffness_n_per_m: 9, pulls: false, range: rest}
matter: {a: {kind: mass, at_m: [[0, 0], [1, 0]], ball: {mass_kg: 1, radius_m: 0.1}}}
links: [{liaison: soft, within: a}, {liaison: hard, within: a}]
signals:
  p: )";
  EXPECT_EQ(problem_of(2, sets + "{of: [soft, hard], quantity: bonds}"),
            "pairs of liaisons of one state are never bound");
  EXPECT_EQ(problem_of(2, sets + "{of: [soft, hard], quantity: pieces, near_m: 0.1}"),
            "pieces over several liaisons are counted by bound pairs alone");
}

TEST(SignalOfAWhole, IsReadWithoutAllocating) {
  std::mt19937 random(11);
  WholeRun run(sound_scene(2, heap(random, kHeapSignals)));
  run.step(100);
  std::vector<double> values(run.scene().signals.count());

  const test::AllocationGuard guard;
  run.world().step();
  run.scene().signals.read(run.world(), values.data());

  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace cordis::scene
