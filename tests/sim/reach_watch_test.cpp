// tests/sim/reach_watch_test.cpp -- a scene that goes beyond its certified reach.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/watched_scenes.h"

namespace cordis::sim {
namespace {

/// A ball between a wall and a paddle in a hand. The walls stiffen as they are pressed in: certified
/// for the energy of the start, and for a hand of 1 m/s.
const char* const kPaddle = R"(cordis: 1
name: paddle
space: 1
step: {rate_hz: 1000}
liaisons:
  hit: {kind: state_machine, elasticity: {kind: power, coefficient: 3.0e+5, exponent: 2.5}, pulls: false}
matter:
  wall: {kind: fixed, at_m: -0.02}
  ball: {kind: mass, mass_kg: 0.01, at_m: 0, velocity_m_per_s: 0.1}
ports:
  paddle: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 0.05}
links:
  - {liaison: hit, between: [wall, ball], rest_m: 0.01}
  - {liaison: hit, between: [ball, paddle], rest_m: 0.01}
)";

/// A paddle that goes down by 40 mm and up again, and what its scene shows once a frame.
class Paddle {
 public:
  explicit Paddle(double hertz) : hertz_(hertz), loaded_(loaded_scene_of(kPaddle)) {}

  /// The bound that is passed, if any, in one second more.
  std::optional<PassedBound> play() {
    Simulation& simulation = loaded_->simulation;
    for (int tick = 0; tick < 1000; ++tick) {
      ++tick_;
      const double phase = std::fmod(hertz_ * tick_ / 1000.0, 1.0);
      const double position = -0.04 * (1.0 - std::abs(2.0 * phase - 1.0));
      simulation.devices()[0].receive(key_sample(static_cast<std::uint64_t>(tick_), position));
      simulation.advance(simulation.steps_of_tick(), events_);
      if (tick % static_cast<int>(loaded_->ticks_per_frame) > 0) continue;
      const PassedBound bound = loaded_->passed_bound(signs_now());
      if (bound != PassedBound::kNone) return bound;
    }
    return std::nullopt;
  }

  LoadedScene& scene() { return *loaded_; }

 private:
  BoundSigns signs_now() {
    const engine::World& world = loaded_->simulation.world();
    return signs_of(world, loaded_->energy.update(world), loaded_->reach);
  }

  double hertz_;
  std::unique_ptr<LoadedScene> loaded_;
  EventRoom events_{64};
  int tick_ = 0;
};

TEST(ReachWatch, IsSilentWhileTheHandStaysWithinTheReach) {
  Paddle paddle(0.5);  // 0.04 m/s
  ASSERT_TRUE(paddle.scene().is_certain);
  ASSERT_FALSE(paddle.scene().reach.is_infinite());

  for (int second = 0; second < 5; ++second) EXPECT_FALSE(paddle.play());
  EXPECT_FALSE(paddle.scene().is_beyond_reach);
}

TEST(ReachWatch, LetsGoOfNothingMerelyBecauseTheReachIsPassed) {
  Paddle paddle(0.5);
  paddle.scene().reach.energy = 1e-6;  // less than the ball has

  EXPECT_FALSE(paddle.play());
  EXPECT_TRUE(paddle.scene().is_beyond_reach);
  EXPECT_TRUE(paddle.scene().is_certain);
}

TEST(ReachWatch, IsKeptByTheShadowOfAWorld) {
  Paddle paddle(0.5);
  const engine::World& world = paddle.scene().simulation.world();
  plan::ReachLimit small;
  small.energy = 0.99 * world.energy().total();
  for (const bool is_small : {true, false}) {
    ShadowWorld shadow(world.shared_network(), is_small ? small : paddle.scene().reach);
    EXPECT_FALSE(shadow.read(std::chrono::milliseconds(0)));
    shadow.hand_over(world);
    const std::optional<WorldFigures> figures = shadow.read(std::chrono::milliseconds(0));
    ASSERT_TRUE(figures);
    EXPECT_EQ(figures->signs.is_beyond_reach, is_small);
    EXPECT_FALSE(figures->signs.makes_energy);
  }
}

TEST(ReachWatch, LetsGoOnceTheStepsMakeEnergyBeyondTheReach) {
  Paddle paddle(25.0);  // 2 m/s
  std::optional<PassedBound> bound;
  for (int second = 0; second < 20 && !bound; ++second) bound = paddle.play();

  EXPECT_TRUE(paddle.scene().is_beyond_reach);
  ASSERT_TRUE(bound);
  EXPECT_EQ(*bound, PassedBound::kEnergy);
  EXPECT_FALSE(paddle.scene().simulation.failed()) << "in time";
}

