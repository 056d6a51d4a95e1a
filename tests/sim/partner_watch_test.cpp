// tests/sim/partner_watch_test.cpp
#include "sim_node/checks/partner_watch.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "tests/engine/scenes.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/filled.h"
#include "tests/support/rounds.h"

namespace cordis::sim {
namespace {

using engine::NetworkDescription;
using engine::Vec3;
using engine::World;

/// 25 masses on a square, all drawn to its middle and pushing each other off from 20 mm on.
std::string gathering_text(const std::string& stiffness) {
  return test::filled(R"(cordis: 1
name: gathering
space: 2
step: {rate_hz: 1000}
liaisons:
  tension: {kind: spring_damper, stiffness_n_per_m: 20, viscosity_n_s_per_m: 0.01}
  push: {kind: state_machine, stiffness_n_per_m: <stiffness>, viscosity_n_s_per_m: 0.02, pulls: false}
matter:
  middle: {kind: fixed, at_m: [0.1, 0.1]}
  crowd: {kind: lattice, structure: square, corner_m: [0, 0], counts: [5, 5], spacing_m: 0.05,
          mass_kg: 0.001}
links:
  - {liaison: tension, between: [middle, crowd], rest_m: 0}
  - {liaison: push, within: crowd, rest_m: 0.02, range_m: 0.02}
)",
                      {{"stiffness", stiffness}});
}

TEST(PartnerWatch, SeesInItsStepThatMorePartnersCameThanCertified) {
  const auto loaded = loaded_scene_of(gathering_text("150"));
  Simulation& simulation = loaded->simulation;
  const plan::Stability stability = plan::plan_of(simulation.scene().network, 10.0).stability;
  ASSERT_TRUE(stability.holds());  // 6 at once are
  ASSERT_EQ(stability.sets.size(), 1u);
  const std::uint32_t certified = stability.sets[0].least;
  ASSERT_LT(certified, 24u);

  EventRoom events(1);
  bool passed = false;
  for (int tick = 0; tick < 5000 && !passed; ++tick) {
    simulation.advance(1, events);
    const engine::PartnerCount now = simulation.world().largest_partners(0);
    const auto seen = simulation.partners().nearest();
    ASSERT_TRUE(seen.has_value());
    EXPECT_EQ(seen->certified, certified);
    EXPECT_GE(seen->largest, now.of_p);
    passed = now.of_p > certified;
    EXPECT_EQ(seen->is_passed(), passed);
    EXPECT_EQ(simulation.passed_bound(), passed ? PassedBound::kPartners : PassedBound::kNone);
  }
  ASSERT_TRUE(passed) << "the crowd gathers";
  const std::string text = crowding_text(simulation.scene(), *simulation.partners().nearest());
  EXPECT_NE(text.find("a mass of push of sets (t:14) touches"), std::string::npos) << text;
  EXPECT_NE(text.find("certified up to " + std::to_string(certified)), std::string::npos) << text;

  // The bound from above on K' + 2 Z' counts the partners that are there.
  loaded->limits.update(simulation.world());
  EXPECT_GT(loaded->limits.largest(), 4.0);
}

TEST(PartnerWatch, WatchesNothingWhereTheSceneIsNotCertainWithAnyNumber) {
  const auto loaded = loaded_scene_of(gathering_text("100000"));
  Simulation& simulation = loaded->simulation;
  EventRoom events(1);
  bool touched = false;
  for (int tick = 0; tick < 5000 && !touched; ++tick) {
    simulation.advance(1, events);
    touched = simulation.world().largest_partners(0).of_p > 0;
  }
  ASSERT_TRUE(touched);
  EXPECT_FALSE(simulation.partners().nearest().has_value());
  EXPECT_EQ(simulation.passed_bound(), PassedBound::kNone);
  loaded->limits.update(simulation.world());
  EXPECT_GT(loaded->limits.largest(), 4.0) << "at 1000 Hz a single contact is too stiff";
}

TEST(PartnerWatch, RemembersTheMostWhenParametersChange) {
  const auto before = loaded_scene_of(gathering_text("150"));
  EventRoom events(1);
  for (int tick = 0; tick < 3000; ++tick) before->simulation.advance(1, events);
  const auto seen = before->simulation.partners().nearest();
  ASSERT_GT(seen->largest, 0u);

  const auto after = loaded_scene_of(gathering_text("140"));
  std::vector<double> room(after->simulation.world().max_values_of_state());
  ASSERT_TRUE(after->simulation.go_on_from(before->simulation, room));
  EXPECT_GE(after->simulation.partners().nearest()->largest, seen->largest);
}

TEST(PartnerWatch, LetsGoOfTheDevicesUntilTheSceneRestartsUnlessItIsForced) {
  const auto before = loaded_scene_of(gathering_text("150"));
  const auto forced = loaded_scene_of(gathering_text("150"));
  forced->simulation.keep_devices();
  EventRoom events(1);
  for (int tick = 0; tick < 3000; ++tick) {
    before->simulation.advance(1, events);
    forced->simulation.advance(1, events);
  }
  ASSERT_TRUE(before->simulation.partners().nearest()->is_passed());
  EXPECT_EQ(before->simulation.passed_bound(), PassedBound::kPartners);
  EXPECT_EQ(forced->simulation.passed_bound(), PassedBound::kNone);

  const auto after = loaded_scene_of(gathering_text("1"));
  std::vector<double> room(after->simulation.world().max_values_of_state());
  ASSERT_TRUE(after->simulation.go_on_from(before->simulation, room));
  EXPECT_EQ(after->simulation.passed_bound(), PassedBound::kPartners);
}

TEST(PartnerWatch, LooksWithoutAllocation) {
  const auto loaded = loaded_scene_of(gathering_text("150"));
  EventRoom events(1);
  loaded->simulation.advance(1, events);
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 100; ++tick) loaded->simulation.advance(1, events);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(PartnerWatch, HasNothingToSayWhereGeometryGuaranteesTheNumber) {
  const auto loaded = loaded_scene_of(
      R"(cordis: 1
name: pair
space: 1
step: {rate_hz: 1000}
liaisons: {push: {kind: state_machine, stiffness_n_per_m: 10, pulls: false}}
matter:
  s: {kind: mass, mass_kg: 0.1, at_m: [0, 0.005]}
links:
  - {liaison: push, within: s, rest_m: 0.01, range_m: 0.01}
)");
  EventRoom events(1);
  loaded->simulation.advance(1, events);
  EXPECT_FALSE(loaded->simulation.partners().nearest().has_value());
}

/// A random scene of one set: masses in a box, each joined to those in range by contacts or by
/// springs, with or without radii, or falling on a floor of fixed points.
NetworkDescription random_set(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  NetworkDescription scene;
  scene.dimension = 1 + static_cast<int>(seed % 3);
  scene.step = 1e-3;
  const double size = 0.02 * (1.0 + 3.0 * uniform());
  const double range = 0.005 + 0.02 * uniform();
  const bool floor = random() % 3 == 0;
  const bool springs = !floor && random() % 2 == 0;
  const bool radii = !springs && random() % 2 == 0;
  const auto place = [&] {
    Vec3 point = Vec3::Zero();
    for (int axis = 0; axis < scene.dimension; ++axis) point[axis] = size * uniform();
    return point;
  };
  const auto count = static_cast<std::uint32_t>(2 + random() % 30);
  engine::SetLiaison set;
  for (std::uint32_t i = 0; i < count; ++i) {
    set.set_p.push_back(i);
    engine::Mat mass = test::mass(0.001 * (1.0 + uniform()), place());
    if (floor) mass.position[scene.dimension - 1] += range;
    scene.mats.push_back(mass);
  }
  if (floor) {
    scene.gravity = Vec3::Zero();
    scene.gravity[scene.dimension - 1] = -9.81;
    const double spacing = range * (0.15 + uniform());
    const auto along = static_cast<int>(size / spacing) + 3;
    for (int i = -2; i < along; ++i) {
      for (int j = scene.dimension > 2 ? -2 : 0; j < (scene.dimension > 2 ? along : 1); ++j) {
        set.set_q.push_back(static_cast<std::uint32_t>(scene.mats.size()));
        Vec3 floor_place = Vec3::Zero();
        if (scene.dimension > 1) floor_place[0] = spacing * i;
        if (scene.dimension > 2) floor_place[1] = spacing * j;
        if (scene.dimension == 1) floor_place[0] = spacing * (i - along);
        scene.mats.push_back(test::fixed(floor_place));
      }
    }
  }
  if (radii) scene.radius.assign(scene.mats.size(), 0.5 * range);
  scene.state_machines.emplace_back();
  scene.state_machines[0].states.emplace_back();
  engine::LinkState& state = scene.state_machines[0].states[0];
  state.stiffness = std::pow(10.0, 3.0 * uniform());
  state.viscosity = 0.2 * std::sqrt(state.stiffness * 0.001);
  state.pulls = springs;
  set.range = springs ? 100.0 * range : range;
  set.rest_length = radii ? -1.0 : springs ? 0.3 * range * uniform() : range;
  scene.sets.push_back(set);
  return scene;
}

/// Kinetic and elastic energy beyond what the start and gravity have brought in, as a part of it.
double excess(const NetworkDescription& scene, const World& world, double start) {
  double fallen = 0.0;
  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
    if (scene.mats[i].kind != engine::MatKind::kMass) continue;
    const Vec3 way = world.position(i) - scene.mats[i].position;
    fallen += std::max(0.0, scene.mats[i].mass * scene.gravity.dot(way));
  }
  const engine::Energy energy = world.energy();
  return (energy.kinetic + energy.elastic) / (start + fallen + 1e-12);
}

