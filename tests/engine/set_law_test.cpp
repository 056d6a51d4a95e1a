// tests/engine/set_law_test.cpp -- set liaisons against the sum over all pairs.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/pairs/set_pairs.h"
#include "tests/engine/balls.h"
#include "tests/engine/programs.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

constexpr double kSetRange = 0.12;

struct Pair {
  double distance;
  double elongation;
  double speed;
  double mass_a;
  double mass_b;
};

/// A law, and its tension written down once more.
struct LawCase {
  std::string name;
  LinkState state;
  double rest_length;  // < 0: sum of the radii
  std::function<double(const Pair&)> tension;
};

std::vector<LawCase> laws() {
  std::vector<LawCase> cases;
  cases.push_back({"contact", contact(400.0, 0.0), -1.0,
                   [](const Pair& p) { return std::min(0.0, 400.0 * p.elongation); }});
  cases.push_back({"damped_contact", contact(400.0, 0.3), -1.0, [](const Pair& p) {
                     return std::min(0.0, 400.0 * p.elongation + 0.3 * p.speed);
                   }});

  LinkState limited;
  limited.stiffness = 100.0;
  limited.force_limit = 1.5;
  cases.push_back({"limited_spring", limited, 0.07,
                   [](const Pair& p) { return std::clamp(100.0 * p.elongation, -1.5, 1.5); }});

  LinkState table;
  table.elasticity = engine::Table{{-0.05, 0.0, 0.02, 0.05}, {-8.0, 0.0, 1.0, 0.0}};
  cases.push_back({"table", table, 0.06, [](const Pair& p) {
                     const double e = p.elongation;
                     if (e < -0.05) return -8.0;
                     if (e < 0.0) return 160.0 * e;
                     if (e < 0.02) return 50.0 * e;
                     return e < 0.05 ? 1.0 - (e - 0.02) / 0.03 : 0.0;
                   }});

  LinkState hertz;
  hertz.elasticity = engine::Power{900.0, 1.5};
  hertz.dissipation = engine::Power{0.05, 2.0};
  hertz.pulls = false;
  cases.push_back({"power", hertz, -1.0, [](const Pair& p) {
                     const double elastic =
                         std::copysign(900.0 * std::pow(std::abs(p.elongation), 1.5), p.elongation);
                     return std::min(0.0, elastic + 0.05 * p.speed * std::abs(p.speed));
                   }});

  LinkState rings;
  rings.viscosity = 0.01;
  rings.elasticity = engine::Rings{{{200.0, 0.07}, {-30.0, 0.1}}};
  cases.push_back({"rings", rings, 0.0, [](const Pair& p) {
                     return -200.0 * std::max(0.0, 0.07 - p.distance) +
                            30.0 * std::max(0.0, 0.1 - p.distance) + 0.01 * p.speed;
                   }});

  const auto lj = [](const Pair& p) {
    const double s = std::pow(0.05 / p.distance, 6.0);
    return p.distance < 0.11 ? 24.0 * 1e-4 * (s - 2.0 * s * s) / p.distance : 0.0;
  };
  cases.push_back({"lennard_jones", lennard_jones(1e-4, 0.05, 0.11), 0.0, lj});
  LinkState damped = lennard_jones(1e-4, 0.05, 0.11);
  damped.viscosity = 0.02;
  cases.push_back({"damped_lennard_jones", damped, 0.0,
                   [lj](const Pair& p) { return lj(p) + 0.02 * p.speed; }});

  LinkState expression;
  expression.elasticity =
      expression_law(20.0 * q(Quantity::kElongation) * (q(Quantity::kMassA) + q(Quantity::kMassB)) +
                     0.1 * q(Quantity::kSpeed) - 0.01 * q(Quantity::kDistance));
  cases.push_back({"expression", expression, 0.06, [](const Pair& p) {
                     return 20.0 * p.elongation * (p.mass_a + p.mass_b) + 0.1 * p.speed -
                            0.01 * p.distance;
                   }});
  return cases;
}

