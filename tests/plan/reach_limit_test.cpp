// tests/plan/reach_limit_test.cpp -- the energy and speed up to which a step is certified.
#include "sim_node/plan/reach_limit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/step_bound.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::is_beyond;
using plan::ReachLimit;

/// Three masses of 2 kg in flight, with 9, 4 and 1 J, and a port that moves at 1 m/s.
World in_flight() {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-3;
  int i = 0;
  for (const double speed : {3.0, 2.0, 1.0}) {
    scene.mats.push_back(mass(2.0, Vec3(0, i++, 0)));
    scene.mats.back().velocity = Vec3(speed, 0, 0);
  }
  scene.mats.push_back({engine::MatKind::kPort, 0.0, Vec3(5, 0, 0)});
  World world = make_world(scene);
  for (int n = 1; n <= 3; ++n) {
    world.impose_position(3, Vec3(5.0 + 1e-3 * n, 0, 0));
    world.step();
  }
  return world;
}

TEST(ReachLimit, IsPassedByEnergyAndSpeed) {
  const World world = in_flight();
  const engine::Energy energy = world.energy();
  ASSERT_NEAR(energy.kinetic, 14.0, 1e-9);
  EXPECT_FALSE(is_beyond({.energy = 14.1}, world, energy));
  EXPECT_TRUE(is_beyond({.energy = 13.9}, world, energy));
  EXPECT_FALSE(is_beyond({.speed = 1.01, .energy = 20.0}, world, energy));
  EXPECT_TRUE(is_beyond({.speed = 0.99, .energy = 20.0}, world, energy)) << "the port";
}

TEST(ReachLimit, CountsStoredEnergyForTheWholeSceneAndNoneBelowNothing) {
  const World world = in_flight();
  engine::Energy energy = world.energy();
  energy.elastic = 5.0;
  EXPECT_TRUE(is_beyond({.energy = 18.9}, world, energy));
  EXPECT_FALSE(is_beyond({.energy = 19.1}, world, energy));
  energy.elastic = -5.0;
  EXPECT_TRUE(is_beyond({.energy = 13.9}, world, energy)) << "14 J of motion";
}

TEST(ReachLimit, IsNeverPassedWhereThereIsNone) {
  const World world = in_flight();
  engine::Energy energy = world.energy();
  energy.kinetic = 1e300;
  EXPECT_TRUE(ReachLimit{}.is_infinite());
  EXPECT_FALSE(is_beyond(ReachLimit{}, world, energy));
  EXPECT_FALSE(is_beyond({.speed = 0.1}, world, energy)) << "a speed alone certifies nothing";
}

constexpr double kDepth = 0.01;  // [J]

/// Three balls of Lennard-Jones in a row, at rest.
NetworkDescription balls_at_rest() {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.state_machines.push_back(state_machine(0.0, engine::LennardJones{kDepth, 0.1, 0.3}));
  engine::SetLiaison set;
  for (std::uint32_t i = 0; i < 3; ++i) {
    set.set_p.push_back(i);
    scene.mats.push_back(mass(0.1, Vec3(0.11225 * i, 0, 0)));
  }
  set.range = 0.3;
  scene.sets.push_back(set);
  return scene;
}

TEST(ReachLimit, OfASetIsTheEnergyOfAPair) {
  const ReachLimit limit = plan::reach_limit(balls_at_rest());
  EXPECT_FALSE(limit.is_infinite());
  ASSERT_EQ(limit.pairs.size(), 1u);
  EXPECT_EQ(limit.pairs[0].set, 0u);
  EXPECT_TRUE(std::isinf(limit.energy)) << "no link has such a law";
}

/// The slope of a pair that meets with the energy E, in depths: 4 (156 u^(7/3) - 42 u^(4/3)) depths per diameter
/// squared, u = (1 + sqrt(1 + E)) / 2.
double slope_at(double energy) {
  const double u = 0.5 * (1.0 + std::sqrt(1.0 + energy / kDepth));
  return 4.0 * (156.0 * std::pow(u, 7.0 / 3.0) - 42.0 * std::pow(u, 4.0 / 3.0)) * kDepth / 0.01;
}

double longest_certain_step(const NetworkDescription& scene) {
  const plan::LiaisonGraph graph = plan::liaison_graph(scene);
  return plan::certain_step_of(scene, graph, plan::stability_of(scene, graph));
}