TEST(ReachWatch, TakesNoEnergyForABoundWithinTheReach) {
  Paddle paddle(0.5);
  EXPECT_EQ(paddle.scene().passed_bound({true, false}), PassedBound::kNone);
  EXPECT_EQ(paddle.scene().passed_bound({true, true}), PassedBound::kEnergy);
  EXPECT_EQ(paddle.scene().passed_bound({false, false}), PassedBound::kNone);
}

TEST(ReachWatch, SeesAPortThatIsFasterThanTheReach) {
  Paddle paddle(25.0);
  engine::World& world = paddle.scene().simulation.world();
  const plan::ReachLimit reach = paddle.scene().reach;
  EXPECT_FALSE(signs_of(world, world.energy(), reach).is_beyond_reach);
  world.impose_position(paddle.scene().simulation.scene().ports[0].mat,
                        engine::Vec3(0.05 + 1.01e-3 * reach.speed, 0, 0));
  world.step();
  EXPECT_TRUE(signs_of(world, world.energy(), reach).is_beyond_reach);
}

/// Atoms in a row. Within a reach are the two fastest of them, not all together.
TEST(ReachWatch, OfASetHoldsTheTwoFastestAgainstTheEnergyOfAPair) {
  const auto loaded = loaded_scene_of(R"(cordis: 1
name: atoms
space: 1
step: {rate_hz: 20000, gesture_rate_hz: 1000}
liaisons:
  lj: {kind: state_machine, elasticity: {kind: lennard_jones, depth_j: 1.0e-4, diameter_m: 0.01, cut_m: 0.025}}
  spring: {kind: spring, stiffness_n_per_m: 1}
matter:
  atoms: {kind: mass, mass_kg: 0.001, at_m: [0, 0.0112, 0.0224, 0.0336, 0.0448], velocity_m_per_s: 0.1}
  ground: {kind: fixed, at_m: -1}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: -2}
links:
  - {liaison: lj, within: atoms, rest_m: 0, range_m: 0.025}
  - {liaison: spring, between: [ground, key]}
)");
  const engine::World& world = loaded->simulation.world();
  ASSERT_EQ(loaded->reach.pairs.size(), 1u);
  ASSERT_TRUE(std::isinf(loaded->reach.energy)) << "no link has such a law";
  plan::ReachLimit reach = loaded->reach;
  const double one = 0.5 * 0.001 * 0.1 * 0.1;
  reach.pairs[0].energy = 2.01 * one;
  EXPECT_FALSE(plan::is_beyond(reach, world, world.energy()));
  reach.pairs[0].energy = 1.99 * one;
  EXPECT_TRUE(plan::is_beyond(reach, world, world.energy()));
  reach.pairs = loaded->reach.pairs;
  reach.energy = 4.99 * one;
  EXPECT_TRUE(plan::is_beyond(reach, world, world.energy())) << "all five";
}

/// A scene without devices and drives: what its loop has seen at the end.
struct Alone {
  PassedBound bound = PassedBound::kNone;
  bool is_beyond_reach = false;
  bool is_error_large = false;
  std::string failure;
};

Alone play_alone(const std::string& text, double duration_s) {
  const auto loaded = loaded_scene_of(text);
  Simulation& simulation = loaded->simulation;
  EventRoom events(64);
  Alone seen;
  while (simulation.simulated_s() < duration_s && !simulation.failed()) {
    if (!simulation.advance(simulation.steps_of_tick(), events)) break;
    if (simulation.tick_count() % loaded->ticks_per_frame > 0) continue;
    const engine::Energy energy = loaded->sample_energy();
    seen.is_error_large = seen.is_error_large || is_error_large(energy);
    const PassedBound bound =
        loaded->passed_bound(signs_of(simulation.world(), energy, loaded->reach));
    if (bound != PassedBound::kNone) simulation.let_devices_go(bound);
  }
  seen.bound = simulation.passed_bound();
  seen.is_beyond_reach = loaded->is_beyond_reach;
  seen.failure = simulation.failure();
  return seen;
}

std::string moved(const std::string& step, const std::string& start, const std::string& liaisons,
                  const std::string& links = "") {
  return test::moved_mass(step, start, liaisons, links + "  - {liaison: c, between: [a, m]}\n");
}