/// Balls that the law cannot fling apart, far enough from each other for a Lennard-Jones start.
NetworkDescription scene_of(const LawCase& law, int dimension, std::uint32_t split) {
  const double side = dimension == 1 ? 1.5 : (dimension == 2 ? 0.5 : 0.35);
  NetworkDescription scene = cloud(0, side, 0.5, dimension);
  const NetworkDescription many = cloud(600, side, 0.5, dimension);
  for (std::size_t i = 0; i < many.mats.size() && scene.mats.size() < 40; ++i) {
    const bool is_free = std::all_of(scene.mats.begin(), scene.mats.end(), [&](const Mat& other) {
      return (other.position - many.mats[i].position).norm() > 0.045;
    });
    if (!is_free) continue;
    scene.mats.push_back(many.mats[i]);
    scene.radius.push_back(many.radius[i]);
  }
  add_set(scene, law.state, kSetRange, law.rest_length,
          std::min(split, static_cast<std::uint32_t>(scene.mats.size())));
  return scene;
}

/// The forces on all MATs, pair by pair, as the law is written down.
std::vector<Vec3> forces_of_all_pairs(const NetworkDescription& scene, const LawCase& law,
                                      const std::vector<Vec3>& now, const std::vector<Vec3>& before,
                                      double& scale) {
  std::vector<Vec3> force(now.size(), Vec3::Zero());
  const SetLiaison& set = scene.sets.front();
  scale = 1e-6;
  const auto add_pair = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 along = now[b] - now[a];
    const double distance = along.norm();
    if (distance == 0.0 || !(distance < set.range)) return;
    const Vec3 axis = along / distance;
    const double rest = law.rest_length < 0.0 ? scene.radius[a] + scene.radius[b] : law.rest_length;
    const double speed = axis.dot(along - (before[b] - before[a])) / scene.step;
    const double tension =
        law.tension({distance, distance - rest, speed, scene.mats[a].mass, scene.mats[b].mass});
    force[a] += tension * axis;
    force[b] -= tension * axis;
    scale = std::max(scale, std::abs(tension));
  };
  for (std::size_t i = 0; i < set.set_p.size(); ++i) {
    if (set.set_q.empty()) {
      for (std::size_t j = i + 1; j < set.set_p.size(); ++j) add_pair(set.set_p[i], set.set_p[j]);
    }
    for (const std::uint32_t b : set.set_q) add_pair(set.set_p[i], b);
  }
  return force;
}

struct Scene {
  int dimension;
  std::uint32_t split;  // MATs of P
};

class SetLaws : public testing::TestWithParam<Scene> {};

TEST_P(SetLaws, AreTheSumOverAllPairs) {
  for (const LawCase& law : laws()) {
    const NetworkDescription scene = scene_of(law, GetParam().dimension, GetParam().split);
    World world = make_world(scene);
    const auto count = static_cast<std::uint32_t>(scene.mats.size());
    std::vector<Vec3> now(count);
    std::vector<Vec3> before(count);
    double most = 0.0;
    for (int n = 0; n < 600; ++n) {
      if (n % (600 / rounds(600)) != 0) {
        world.step();
        continue;
      }
      for (std::uint32_t i = 0; i < count; ++i) {
        now[i] = world.position(i);
        before[i] = world.position(i) - scene.step * world.velocity(i);
      }
      const engine::StepReport report = world.step();
      ASSERT_EQ(report.non_finite_mats, 0U) << law.name;
      double scale = 0.0;
      const std::vector<Vec3> expected = forces_of_all_pairs(scene, law, now, before, scale);
      for (std::uint32_t i = 0; i < count; ++i) {
        // the delayed positions are taken back from speeds: 1e-16 / dt in the speed
        ASSERT_LT((world.link_force(i) - expected[i]).norm(), 1e-12 * scale * count)
            << law.name << ", step " << n << ", MAT " << i;
        most = std::max(most, expected[i].norm());
      }
    }
    EXPECT_GT(most, 1e-4) << law.name;  // balls have met
  }
}