constexpr auto kSeeds = static_cast<unsigned>(test::rounds(60));

TEST(SetsByChance, StayBoundedJustBelowTheirCertifiedStep) {
  int held = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    NetworkDescription scene = random_set(seed);
    scene.step = 0.98 * plan::plan_of(scene, 10.0).stability.certified.step;
    if (!std::isfinite(scene.step)) continue;
    const plan::Stability stability = plan::plan_of(scene, 10.0).stability;
    if (stability.uncertainty) continue;  // such as contacts of K' > 1
    ASSERT_TRUE(stability.holds()) << "seed " << seed;
    PartnerWatch watch(scene);
    World world(std::make_shared<const engine::Network>(scene));
    const double start = world.energy().kinetic + world.energy().elastic;
    for (int n = 1; n <= 20000; ++n) {
      ASSERT_EQ(world.step().non_finite_mats, 0u) << "seed " << seed << ", step " << n;
      watch.update(world);
      if (watch.nearest() && watch.nearest()->is_passed()) break;
      if (n % 20 > 0) continue;
      ASSERT_LT(excess(scene, world, start), 1.1) << "seed " << seed << ", step " << n;
      if (n == 20000) ++held;
    }
  }
  EXPECT_GE(held, static_cast<int>(kSeeds / 2));
}