TEST(ReachWatch, WatchesAlsoWhatNothingMovesFromOutside) {
  const std::string well = moved("rate_hz: 1000", "at_m: 1",
                                 R"(  t: {elasticity: '50 - 0*elongation_m'}
  c: {elasticity: '3.0e+4 * elongation_m^3'}
)",
                                 "  - {liaison: t, between: [a, m]}\n");
  for (const std::string& text : {well, std::string(test::kFallOnContact)}) {
    const Alone seen = play_alone(text, 3.0);
    EXPECT_EQ(seen.bound, PassedBound::kEnergy) << text;
    EXPECT_TRUE(seen.is_error_large) << text;
  }
}

TEST(ReachWatch, LeavesASceneAloneThatStaysWithinIts) {
  const Alone seen = play_alone(moved("rate_hz: 10000", "at_m: 0.1, velocity_m_per_s: 1",
                                      "  c: {elasticity: '3.0e+4 * elongation_m^3', rest_m: 0}\n"),
                                2.0);
  EXPECT_FALSE(seen.is_beyond_reach);
  EXPECT_EQ(seen.bound, PassedBound::kNone);
  EXPECT_FALSE(seen.is_error_large);
  EXPECT_EQ(seen.failure, "");
}

/// Balls of a crystal get more energy than the two fastest had at the start. The step is short enough for that.
TEST(ReachWatch, LeavesACrystalAloneWhoseStepIsCertifiedForWhatItsBallsReach) {
  const std::string crystal = R"yaml(cordis: 1
name: crystal
space: 3
step: {rate_hz: <rate>}
matter:
  s: {kind: lattice, structure: fcc, counts: [2,2,2], corner_m: [0,0,0], spacing_m: <spacing>, mass_kg: 0.001, velocity_m_per_s: <velocity>}
liaisons:
  c: {elasticity: {kind: lennard_jones, depth_j: 1.0e-4, diameter_m: 0.01, cut_m: 0.025}}
links: [{liaison: c, within: s}]
)yaml";
  const std::string thrown = test::filled(
      crystal,
      {{"rate", "4000"},
       {"spacing", "0.0112"},
       {"velocity", R"yaml(["0.3*sin(index)","0.3*cos(3*index)","0.3*sin(7*index)"])yaml"}});
  const std::string pressed =
      test::filled(crystal, {{"rate", "8000"}, {"spacing", "0.0098"}, {"velocity", "[0,0,0]"}});
  for (const std::string& text : {thrown, pressed}) {
    const Alone seen = play_alone(text, 5.0);
    EXPECT_FALSE(seen.is_beyond_reach) << text;
    EXPECT_EQ(seen.bound, PassedBound::kNone);
    EXPECT_FALSE(seen.is_error_large);
  }
}

/// A mass that falls into its spring, 40 steps up and down: in each frame it is where it began, at rest.
TEST(ReachWatch, SeesTheEnergyOfAVibrationInStepWithTheFrames) {
  constexpr double kPerStep = 2.0 * 3.14159265358979323846 / 40.0;
  const double stiffness = 0.01 * 2.0 * (1.0 - std::cos(kPerStep)) * 1e6;  // K' = 2 (1 - cos w)
  const auto loaded = loaded_scene_of(test::filled(R"(cordis: 1
name: hanging
space: 1
step: {rate_hz: 1000, gesture_rate_hz: 1000}
world: {gravity_m_per_s2: -9.81}
liaisons: {k: {kind: spring, stiffness_n_per_m: <stiffness>, rest_m: 0}}
matter:
  a: {kind: fixed, at_m: 0}
  m: {kind: mass, mass_kg: 0.01, at_m: 0}
links: [{liaison: k, between: [a, m]}]
)",
                                                   {{"stiffness", std::to_string(stiffness)}}));
  Simulation& simulation = loaded->simulation;
  EventRoom events(64);
  double in_frames = 0.0;
  engine::Energy energy;
  while (simulation.simulated_s() < 2.0) {
    simulation.advance(simulation.steps_of_tick(), events);
    if (simulation.tick_count() % loaded->ticks_per_frame > 0) continue;
    energy = loaded->sample_energy();
    in_frames = std::max(in_frames, energy.kinetic);
  }
  const double kinetic = 0.5 * std::pow(0.01 * 9.81, 2.0) / stiffness;  // (m g)^2 / 2 K
  EXPECT_LT(in_frames, 0.02 * kinetic);
  EXPECT_GT(energy.largest, 0.9 * kinetic);
  EXPECT_LT(energy.largest, 2.2 * kinetic);
  EXPECT_FALSE(is_error_large(energy));
}

