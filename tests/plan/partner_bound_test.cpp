// tests/plan/partner_bound_test.cpp
#include "sim_node/plan/stability/partner_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/rate.h"
#include "tests/plan/networks.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using plan::Plan;
using plan::plan_of;

/// Masses on a cubic lattice, each joined to all others within the range.
NetworkDescription lattice(int edge, double spacing, const engine::StateMachine& law, double rest,
                           double range) {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-3;
  scene.state_machines.push_back(law);
  engine::SetLiaison set;
  for (int i = 0; i < edge * edge * edge; ++i) {
    const Vec3 cell(i % edge, i / edge % edge, i / (edge * edge));
    set.set_p.push_back(static_cast<std::uint32_t>(scene.mats.size()));
    scene.mats.push_back(mass(0.001, spacing * cell));
  }
  set.rest_length = rest;
  set.range = range;
  scene.sets.push_back(set);
  return scene;
}

/// A ball of 1 g above a floor of fixed points this far apart.
NetworkDescription ball_on_floor(double spacing, double stiffness) {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-3;
  scene.gravity = Vec3(0, 0, -9.81);
  scene.state_machines.push_back(contact(stiffness));
  engine::SetLiaison set;
  set.set_p = {0};
  scene.mats.push_back(mass(0.001, Vec3(0, 0, 0.02)));
  scene.radius.push_back(0.005);
  for (int i = -12; i <= 12; ++i) {
    for (int j = -12; j <= 12; ++j) {
      set.set_q.push_back(static_cast<std::uint32_t>(scene.mats.size()));
      scene.mats.push_back(fixed(spacing * Vec3(i, j, 0)));
      scene.radius.push_back(0.0);
    }
  }
  set.rest_length = -1.0;
  set.range = 0.005;
  scene.sets.push_back(set);
  return scene;
}

TEST(PackingBound, IsTheKissingNumberForBallsThatTouch) {
  EXPECT_EQ(plan::packing_bound(1, 1.0, 1.0), 2.0);
  EXPECT_EQ(plan::packing_bound(2, 1.0, 1.0), 6.0);
  EXPECT_EQ(plan::packing_bound(3, 1.0, 1.0), 12.0);
}

TEST(PackingBound, IsAboveTheDensestPackings) {
  // Within two diameters: 18 in the plane, 54 in space (12 + 6 + 24 + 12 of the fcc lattice).
  EXPECT_EQ(plan::packing_bound(1, 2.0, 1.0), 4.0);
  EXPECT_GE(plan::packing_bound(2, 2.0, 1.0), 18.0);
  EXPECT_LE(plan::packing_bound(2, 2.0, 1.0), 21.0);
  EXPECT_GE(plan::packing_bound(3, 2.0, 1.0), 54.0);
  EXPECT_GE(plan::packing_bound(3, 1.42, 1.0), 18.0);  // 12 + 6
}

TEST(PackingBound, KnowsNoUnitOfLength) {
  for (const int dimension : {1, 2, 3}) {
    for (const double q : {1.0, 1.3, 1.7, 3.1}) {
      const double bound = plan::packing_bound(dimension, q, 1.0);
      EXPECT_EQ(plan::packing_bound(dimension, 0.001 * q, 0.001), bound) << q;
      EXPECT_EQ(plan::packing_bound(dimension, 500.0 * q, 500.0), bound) << q;
    }
  }
}

TEST(MaxNeighbours, AreWhatFitsExactlyAroundABall) {
  for (int n = 7; n <= 60; ++n) {  // n discs of radius 1 that touch each other around one
    const double own = 1.0 / std::sin(std::numbers::pi / n) - 1.0;
    EXPECT_EQ(plan::max_neighbours(2, own, 1.0), n);
  }
  for (int n = 15; n <= 60; ++n) {  // n caps that fill the sphere
    const double half_angle = std::acos(1.0 - 2.0 / n);
    const double own = 1.0 / std::sin(half_angle) - 1.0;
    EXPECT_EQ(plan::max_neighbours(3, own, 1.0), n);
  }
}

