// tests/scene/standard_liaison_test.cpp -- the liaisons of launch_configs/liaisons/standard.yaml,
// each in a tiny scene of one dimension.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "node/config/yaml_reader.h"
#include "sim_node/engine/world.h"
#include "tests/scene/scene_text.h"
#include "tests/support/filled.h"

namespace cordis::scene {
namespace {

constexpr double kStep = 1.0e-5;  // [s]

Scene scene_with(const std::string& body) {
  const std::string file =
      (std::filesystem::path(CORDIS_SOURCE_DIR) / "launch_configs" / "scenes" / "t.yaml").string();
  config::Problems problems;
  Scene scene = load_scene_text(
      R"(cordis: 1
space: 1
step: {rate_hz: 100000}
liaisons: {include: ../liaisons/standard.yaml}
)" + body,
      file, problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

/// A wall at 0, a hand at 0 and a mass that nothing holds, with links in between. The growth of a
/// link from the wall is the way of its other end.
class Rig {
 public:
  explicit Rig(const std::string& links, const std::string& mass = "{mass_kg: 1, at_m: 9}")
      : scene_(scene_with(test::filled(R"(matter:
  wall: {kind: fixed, at_m: 0}
  bob: {kind: mass, <mass>
ports:
  hand: {device: d, axes: [0], role: mass, coupling: direct, at_m: 0}
links:
)",
                                       {{"mass", mass.substr(1)}}) +
                          links)),
        world_(std::make_shared<const engine::Network>(scene_.network)) {}

  /// Moves the hand to a place at a steady speed. @param each_step  called after each step
  void move_to(double target, double speed, const std::function<void()>& each_step = {}) {
    const double from = hand_;
    const auto count = static_cast<int>(std::lround(std::abs(target - from) / (speed * kStep)));
    for (int n = 1; n <= count; ++n) {
      hand_ = from + (target - from) * n / count;
      step();
      if (each_step) each_step();
    }
  }
  void step() {
    world_.impose_position(kHand, engine::Vec3(hand_, 0.0, 0.0));
    ASSERT_EQ(world_.step().non_finite_mats, 0u);
    for (const engine::LinkEvent& event : world_.events()) {
      if (event.link == 0) ++changes_;
    }
  }
  /// What the links draw the hand back with [N].
  double tension() const { return -world_.link_force(kHand).x(); }
  int changes() const { return changes_; }
  std::string state() const {
    const engine::NetworkDescription& network = scene_.network;
    const engine::StateLink& link = network.state_links[0];
    return network.state_machines[link.state_machine].states[world_.state_of(0)].name;
  }
  double hand() const { return hand_; }
  double bob() const { return world_.position(kBob).x(); }
  double bob_speed() const { return world_.velocity(kBob).x(); }
  double time() const { return static_cast<double>(world_.step_count()) * kStep; }
  engine::World& world() { return world_; }

 private:
  static constexpr std::uint32_t kBob = 1;
  static constexpr std::uint32_t kHand = 2;
  Scene scene_;
  engine::World world_;
  double hand_ = 0.0;
  int changes_ = 0;
};

std::string link(const std::string& liaison, const std::string& more = {}) {
  return "  - {liaison: " + liaison + ", between: [wall, hand], rest_m: 0" + more + "}\n";
}

/// The speed of a mass of 1 kg after it has met the wall at 1 m/s.
double bounced(const std::string& liaison, double viscosity, double& largest_tension,
               int& changes) {
  Rig rig("  - {liaison: " + liaison +
              ", between: [wall, bob], rest_m: 0, stiffness_n_per_m: 10000, viscosity_n_s_per_m: " +
              std::to_string(viscosity) + "}\n",
          "{mass_kg: 1, at_m: 0.001, velocity_m_per_s: -1}");
  largest_tension = 0.0;
  while (rig.time() < 0.1) {
    rig.step();
    largest_tension = std::max(largest_tension, rig.world().tension_of(0));
  }
  changes = rig.changes();
  return rig.bob_speed();
}

TEST(Contact, SendsAMassBackAtItsOwnSpeed) {
  double tension = 0.0;
  int changes = 0;
  // w dt = 1e-3: the scheme gains or loses less than (w dt)^2 / 4 of the energy at each change
  EXPECT_NEAR(bounced("contact", 0.0, tension, changes), 1.0, 1e-6);
  EXPECT_EQ(changes, 2);
}

TEST(Contact, WithViscositySendsItBackSlower) {
  // half a swing of the damped oscillator: exp(-pi zeta / sqrt(1 - zeta^2)), zeta = Z / (2 sqrt(K
  // m))
  double tension = 0.0;
  int changes = 0;
  const double zeta = 0.2;
  const double exact = std::exp(-std::numbers::pi * zeta / std::sqrt(1.0 - zeta * zeta));
  EXPECT_NEAR(bounced("contact", 40.0, tension, changes), exact, 2e-3);
  EXPECT_GT(tension, 1.0);  // it pulls when it lets go: Z times the speed
}

TEST(ContactClamped, NeverPulls) {
  // it is free when the force is: after (pi - acos(1 - 2 zeta^2) ... of the swing
  double tension = 0.0;
  int changes = 0;
  const double zeta = 0.2;
  const double root = std::sqrt(1.0 - zeta * zeta);
  const double exact = std::exp(
      -zeta / root * (std::numbers::pi - std::atan2(2.0 * zeta * root, 1.0 - 2.0 * zeta * zeta)));
  EXPECT_NEAR(bounced("contact_clamped", 40.0, tension, changes), exact, 2e-3);
  EXPECT_EQ(tension, 0.0);
  EXPECT_EQ(changes, 2);
}

TEST(Grasp, HoldsForGoodWhatItHasTouched) {
  Rig rig(link("grasp", ", viscosity_n_s_per_m: 0"));
  rig.move_to(0.01, 0.1);
  EXPECT_EQ(rig.tension(), 0.0);
  rig.move_to(-0.001, 0.1);
  EXPECT_EQ(rig.state(), "held");
  rig.move_to(0.05, 0.1);
  EXPECT_NEAR(rig.tension(), 1000 * 0.05, 1e-2);  // of the step before the last
  EXPECT_EQ(rig.changes(), 1);
}

TEST(Pluck, SlipsOffAtItsForceAndIsReadyOnceItIsOut) {
  Rig rig(link("pluck"));
  double largest = 0.0;
  rig.move_to(-0.005, 0.1, [&] { largest = std::max(largest, -rig.tension()); });
  EXPECT_NEAR(largest, 500 * 0.003, 1e-3);
  EXPECT_EQ(rig.state(), "passed");
  EXPECT_EQ(rig.tension(), 0.0);
  rig.move_to(0.001, 0.1, [&] { EXPECT_EQ(rig.tension(), 0.0); });
  EXPECT_EQ(rig.state(), "apart");
  EXPECT_EQ(rig.changes(), 3);
  rig.move_to(-0.002, 0.1);
  EXPECT_NEAR(rig.tension(), -500 * 0.002, 1e-3);
}

TEST(Stick, HoldsUpToItsForceAndMayStickAgain) {
  Rig rig(link("stick", ", viscosity_n_s_per_m: 0"));
  double largest = 0.0;
  const auto watch = [&] { largest = std::max(largest, rig.tension()); };
  rig.move_to(-0.001, 0.1);
  EXPECT_NEAR(rig.tension(), -500 * 0.001, 1e-3);
  rig.move_to(0.005, 0.1, watch);
  EXPECT_NEAR(largest, 500 * 0.002, 1e-3);
  EXPECT_EQ(rig.tension(), 0.0);
  rig.move_to(-0.001, 0.1);
  EXPECT_EQ(rig.state(), "stuck");
  EXPECT_EQ(rig.changes(), 3);
}

/// Hooks and unhookings of a mass on a spring, bowed at 0.1 m/s for 2 s, and how far it is dragged.
struct Bowing {
  int changes = 0;
  double farthest = 0.0;
};
Bowing bow(double speed) {
  Rig rig(
      R"(  - {liaison: collophane, between: [hand, bob], rest_m: 0, viscosity_n_s_per_m: 0.2}
  - {liaison: kelvin_voigt, between: [wall, bob], viscosity_n_s_per_m: 0.02, rest_m: 0}
)",
      "{mass_kg: 0.01, at_m: 0}");
  Bowing bowing;
  rig.move_to(2.0 * speed, std::abs(speed),
              [&] { bowing.farthest = std::max(bowing.farthest, std::abs(rig.bob())); });
  bowing.changes = rig.changes();
  return bowing;
}

TEST(Collophane, DragsAndSlipsInTurnBothWays) {
  const Bowing forth = bow(0.1);
  const Bowing back = bow(-0.1);

  EXPECT_EQ(forth.changes, back.changes);
  EXPECT_DOUBLE_EQ(forth.farthest, back.farthest);
  // the hair holds 400 N/m * 2 mm = 0.8 N, with which a spring of 100 N/m is drawn by 8 mm
  EXPECT_NEAR(forth.farthest, 0.008, 0.001);  // it swings within the hair, and on when let go
  // it is dragged 8 mm beyond where it was caught, at 0.1 m/s, again and again
  EXPECT_GT(forth.changes, 2 * 8);
  EXPECT_LT(forth.changes, 2 * 40);
}

TEST(Ratchet, GivesWayToothByToothAndHoldsBackwards) {
  // tests/reference R17: three teeth of 10 mm on the way to 37 mm, 15 mJ lost
  Rig rig(link("ratchet"));
  rig.move_to(0.037, 0.1);
  EXPECT_NEAR(rig.tension(), 0.7, 1e-3);
  EXPECT_EQ(rig.changes(), 3);
  rig.move_to(0.0, 0.1);
  EXPECT_NEAR(rig.tension(), -3.0, 1e-3);
  EXPECT_EQ(rig.changes(), 3);
  const engine::Energy energy = rig.world().energy();
  EXPECT_NEAR(-energy.switching, 0.015, 1e-4);
  EXPECT_NEAR(energy.residual(), 0.0, 1e-9 * energy.largest);
}

TEST(Plastic, KeepsARemanentLengthAndLosesTheAreaOfItsLoop) {
  // R17 a: K = 1000 N/m, yields at 2 mm, driven to +-10 mm: 4 K uy (A - uy) = 64 mJ a cycle
  Rig rig(link("plastic"));
  rig.move_to(0.01, 0.1);
  EXPECT_EQ(rig.state(), "longer");
  EXPECT_NEAR(rig.tension(), 2.0, 1e-9);
  rig.move_to(0.008, 0.1);
  EXPECT_NEAR(rig.tension(), 0.0, 2e-3);  // at rest where it was drawn to, less 2 mm
  EXPECT_NEAR(rig.world().rest_length_of(0), 0.008, 2e-6);
  rig.move_to(-0.01, 0.1);
  EXPECT_EQ(rig.state(), "shorter");
  rig.move_to(0.01, 0.1);
  const double before = rig.world().energy().port_work;
  rig.move_to(-0.01, 0.1);
  rig.move_to(0.01, 0.1);
  EXPECT_NEAR(rig.world().energy().port_work - before, 0.064, 1e-4);
  EXPECT_EQ(rig.changes(), 9);
}

TEST(Ecrouissage, HardensKeepsARemanentLengthAndBreaks) {
  // bilinear: past 2 mm the slope is 100 N/m instead of 1000 N/m; rupture at 20 mm
  Rig rig("  - {liaison: ecrouissage, between: [wall, hand]}\n");
  const auto drawn = [](double length) { return 2.0 + 100 * (length - 0.002); };
  rig.move_to(0.001, 0.1);
  EXPECT_NEAR(rig.tension(), 1.0, 2e-3);
  rig.move_to(0.010, 0.1);
  EXPECT_NEAR(rig.tension(), drawn(0.010), 1e-3);
  const double remanent = 0.010 - drawn(0.010) / 1000;  // (1 - 100 / 1000) (10 - 2) mm
  rig.move_to(remanent, 0.1);
  EXPECT_EQ(rig.state(), "remanent");
  EXPECT_NEAR(rig.tension(), 0.0, 2e-3);
  EXPECT_NEAR(rig.world().rest_length_of(0), 0.0072, 2e-6);
  rig.move_to(0.009, 0.1);
  EXPECT_NEAR(rig.tension(), 1000 * (0.009 - remanent), 4e-3);  // elastic up to where it was left
  rig.move_to(0.015, 0.1);
  EXPECT_EQ(rig.state(), "flowing");
  EXPECT_NEAR(rig.tension(), drawn(0.015), 1e-3);
  rig.move_to(0.013, 0.1);
  rig.move_to(0.016, 0.1);
  EXPECT_NEAR(rig.tension(), drawn(0.016), 1e-3);
  double largest = 0.0;
  rig.move_to(0.03, 0.1, [&] { largest = std::max(largest, rig.tension()); });
  EXPECT_NEAR(largest, drawn(0.020), 1e-3);
  EXPECT_EQ(rig.state(), "broken");
  EXPECT_EQ(rig.tension(), 0.0);
  // flowing, remanent, flowing, remanent, flowing, broken
  EXPECT_EQ(rig.changes(), 6);
  const engine::Energy energy = rig.world().energy();
  EXPECT_NEAR(energy.residual(), 0.0, 1e-9 * energy.largest);
}

TEST(Ecrouissage, MayUnloadAtAnotherStiffness) {
  Rig rig("  - {liaison: ecrouissage, between: [wall, hand], unloading_n_per_m: 2000}\n");
  rig.move_to(0.010, 0.1);
  rig.move_to(0.009, 0.1);
  EXPECT_NEAR(rig.world().rest_length_of(0), 0.010 - 2.8 / 2000, 2e-6);
  EXPECT_NEAR(rig.tension(), 2.8 - 2000 * 0.001, 1e-2);
  rig.move_to(0.0102, 0.1);
  EXPECT_NEAR(rig.tension(), 2.82, 1e-3);  // back on the same line of hardening
}

TEST(Rupture, BreaksAtItsElongationInTensionAlone) {
  // R17: a mass of 0.5 kg on a spring of 200 N/m whose end is drawn away at 1 m/s breaks at 30 mm,
  // after asin(0.03 w) / w, going at 1 - cos wt
  Rig rig(
      "  - {liaison: rupture, between: [bob, hand], rest_m: 0, stiffness_n_per_m: 200, "
      "viscosity_n_s_per_m: 0, rupture_m: 0.03}\n",
      "{mass_kg: 0.5, at_m: 0}");
  double broken_at = 0.0;
  rig.move_to(0.05, 1.0, [&] {
    if (broken_at == 0.0 && rig.state() == "broken") broken_at = rig.time();
  });
  EXPECT_NEAR(broken_at, 0.0321750554, 2.0 * kStep);
  EXPECT_NEAR(rig.bob_speed(), 0.2, 2e-4);
  EXPECT_EQ(rig.changes(), 1);

  Rig pushed(link("rupture", ", viscosity_n_s_per_m: 0"));
  pushed.move_to(-0.05, 1.0);
  EXPECT_EQ(pushed.state(), "whole");
}

TEST(Bond, BreaksAndIsWholeAgain) {
  Rig rig(link("bond", ", viscosity_n_s_per_m: 0"));
  double largest = 0.0;
  rig.move_to(0.01, 0.1, [&] { largest = std::max(largest, rig.tension()); });
  EXPECT_NEAR(largest, 5.0, 1e-2);
  EXPECT_EQ(rig.state(), "broken");
  rig.move_to(0.0005, 0.1);
  EXPECT_EQ(rig.tension(), 0.0);
  rig.move_to(-0.001, 0.1);
  EXPECT_NEAR(rig.tension(), -1.0, 2e-3);
  EXPECT_EQ(rig.changes(), 2);
}

/// Draws the hand 1 mm at once, waits, and reports the tension.
double relaxed(Rig& rig, double time) {
  rig.move_to(0.001, 0.001 / kStep);  // in one step
  while (rig.time() < time) rig.step();
  return rig.tension();
}

TEST(Maxwell, ForgetsAStretch) {
  // tests/reference R16: F = K2 u0 exp(-K2 t / Z), K2 = 300 N/m, Z = 20 N s/m
  Rig rig("  - {liaison: maxwell, between: [wall, hand]}\n");
  EXPECT_NEAR(relaxed(rig, 0.05), 0.14170996582, 1e-4);
  EXPECT_NEAR(relaxed(rig, 0.1), 0.06693904804, 1e-4);
}

TEST(StandardLinearSolid, IsStiffAtFirstAndSoftLater) {
  // R16: F = u0 (K1 + K2 exp(-K2 t / Z))
  Rig rig("  - {liaison: standard_linear_solid, between: [wall, hand], rest_m: 0}\n");
  EXPECT_NEAR(relaxed(rig, 0.05), 0.24170996582, 1e-4);
  EXPECT_NEAR(relaxed(rig, 0.5), 0.10016592531, 1e-4);
}

TEST(KelvinVoigt, CreepsToItsNewLength) {
  // R16: u = F0 / K1 (1 - exp(-K1 t / Z)), here of a mass so light that it follows at once
  Rig rig("  - {liaison: kelvin_voigt, between: [wall, bob], rest_m: 0}\n",
          "{mass_kg: 0.001, at_m: 0}");
  rig.world().set_external_force(1, engine::Vec3(1.0, 0.0, 0.0));
  while (rig.time() < 0.1) rig.step();
  EXPECT_NEAR(rig.bob(), 0.00393469340, 2e-5);
}

TEST(StandardLiaisons, SayWhatTheirStatesAndParametersMean) {
  const std::string file =
      std::string(CORDIS_SOURCE_DIR) + "/launch_configs/liaisons/standard.yaml";
  std::vector<std::string> lines(1);
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  config::Problems problems;
  const config::Value liaisons = config::load_file(file, problems).find("liaisons");
  EXPECT_GE(liaisons.entries().size(), 14u);
  for (const config::Value::Entry& liaison : liaisons.entries()) {
    std::string comment;
    for (auto line = static_cast<std::size_t>(liaison.key_place.line) - 1;
         lines[line].starts_with("  #"); --line)
      comment += lines[line] + ' ';
    std::replace_if(
        comment.begin(), comment.end(),
        [](char c) { return std::string_view(":,.;").find(c) != std::string_view::npos; }, ' ');
    std::vector<std::string> words;
    for (const char* section : {"states", "parameters"}) {
      for (const auto& entry : liaison.value.find(section).entries()) words.push_back(entry.key);
    }
    for (const char* key : {"stiffness_n_per_m", "viscosity_n_s_per_m"}) {
      if (liaison.value.find(key).exists()) words.emplace_back(key);
    }
    for (const std::string& word : words)
      EXPECT_NE(comment.find(' ' + word + ' '), std::string::npos) << liaison.key << ": " << word;
  }
}

TEST(StandardLiaisons, CanAllBeUsedInASet) {
  for (const char* name : {"contact", "contact_clamped", "grasp", "pluck", "stick"}) {
    const Scene scene = scene_with(
        R"(matter:
  b: {kind: mass, ball: {mass_kg: 1, radius_m: 0.01}, at_m: [0, 1]}
links:
  - {liaison: )" +
        std::string(name) + ", within: b}\n");
    ASSERT_EQ(scene.network.sets.size(), 1u) << name;
    EXPECT_EQ(scene.network.sets[0].range, 0.02) << name;
  }
}

}  // namespace
}  // namespace cordis::scene