TEST(ReachWatch, AnEnergyThatIsNoFiniteNumberIsADivergence) {
  const std::vector<std::string> scenes{
      moved("rate_hz: 1000", "at_m: 0.1",
            "  c: {elasticity: '100*elongation_m - 0.5*speed_m_per_s', rest_m: 0}\n"),
      moved("rate_hz: 44100", "at_m: 0.3",
            R"(  k: {kind: spring, stiffness_n_per_m: 2000, rest_m: 0.1}
  c: {dissipation: '12*speed_m_per_s^3'}
)",
            "  - {liaison: k, between: [a, m]}\n")};
  for (const std::string& text : scenes) {
    const std::string failure = play_alone(text, 4.0).failure;
    EXPECT_NE(failure.find("the scene diverged at step"), std::string::npos) << text;
    EXPECT_NE(failure.find("energy is no finite number below 1e100 J; the fastest is 'm'"),
              std::string::npos)
        << failure;
  }
}

/// Modes have no stiffness of their own that counts. The law counts at the speeds in reach.
TEST(ReachWatch, ADivergenceNamesAPowerOfTheSpeed) {
  const char* const modes = R"yaml(cordis: 1
name: modes
space: 1
step: {rate_hz: 2700, integrator: modal}
matter:
  s: {kind: string, count: 30, mass_kg: 0.001, ends: fixed, stiffness_n_per_m: 10000, displacement_m: ["0.05*sin(0.1*index)"], layout_at_m: [0,0], layout_spacing_m: 0.01}
  b: {kind: fixed, at_m: 0.0}
liaisons:
  d: {dissipation: {kind: power, coefficient: 0.15, exponent: 3}, rest_m: 0}
links:
  - {liaison: d, between: [b, "s[20]"]}
)yaml";
  const std::string failure = play_alone(modes, 2.0).failure;
  EXPECT_NE(failure.find("the scene diverged at step"), std::string::npos);
  EXPECT_NE(failure.find("d ("), std::string::npos) << failure;
  EXPECT_NE(failure.find("is too stiff for 2700 Hz"), std::string::npos) << failure;
  EXPECT_EQ(failure.find("within its limit"), std::string::npos) << failure;
}

/// Where a scene stands says nothing of the energy of its motion.
TEST(ReachWatch, TheLargestEnergyCountsGravityFromTheStartOn) {
  double at_origin = 0.0;
  for (const char* const height : {"0", "1000"}) {
    const auto loaded = loaded_scene_of(test::filled(R"(cordis: 1
name: hanging
space: 2
step: {rate_hz: 1000}
world: {gravity_m_per_s2: [0, -9.81]}
liaisons: {k: {kind: spring_damper, stiffness_n_per_m: 10, viscosity_n_s_per_m: 0, rest_m: 0.1}}
parts:
  pair:
    matter:
      a: {kind: fixed, at_m: [0, 0.1]}
      m: {kind: mass, mass_kg: 0.01, at_m: [0, 0]}
    links: [{liaison: k, between: [a, m]}]
matter:
  pair: {part: pair, translate_m: [0, <height>]}
)",
                                                     {{"height", height}}));
    Simulation& simulation = loaded->simulation;
    EventRoom events(64);
    while (simulation.simulated_s() < 1.0) {
      simulation.advance(simulation.steps_of_tick(), events);
      loaded->energy.update(simulation.world());
    }
    const engine::Energy energy = loaded->energy.update(simulation.world());
    EXPECT_FALSE(is_error_large(energy));
    EXPECT_LT(energy.largest, 0.01) << "it falls by 2 cm at most";
    if (at_origin == 0.0) at_origin = energy.largest;
    EXPECT_NEAR(energy.largest, at_origin, 1e-6);
  }
}

/// Each of its tangents is stable, and it gains energy all the same.
TEST(ReachWatch, LetsGoWhereLinksTurnAboutSoFastThatTheyMakeEnergy) {
  const std::string crumpled = R"(cordis: 1
name: crumpled
space: 2
step: {rate_hz: 100, gesture_rate_hz: 100}
liaisons: {k: {kind: spring_damper, stiffness_n_per_m: 1000, viscosity_n_s_per_m: 0, rest_m: 1}}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [0.1, 0.02], [0.03, 0.11], [0.12, 0.09]]}
links:
  - {liaison: k, between: ["m[0]", "m[1]"]}
  - {liaison: k, between: ["m[0]", "m[2]"]}
  - {liaison: k, between: ["m[1]", "m[3]"]}
  - {liaison: k, between: ["m[2]", "m[3]"]}
  - {liaison: k, between: ["m[1]", "m[2]"]}
)";
  const auto loaded = loaded_scene_of(crumpled);
  EXPECT_TRUE(loaded->is_certain);
  EXPECT_TRUE(loaded->may_gain);
  const Alone seen = play_alone(crumpled, 20.0);
  EXPECT_EQ(seen.bound, PassedBound::kEnergy);
  EXPECT_FALSE(seen.is_beyond_reach);
}