TEST(MaxInReach, IsNeverBelowTheTrueNumberAtAnyPlace) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
    const int dimension = 1 + static_cast<int>(seed % 3);
    const auto place = [&] {
      return Vec3(uniform(), dimension > 1 ? uniform() : 0.0, dimension > 2 ? uniform() : 0.0);
    };
    std::vector<Vec3> points(200);
    for (Vec3& point : points) point = place();
    const double reach = 0.05 + 0.3 * uniform();
    const double bound = plan::max_in_reach(points, reach, dimension);
    std::size_t most = 0;
    for (int n = 0; n < 500; ++n) {
      const Vec3 centre = place();
      std::size_t count = 0;
      for (const Vec3& point : points) count += (point - centre).norm() < reach ? 1U : 0U;
      most = std::max(most, count);
    }
    EXPECT_GE(bound, static_cast<double>(most)) << "seed " << seed;
    EXPECT_LE(bound, 200.0) << "seed " << seed;
  }
}

TEST(Partners, OfACrowdWithinRangeOfEachOtherAreAllCounted) {
  // 125 masses of 1 g, each with 124 springs of 100 N/m: far beyond 4 at 1000 Hz.
  const NetworkDescription scene = lattice(5, 0.01, state_machine(100.0), 0.02, 1.0);

  const plan::Stability stability = plan_of(scene, 10.0).stability;

  ASSERT_EQ(stability.sets.size(), 1u);
  EXPECT_EQ(stability.sets[0].at_start, 124u);
  EXPECT_FALSE(stability.holds());
  EXPECT_TRUE(stability.diverges());
  EXPECT_LT(stability.certified.step, stability.diverging_step);
}

TEST(Partners, OfARowPressedTogetherAreAllCounted) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.state_machines.push_back(contact(500.0));
  engine::SetLiaison set;
  for (std::uint32_t i = 0; i < 100; ++i) {
    scene.mats.push_back(mass(0.001, Vec3(0.0005 * i, 0, 0)));
    set.set_p.push_back(i);
  }
  set.rest_length = set.range = 0.05;
  scene.sets.push_back(set);

  const plan::Stability stability = plan_of(scene, 10.0).stability;

  EXPECT_EQ(stability.sets[0].at_start, 99u);
  EXPECT_TRUE(stability.diverges());
}

TEST(Partners, OfABallOnAFloorAreThePointsInItsReachWhereverItFalls) {
  const NetworkDescription dense = ball_on_floor(0.0005, 200.0);
  const plan::Stability stability = plan_of(dense, 10.0).stability;
  EXPECT_EQ(stability.sets[0].at_start, 0u);  // it is still above
  EXPECT_FALSE(stability.holds());

  // Points a diameter apart: one or a few at a time.
  const plan::Stability coarse = plan_of(ball_on_floor(0.01, 20.0), 10.0).stability;
  EXPECT_TRUE(coarse.holds());
  EXPECT_TRUE(coarse.sets[0].is_guaranteed());
}

TEST(Partners, AreGuaranteedWhereThereAreNoMoreOthers) {
  const plan::Stability few = plan_of(lattice(2, 0.02, contact(5.0), 0.01, 0.01), 10.0).stability;
  EXPECT_TRUE(few.holds());
  EXPECT_TRUE(few.sets[0].is_guaranteed()) << "each has 7 others at most";

  const plan::Stability many = plan_of(lattice(6, 0.02, contact(20.0), 0.01, 0.01), 10.0).stability;
  EXPECT_TRUE(many.holds());
  ASSERT_FALSE(many.sets[0].is_guaranteed());
  EXPECT_NEAR(many.sets[0].least, 99.0, 1.0) << "of 215 others; 2 n K dt^2 / m < 4";
}

TEST(Partners, UpToTheCertifiedNumberAreStable) {
  // dt^2 n (K + K) / m < 4: with 5 N/m and 1 g up to 399 others.
  const NetworkDescription scene = lattice(8, 0.02, contact(5.0), 0.01, 0.01);
  const std::uint32_t certified = plan_of(scene, 10.0).stability.sets[0].least;
  EXPECT_LE(certified, 399u);
  EXPECT_GE(certified, 395u);
}