TEST_P(SetLaws, AreTheSameBitsForEveryWidth) {
  for (const LawCase& law : laws()) {
    const NetworkDescription scene = scene_of(law, GetParam().dimension, GetParam().split);
    World narrow = make_world(scene, VectorWidth::kSse2);
    run(narrow, 1500);
    for (const VectorWidth width : engine::supported_vector_widths()) {
      World world = make_world(scene, width);
      run(world, 1500);
      EXPECT_EQ(world.state_hash(), narrow.state_hash())
          << law.name << ", " << engine::to_string(width);
      EXPECT_EQ(world.energy().dissipated, narrow.energy().dissipated) << law.name;
      EXPECT_EQ(world.energy().elastic, narrow.energy().elastic) << law.name;
    }
  }
}

TEST_P(SetLaws, KeepMomentumAndCloseTheAccount) {
  for (const LawCase& law : laws()) {
    World world = make_world(scene_of(law, GetParam().dimension, GetParam().split));
    const Vec3 before = world.momentum();
    for (int n = 0; n < 10'000; ++n) {
      world.step();
      if (n % 100 != 0) continue;
      const engine::Energy energy = world.energy();
      ASSERT_LT(std::abs(energy.residual()), 1e-10 * energy.largest) << law.name << ", step " << n;
    }
    // positions of some metres are rounded to 5e-16 m a step, which is 5e-13 m/s in a speed
    EXPECT_LT((world.momentum() - before).norm(), 5e-13 * std::sqrt(10'000 * 40.0)) << law.name;
  }
}

TEST_P(SetLaws, StepWithoutAllocating) {
  for (const LawCase& law : laws()) {
    World world = make_world(scene_of(law, GetParam().dimension, GetParam().split));
    const AllocationGuard guard;
    run(world, 300);
    EXPECT_EQ(guard.count(), 0U) << law.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SetLaws,
                         testing::Values(Scene{1, 1000}, Scene{2, 1000}, Scene{3, 1000},
                                         Scene{1, 15}, Scene{2, 30}, Scene{3, 1}),
                         [](const auto& scene) {
                           return std::to_string(scene.param.dimension) + "d" +
                                  (scene.param.split > 100
                                       ? "_within"
                                       : "_" + std::to_string(scene.param.split));
                         });

/// Positions after some steps with the neighbour list's skin held; a skin beyond the world is the
/// sum over all pairs.
std::vector<double> positions_with_skin(const NetworkDescription& scene, double skin) {
  const auto width = engine::best_vector_width();
  const engine::StateTable table(scene.state_machines, scene.step);
  engine::EventLog log(table, 16);
  engine::ThreadTeam alone(1);
  engine::MatArray mats(scene, {}, engine::MatBlocks(scene));
  engine::SetPairs set(scene, 0, table, engine::pair_kernel(width));
  if (skin >= 0.0) set.neighbours().hold_skin(skin);
  for (std::uint64_t n = 0; n < 2000; ++n) {
    mats.clear_forces(alone);
    static_cast<void>(set.add_forces({table, engine::state_kernel(width), log, n, false, true},
                                     mats.force_columns()));
    static_cast<void>(mats.advance(engine::step_kernel(width), alone));
  }
  std::vector<double> positions;
  for (std::uint32_t i = 0; i < mats.count(); ++i) {
    for (const double value : mats.position(i)) positions.push_back(value);
  }
  return positions;
}

TEST(SetLiaison, IsTheSameBitsForEverySkin) {
  for (const LawCase& law : laws()) {
    for (const int dimension : {1, 3}) {
      const NetworkDescription scene = scene_of(law, dimension, dimension == 1 ? 12 : 1000);
      const std::vector<double> of_all_pairs = positions_with_skin(scene, 1e6);
      for (const double skin : {-1.0, 0.0, 0.003, 0.05}) {
        EXPECT_EQ(positions_with_skin(scene, skin), of_all_pairs) << law.name << ", skin " << skin;
      }
    }
  }
}

TEST(SetLiaison, HasNoForceBetweenBallsAtTheSamePlace) {
  NetworkDescription scene = cloud(2, 0.0, 0.0, 3);
  add_set(scene, contact(100.0, 1.0), kSetRange, -1.0, 2);
  World world = make_world(scene);

  run(world, 10);

  EXPECT_EQ(world.position(0), world.position(1));
  EXPECT_EQ(world.link_force(0), Vec3::Zero());
}

TEST(SetLiaison, OfMorePairsThanAreTakenTogetherIsTheSumOverAllPairs) {
  const LawCase law = laws()[3];
  constexpr double kNear = 0.1;
  NetworkDescription scene = cloud(400, 0.8, 0.3, 2);
  add_set(scene, law.state, kNear, law.rest_length, 400);
  World world = make_world(scene);
  run(world, 20);
  std::vector<Vec3> now;
  std::vector<Vec3> before;
  std::size_t pairs = 0;
  for (std::uint32_t i = 0; i < 400; ++i) {
    now.push_back(world.position(i));
    before.push_back(world.position(i) - scene.step * world.velocity(i));
    for (std::uint32_t j = 0; j < i; ++j) pairs += (now[i] - now[j]).norm() < kNear ? 1U : 0U;
  }
  ASSERT_GT(pairs, 3000U);

  world.step();

  double scale = 0.0;
  const std::vector<Vec3> expected = forces_of_all_pairs(scene, law, now, before, scale);
  for (std::uint32_t i = 0; i < 400; ++i) {
    EXPECT_LT((world.link_force(i) - expected[i]).norm(), 1e-12 * scale * 400) << i;
  }
}

TEST(SetLiaison, IsNotDisturbedByABallThatFliesAway) {
  NetworkDescription scene = cloud(60, 0.4, 0.1, 3);
  add_set(scene, contact(100.0, 0.1), kSetRange, -1.0, 60);
  NetworkDescription alone = scene;
  scene.mats[59].velocity = Vec3(1e6, 2e5, -1e5);
  alone.mats[59].position = Vec3(1e6, 0, 0);  // far from the beginning
  scene.mats[59].position = Vec3(50.0, 0, 0);
  World world = make_world(scene);
  World other = make_world(alone);

  run(world, 2000);
  run(other, 2000);

  EXPECT_GT(world.position(59).norm(), 1e6);
  for (std::uint32_t i = 0; i < 59; ++i) EXPECT_EQ(world.position(i), other.position(i)) << i;
}

TEST(SetLiaison, GoesOnWithoutBallsThatAreNotFinite) {
  NetworkDescription scene = cloud(60, 0.4, 0.1, 3);
  scene.mats[5].mass = 1e-300;  // any push flings it out of all numbers
  add_set(scene, contact(100.0, 0.1), kSetRange, -1.0, 60);
  World world = make_world(scene);
  std::uint32_t lost = 0;

  for (int n = 0; n < 3000; ++n) lost = world.step().non_finite_mats;

  EXPECT_EQ(lost, 1U);
  for (std::uint32_t i = 0; i < 60; ++i) {
    EXPECT_EQ(world.position(i).allFinite(), i != 5) << i;
  }
}

TEST(SetLiaison, ReportsThatItHasNoRoomForItsPairsAndIsRightAllTheSame) {
  if (rounds(2) == 1) GTEST_SKIP() << "34 million pairs take half a minute under sanitizers";
  // 8,300 balls in a heap are 34 million pairs: more than a neighbour list takes
  NetworkDescription scene = cloud(8300, 0.01, 0.0, 3);
  add_set(scene, contact(1.0, 0.0), kSetRange, -1.0, 8300);
  World world = make_world(scene);

  const engine::StepReport report = world.step();

  EXPECT_EQ(report.overflowed_sets, 1U);
  for (const std::uint32_t i : {0U, 4000U, 8299U}) {
    Vec3 expected = Vec3::Zero();
    for (std::uint32_t j = 0; j < 8300; ++j) {
      if (i == j) continue;
      const Vec3 along = scene.mats[j].position - scene.mats[i].position;
      const double overlap = along.norm() - scene.radius[i] - scene.radius[j];
      expected += std::min(0.0, overlap) / along.norm() * along;
    }
    EXPECT_LT((world.link_force(i) - expected).norm(), 1e-12 * 8300 * 0.1) << i;
  }
}

TEST(SetLiaison, OfPortsAndFixedPointsCountsTheWorkOfThePorts) {
  NetworkDescription scene = cloud(40, 0.3, 0.0, 3);
  scene.mats[0].kind = MatKind::kPort;
  scene.mats[0].velocity = Vec3::Zero();
  for (std::uint32_t i = 30; i < 40; ++i) {
    scene.mats[i].kind = MatKind::kFixed;
    scene.mats[i].velocity = Vec3::Zero();
  }
  add_set(scene, contact(300.0, 0.2), kSetRange, -1.0, 40);
  World world = make_world(scene);

  for (int n = 0; n < 10'000; ++n) {
    world.impose_position(0, Vec3(0.1 * std::sin(0.003 * n), 0.1 * std::sin(0.002 * n), 0.0));
    world.step();
    const engine::Energy energy = world.energy();
    ASSERT_LT(std::abs(energy.residual()), 1e-11 * energy.largest) << "step " << n;
  }
  EXPECT_GT(world.energy().port_work, 0.01);
  EXPECT_GT(world.energy().dissipated, 0.01);
}

double error_of_stored_energy(double step) {
  NetworkDescription scene = cloud(0, 0.0, 0.0, 3);
  scene.step = step;
  const double bond = 0.05 * std::cbrt(std::sqrt(2.0));
  for (const double x : {0.0, 0.92, 2.0, 3.05}) {
    scene.mats.push_back(mass(1.0, Vec3(x * bond, 0.2 * x * x * bond, 0.0)));
  }
  add_set(scene, lennard_jones(1e-3, 0.05, 0.0), 1.0, 0.0, 4);
  World world = make_world(scene);
  double most = 0.0;
  for (int n = 0; n * step < 3.0; ++n) {
    world.step();
    const engine::Energy energy = world.energy();
    most = std::max(most, std::abs(energy.elastic_error) / energy.largest);
  }
  return most;
}

TEST(SetLiaison, StoresWhatItsLawSaysToSecondOrder) {
  const double coarse = error_of_stored_energy(0.01);
  const double fine = error_of_stored_energy(0.005);

  EXPECT_LT(coarse, 0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.3);
}

TEST(SetLiaison, GoesOnFromASnapshotToTheSameBits) {
  for (const LawCase& law : laws()) {
    const NetworkDescription scene = scene_of(law, 3, 1000);
    World world = make_world(scene);
    run(world, 700);
    const engine::Snapshot snapshot = world.snapshot();
    run(world, 700);

    World other = make_world(scene);
    run(other, 13);
    other.restore(snapshot);
    EXPECT_EQ(other.snapshot().state, snapshot.state) << law.name;
    run(other, 700);

    EXPECT_EQ(other.state_hash(), world.state_hash()) << law.name;
    EXPECT_EQ(other.energy().elastic, world.energy().elastic) << law.name;
    EXPECT_EQ(other.energy().dissipated, world.energy().dissipated) << law.name;
    engine::Snapshot torn = snapshot;
    torn.state.pop_back();
    EXPECT_THROW(other.restore(torn), std::invalid_argument);
  }
}

TEST(SetLiaison, TakesOtherParametersBetweenTwoSteps) {
  NetworkDescription scene = cloud(40, 0.3, 0.2, 3);
  add_set(scene, contact(300.0, 0.0), kSetRange, -1.0, 40);
  World world = make_world(scene);
  run(world, 300);

  engine::StateMachine softer = scene.state_machines[0];
  softer.states[0] = contact(30.0, 0.5);
  world.replace_state_machine(0, softer);
  engine::Energy energy = world.energy();
  EXPECT_LT(energy.switching, 0.0);  // nine tenths of what was stored
  EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);

  run(world, 3000);
  energy = world.energy();
  EXPECT_GT(energy.dissipated, 0.0);
  EXPECT_LT(std::abs(energy.residual()), 1e-11 * energy.largest);
}

}  // namespace
}  // namespace cordis::test