/// A force limit lets each passage over it gain energy.
TEST(ReachWatch, LetsGoWhereALawThatBendsMakesEnergy) {
  const auto scene_at = [](const char* rate) {
    return std::string(R"(cordis: 1
name: limit
space: 1
step: {rate_hz: )") +
           rate + R"(}
matter:
  w: {kind: fixed, at_m: [0]}
  m: {kind: mass, mass_kg: 1, at_m: [0.034379202007691423]}
liaisons: {l: {stiffness_n_per_m: 791734.9426283052, force_limit_n: 7917.349426283052}}
links: [{liaison: l, between: [w, m], rest_m: 0}]
)";
  };
  EXPECT_FALSE(loaded_scene_of(scene_at("1000"))->is_certain);
  EXPECT_EQ(play_alone(scene_at("1000"), 5.0).bound, PassedBound::kEnergy);
  const auto finer = loaded_scene_of(scene_at("3000"));
  EXPECT_TRUE(finer->is_certain);
  EXPECT_TRUE(finer->may_gain);
  EXPECT_FALSE(loaded_scene_of(scene_at("100000"))->may_gain);
}

/// Likewise the pairs of a set, whose range is far.
TEST(ReachWatch, LetsGoWhereThePairsOfASetTurnAbout) {
  const std::string crumpled = R"(cordis: 1
name: crumpled
space: 2
step: {rate_hz: 55, gesture_rate_hz: 55}
liaisons: {k: {kind: state_machine, stiffness_n_per_m: 500}}
matter:
  m: {kind: points, mass_kg: 1, at_m: [[0, 0], [0.1, 0.02], [0.03, 0.11], [0.12, 0.09]]}
links: [{liaison: k, within: m, rest_m: 1, range_m: 100}]
)";
  const auto loaded = loaded_scene_of(crumpled);
  EXPECT_TRUE(loaded->is_certain);
  EXPECT_TRUE(loaded->may_gain);
  const Alone seen = play_alone(crumpled, 20.0);
  EXPECT_EQ(seen.bound, PassedBound::kEnergy);
  EXPECT_FALSE(seen.is_beyond_reach);
}

/// A hand may bring in what turns them, later.
TEST(ReachWatch, IsOfLinksThatHaveTooLittleEnergyToTurnToo) {
  const auto loaded = loaded_scene_of(R"(cordis: 1
name: pair
space: 2
step: {rate_hz: 1000}
liaisons: {k: {kind: spring_damper, stiffness_n_per_m: 3200, viscosity_n_s_per_m: 0, rest_m: 0.2}}
matter:
  m: {kind: mass, mass_kg: 0.1, at_m: [[0, 0], [0.2, 0]], velocity_m_per_s: [0.5, 0]}
links: [{liaison: k, between: ["m[0]", "m[1]"]}]
)");
  EXPECT_TRUE(loaded->is_certain);
  EXPECT_TRUE(loaded->watches_energy());
  EXPECT_EQ(loaded->passed_bound({}), PassedBound::kNone);
  EXPECT_EQ(loaded->passed_bound({.makes_energy = true}), PassedBound::kEnergy);
  EXPECT_FALSE(loaded->is_beyond_reach);
}

TEST(ReachWatch, TheLargestEnergyIsThatOfTheWholeRun) {
  const auto loaded = loaded_scene_of(
      moved("rate_hz: 10000", "at_m: 0.1",
            "  c: {kind: spring_damper, stiffness_n_per_m: 1, viscosity_n_s_per_m: 0.01, rest_m: "
            "0}\n"));
  Simulation& simulation = loaded->simulation;
  EventRoom events(64);
  const double start = loaded->energy.update(simulation.world()).largest;
  EXPECT_NEAR(start, 0.005, 1e-5);
  while (simulation.simulated_s() < 10.0) simulation.advance(simulation.steps_of_tick(), events);
  const engine::Energy energy = loaded->energy.update(simulation.world());
  EXPECT_LT(energy.total(), 1e-9) << "it rests";
  EXPECT_EQ(energy.largest, start);
}

}  // namespace
}  // namespace cordis::sim