TEST(Partners, AreToldFromTheLeastOfAnyMemberToTheMost) {
  // More small balls fit around a large one than around another small one.
  NetworkDescription scene = lattice(6, 0.05, contact(20.0), -1.0, 0.05);
  for (std::size_t i = 0; i < scene.mats.size(); ++i)
    scene.radius.push_back(i % 2 == 0 ? 0.005 : 0.02);
  const plan::PartnerLimit limit = plan_of(scene, 10.0).stability.sets[0];
  const auto [least, most] = std::ranges::minmax(limit.certified);
  ASSERT_FALSE(limit.is_guaranteed());
  EXPECT_LT(least, most);
  EXPECT_EQ(limit.least, least);
  EXPECT_EQ(limit.most, most);
  EXPECT_EQ(limit.certified.size(), 216u);
}

TEST(Partners, OfManyLargeSetsAreRaisedTogetherAlone) {
  // Sets of 27 masses. The first is stable with 19 partners a mass, all others with 39.
  const auto soft_partners = [](int count) {
    NetworkDescription all = lattice(3, 0.02, contact(100.0), 0.01, 0.01);
    const NetworkDescription soft = lattice(3, 0.02, contact(50.0), 0.01, 0.01);
    all.state_machines.push_back(soft.state_machines[0]);
    while (all.sets.size() < static_cast<std::size_t>(count)) {
      engine::SetLiaison set = soft.sets[0];
      set.state_machine = 1;
      for (std::uint32_t& mat : set.set_p) mat += static_cast<std::uint32_t>(all.mats.size());
      all.mats.insert(all.mats.end(), soft.mats.begin(), soft.mats.end());
      all.sets.push_back(set);
    }
    const plan::Stability stability = plan_of(all, 10.0).stability;
    EXPECT_LT(stability.step, stability.certified.step);
    EXPECT_NEAR(stability.sets.front().least, 19.0, 1.0);
    return stability.sets.back().certified.front();
  };
  EXPECT_EQ(soft_partners(10), 26u) << "all there are";
  EXPECT_NEAR(soft_partners(200), 19.0, 1.0);
}

TEST(Partners, MakeTheRateOfACrowdHighEnough) {
  const NetworkDescription scene = [] {
    NetworkDescription crowd = lattice(5, 0.012, state_machine(300.0), 0.01, 10.0);
    crowd.state_machines[0].states[0].viscosity = 0.002;
    return crowd;
  }();
  const plan::FormulaRate choice = plan::rate_by_formula(scene, {0.01, 20.0, 1.0, 0.0}, 1000.0);

  NetworkDescription chosen = scene;
  chosen.step = 1.0 / choice.rate_hz;
  EXPECT_TRUE(plan_of(chosen, 20.0).stability.holds());
  World world = make_world(chosen);
  const double before = world.energy().total();
  double most = before;  // below 0: the pairs would be free beyond their range
  double swing = 0.0;
  for (int n = 0; n < rounds(5000); ++n) {
    world.step();
    const engine::Energy energy = world.energy();
    most = std::max(most, energy.kinetic + energy.elastic);
    swing = std::max(swing, energy.kinetic);
  }
  EXPECT_LE(most, before + 0.1 * swing);
}

TEST(StartTangent, OfASetIsTheTrueLimitOfALinearOne) {
  // Rest length 0: the force of every pair is linear in its difference in space. n masses, each
  // joined to all others: the largest eigenvalue is n K / m.
  NetworkDescription scene = lattice(3, 0.01, state_machine(100.0), 0.0, 1.0);
  const double exact = 2.0 / std::sqrt(27.0 * 100.0 / 0.001);
  const plan::Stability stability = plan_of(scene, 10.0).stability;
  EXPECT_NEAR(stability.diverging_step, exact, 1e-5 * exact);
  EXPECT_LE(stability.certified.step, exact);
}

TEST(StartTangent, TakesNoPairThatIsNotPressed) {
  // A contact that just touches has a tangent on one side alone.
  const NetworkDescription scene = lattice(3, 0.01, contact(100.0), 0.01, 0.02);
  EXPECT_TRUE(std::isinf(plan_of(scene, 10.0).stability.diverging_step));
}

}  // namespace
}  // namespace cordis::test