/// The three balls, the last of them one that a hand leads, or that is driven at this speed [m/s].
NetworkDescription balls_at_a_port(double driven_at) {
  NetworkDescription scene = balls_at_rest();
  scene.mats[2].kind = engine::MatKind::kPort;
  scene.mats[2].mass = 0.0;
  if (driven_at == 0.0) return scene;
  engine::TimeFunction plunge;
  plunge.time = {0.0, 1.0, 2.0};
  plunge.value = {Vec3::Zero(), Vec3(-driven_at, 0, 0), Vec3::Zero()};
  scene.time_functions = {plunge};
  engine::Drive drive;
  drive.mat = 2;
  drive.origin = scene.mats[2].position;
  scene.drives = {drive};
  return scene;
}

/// What a port meets cannot push it back: a ball of 0.1 kg meets it with m v^2 / 2.
TEST(ReachLimit, OfASetCountsTheSpeedOfItsPorts) {
  const auto stiffness_of = [](const NetworkDescription& scene) {
    return plan::liaison_graph(scene).contacts.at(0).stiffness;
  };
  EXPECT_NEAR(stiffness_of(balls_at_rest()), slope_at(kDepth), 1e-9 * slope_at(kDepth));
  const double of_hand = slope_at(0.05);
  EXPECT_NEAR(stiffness_of(balls_at_a_port(0.0)), of_hand, 1e-9 * of_hand) << "a hand of 1 m/s";
  const double of_plunge = slope_at(1.25);
  EXPECT_NEAR(stiffness_of(balls_at_a_port(5.0)), of_plunge, 0.01 * of_plunge);

  NetworkDescription moving = balls_at_a_port(5.0);
  moving.mats[0].velocity = Vec3(3, 0, 0);
  const double of_both = slope_at(0.05 * std::pow(5.0 + 3.0, 2.0));
  EXPECT_NEAR(stiffness_of(moving), of_both, 0.01 * of_both);
}

/// The hand may come as fast as the step is certified for; faster, it is beyond the reach.
TEST(ReachLimit, OfASetHoldsAPortAgainstTheSpeedThatItsStepIsCertifiedFor) {
  NetworkDescription scene = balls_at_a_port(0.0);
  scene.step = 0.7 * longest_certain_step(scene);
  const ReachLimit limit = plan::reach_limit(scene);
  ASSERT_FALSE(limit.is_infinite());
  EXPECT_GE(limit.speed, 1.0);
  EXPECT_LT(limit.speed, 4.0);
  World world = make_world(scene);
  for (const double speed : {0.99 * limit.speed, 5.0}) {
    world.impose_position(2, world.position(2) - Vec3(speed * scene.step, 0, 0));
    world.step();
    EXPECT_EQ(is_beyond(limit, world, {}), speed > limit.speed);
  }
}

/// What has no energy at the start gets some by falling into wells: the limit is that of the step.
TEST(ReachLimit, OfASetAtRestIsThatOfItsStep) {
  NetworkDescription scene = balls_at_rest();
  const double stable = plan::certified_bound(scene, plan::liaison_graph(scene)).step;
  // Each ball has two partners: K' of a vibration is 4 part^2, and of a pair half of that. Certain is a product of 1.
  for (const double part : {0.5, 0.25}) {
    scene.step = part * stable;
    const double energy = plan::reach_limit(scene).pairs.at(0).energy;
    const double slope = slope_at(energy) / slope_at(kDepth);
    const double most = 1.0 / (std::sqrt(8.0) * part * part);
    EXPECT_LE(slope, most * (1.0 + 1e-9)) << part;
    EXPECT_GT(slope, 0.95 * most) << part << ": to 1.05 of the energy";
  }
  scene.step = 0.999 * longest_certain_step(scene);
  EXPECT_LT(plan::reach_limit(scene).pairs.at(0).energy, 1.1 * kDepth);
}

/// A light ball among heavy ones limits the step, and not the energy of the heavy ones among themselves.
TEST(ReachLimit, OfOneSetIsNotThatOfAnother) {
  NetworkDescription scene = balls_at_rest();
  scene.mats.push_back(mass(0.001, Vec3(0, 0.11225, 0)));
  scene.sets.push_back(scene.sets[0]);
  scene.sets[1].set_q = {3};
  scene.step = 0.9 * longest_certain_step(scene);
  const ReachLimit limit = plan::reach_limit(scene);
  ASSERT_EQ(limit.pairs.size(), 2u);
  EXPECT_GT(limit.pairs[0].energy, 100.0 * kDepth);
  EXPECT_LT(limit.pairs[1].energy, 5.0 * kDepth);
}