TEST(SetsByChance, GrowTenfoldJustBeyondTheStepThatSurelyDiverges) {
  int grown = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    NetworkDescription scene = random_set(seed);
    if (!scene.state_machines[0].states[0].pulls) continue;
    const plan::Stability stability = plan::plan_of(scene, 10.0).stability;
    ASSERT_LE(stability.certified.step, stability.diverging_step * (1.0 + 1e-6)) << "seed " << seed;
    scene.step = 1.02 * stability.diverging_step;
    NetworkDescription disturbed = scene;
    std::mt19937 random(seed);
    for (engine::Mat& mat : disturbed.mats) {
      for (int axis = 0; axis < scene.dimension; ++axis) {
        mat.position[axis] += 1e-9 * (static_cast<double>(random()) / 2147483648.0 - 1.0);
      }
    }
    const auto distance = [&](const World& a, const World& b) {
      double square = 0.0;
      for (std::uint32_t i = 0; i < scene.mats.size(); ++i)
        square += (a.position(i) - b.position(i)).squaredNorm();
      return std::sqrt(square);
    };
    World one(std::make_shared<const engine::Network>(scene));
    World other(std::make_shared<const engine::Network>(disturbed));
    const double before = distance(one, other);
    double most = 0.0;
    for (int n = 0; n < 500 && !(most > 10.0 * before); ++n) {
      one.step();
      other.step();
      most = std::max(most, distance(one, other));
    }
    EXPECT_GT(most, 10.0 * before) << "seed " << seed;
    ++grown;
  }
  EXPECT_GE(grown, test::rounds(10));
}

}  // namespace
}  // namespace cordis::sim