/// A ball of 0.1 kg and twelve around it at this distance, which touch it alone.
NetworkDescription ball_among_others(double distance, double speed) {
  NetworkDescription scene = balls_at_rest();
  scene.mats.resize(1);
  scene.mats[0].velocity = Vec3(speed, 0, 0);
  scene.sets[0].set_p = {0};
  for (std::uint32_t i = 1; i <= 12; ++i) {
    const double angle = i * std::acos(-1.0) / 6.0;
    scene.sets[0].set_q.push_back(i);
    scene.mats.push_back(mass(0.1, distance * Vec3(std::cos(angle), std::sin(angle), 0)));
  }
  return scene;
}

constexpr double kAway = 5.0;
constexpr double kInTheWell = 0.11225;

/// The limits of the balls that are away, at a step for which six partners may have more energy.
ReachLimit limit_of_balls_away(NetworkDescription& scene) {
  scene = ball_among_others(kAway, 0.0);
  scene.step = 0.4 * plan::certified_bound(scene, plan::liaison_graph(scene)).step;
  return plan::reach_limit(scene);
}

/// More partners leave less for the slope of a pair.
TEST(ReachLimit, IsLowerWithMorePartners) {
  NetworkDescription scene;
  const ReachLimit limit = limit_of_balls_away(scene);
  ASSERT_EQ(limit.partners.at(0).partners.at(0), 6u) << "equal discs around one";
  ASSERT_FALSE(limit.with_more_partners.empty());
  EXPECT_EQ(limit.with_more_partners.back().partners.at(0).partners.at(0), 12u)
      << "there are no more";
  const ReachLimit* before = &limit;
  for (const ReachLimit& fuller : limit.with_more_partners) {
    EXPECT_GT(fuller.partners.at(0).partners.at(0), before->partners.at(0).partners.at(0));
    EXPECT_LT(fuller.pairs.at(0).energy, before->pairs.at(0).energy);
    before = &fuller;
  }
}

TEST(ReachLimit, WithMorePartnersIsPassedByWhatFewerAllow) {
  NetworkDescription scene;
  const ReachLimit limit = limit_of_balls_away(scene);
  ASSERT_FALSE(limit.with_more_partners.empty());
  const double between =
      0.5 * (limit.pairs.at(0).energy + limit.with_more_partners.back().pairs.at(0).energy);
  const double fast = std::sqrt(2.0 * between / 0.05);  // of two equal balls against each other
  const auto is_passed = [&](double distance, double speed) {
    const World world = make_world(ball_among_others(distance, speed));
    return is_beyond(limit, world, world.energy());
  };
  EXPECT_TRUE(is_passed(kInTheWell, fast));
  EXPECT_FALSE(is_passed(kAway, fast)) << "nothing touches it";
  EXPECT_FALSE(is_passed(kInTheWell, 0.0)) << "it rests";
}

/// Balls of 2 kg at 3, 2 and 1 m/s, and one of 0.02 kg.
TEST(ReachLimit, CountsTheMotionOfTwoMatsAgainstEachOther) {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-3;
  for (const double speed : {3.0, 2.0, 1.0, 5.0}) {
    scene.mats.push_back(mass(speed == 5.0 ? 0.02 : 2.0, Vec3(0, speed, 0)));
    scene.mats.back().velocity = Vec3(speed, 0, 0);
  }
  World world = make_world(scene);
  world.step();
  engine::SetLiaison set;
  set.set_p = {0, 1, 2};
  EXPECT_NEAR(plan::pair_energy(world, set), 12.5, 1e-9) << "0.5 * 1 kg * (5 m/s)^2, not 9 + 4 J";
  set.set_p = {0, 1};
  set.set_q = {3};
  const double reduced = 2.0 * 0.02 / 2.02;
  EXPECT_NEAR(plan::pair_energy(world, set), 0.5 * reduced * 64.0, 1e-9);
}

TEST(ReachLimit, OfEachSetIsHeldAgainstItsOwnMembers) {
  NetworkDescription scene = balls_at_rest();
  scene.sets.push_back(scene.sets[0]);
  scene.sets[1].set_p = {0, 1};
  scene.mats[2].velocity = Vec3(0, 1, 0);  // 0.5 * 0.05 kg * (1 m/s)^2
  World world = make_world(scene);
  const engine::Energy energy = world.energy();
  EXPECT_TRUE(is_beyond({.pairs = {{0, 0.0249}}}, world, energy));
  EXPECT_FALSE(is_beyond({.pairs = {{0, 0.0251}}}, world, energy));
  EXPECT_FALSE(is_beyond({.pairs = {{1, 0.0249}}}, world, energy));
}

}  // namespace
}  // namespace cordis::test
