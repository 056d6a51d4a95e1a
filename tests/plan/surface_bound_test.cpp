// tests/plan/surface_bound_test.cpp
#include "sim_node/plan/stability/surface_bound.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/rate.h"
#include "sim_node/plan/reach_limit.h"
#include "sim_node/plan/reference/reference_integrator.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "sim_node/plan/stability/partner_bound.h"
#include "sim_node/plan/stability/start_tangent.h"
#include "sim_node/plan/stability/step_bound.h"
#include "tests/engine/programs.h"
#include "tests/engine/surfaces.h"
#include "tests/plan/networks.h"
#include "tests/plan/shapes.h"

namespace cordis::test {
namespace {

using plan::max_surfaces_in_reach;

constexpr double kReach = kReachOfShapes;

TEST(SurfaceBound, CountsAFloorAndAWallTogetherAndTwoWallsFarApartOnce) {
  Shapes floor;
  floor.add(plane(Vec3::UnitY()));
  EXPECT_EQ(floor.most(), 1.0);
  EXPECT_EQ(Shapes(floor).add(plane(Vec3::UnitX())).most(), 2.0);
  const auto ceiling = [&](double height) {
    return Shapes(floor).add(plane(-Vec3::UnitY()), Vec3(0.0, height, 0.0)).most();
  };
  EXPECT_EQ(ceiling(1.999 * kReach), 2.0);
  EXPECT_EQ(ceiling(2.001 * kReach), 1.0);
  // matter is pushed out of one side however deep it is
  EXPECT_EQ(Shapes(floor).add(plane(Vec3::UnitY()), Vec3(0.0, 9.0, 0.0)).most(), 2.0);
  Shapes shelves;
  for (const double height : {0.0, 1.0}) {
    shelves.add(plane(Vec3::UnitY(), true), Vec3(0.0, height, 0.0));
  }
  EXPECT_EQ(shelves.most(), 1.0);
  Shapes room = floor;
  for (const double side : {1.0, -1.0}) {
    room.add(plane(side * Vec3::UnitX()), Vec3(-side, 0.0, 0.0));
    room.add(plane(side * Vec3::UnitZ()), Vec3(0.0, 0.0, -side));
  }
  EXPECT_EQ(room.most(), 3.0);
  // they meet 1.5 km away
  const Vec3 tilted = Vec3(-4e-5, -1.0, 0.0).normalized();
  EXPECT_EQ(Shapes(floor).add(plane(tilted), Vec3(0.0, 0.16, 0.0)).most(), 2.0);
}

TEST(SurfaceBound, CountsTheStepsThatABallMayTouchAtOnce) {
  Shapes stairs;
  for (int step = 0; step < 6; ++step) {
    stairs.add(box(Vec3(0.1, 0.1 * (step + 1), 0.5)), Vec3(0.2 * step, 0.1 * (step + 1), 0.0));
  }
  EXPECT_EQ(stairs.most(0.05), 2.0);
  EXPECT_EQ(stairs.most(0.11), 3.0);
  const auto corner_to_corner = [](double apart) {
    Shapes boxes;
    boxes.add(box(Vec3::Constant(1.0)));
    boxes.add(box(Vec3::Constant(1.0)), Vec3::Constant(2.0 + apart / std::sqrt(3.0)));
    return boxes.most();
  };
  EXPECT_EQ(corner_to_corner(1.999 * kReach), 2.0);
  EXPECT_EQ(corner_to_corner(2.001 * kReach), 1.0);
}

TEST(SurfaceBound, CountsPostsByTheGapBetweenThem) {
  for (const int dimension : {2, 3}) {
    const auto posts = [&](double gap) {
      Shapes shapes;
      shapes.add(cylinder(Vec3::UnitZ(), 0.3));
      shapes.add(cylinder(Vec3::UnitZ(), 0.2), Vec3(0.3, 0.4, 0.0) * (0.5 + gap) / 0.5);
      return shapes.most(kReach, dimension);
    };
    EXPECT_EQ(posts(1.99 * kReach), 2.0);
    EXPECT_EQ(posts(2.01 * kReach), 1.0);
  }
  Shapes crossing;
  crossing.add(cylinder(Vec3::UnitX(), 0.1, 2.0));
  crossing.add(cylinder(Vec3::UnitY(), 0.1, 2.0), Vec3(0.0, 0.0, 0.2 + 2.05 * kReach));
  EXPECT_EQ(crossing.most(), 1.0);
  crossing.centres[1].z() = 0.2 + 1.95 * kReach;
  EXPECT_EQ(crossing.most(), 2.0);
}

TEST(SurfaceBound, CountsTheSidesOfAPolylineThatABallMayTouchAtOnce) {
  const auto line_of = [](const std::vector<Vec3>& corners) {
    NetworkDescription scene;
    scene.dimension = 2;
    Shapes shapes;
    for (const std::uint32_t mat : add_polyline(scene, corners))
      shapes.add(scene.surfaces[mat], scene.mats[mat].position);
    return shapes;
  };
  const Shapes zigzag =
      line_of({Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(2, 0, 0), Vec3(3, 1, 0), Vec3(4, 0, 0)});
  EXPECT_EQ(zigzag.most(kReach, 2), 2.0);
  EXPECT_EQ(line_of({Vec3(0, 0, 0), Vec3(1, 0, 0)}).most(kReach, 2), 1.0);
  const auto beside_a_wall = [&](double gap) {
    return line_of({Vec3(0, 0, 0), Vec3(1, 0, 0)})
        .add(plane(-Vec3::UnitX()), Vec3(1.0 + gap, 0.0, 0.0))
        .most(kReach, 2);
  };
  EXPECT_EQ(beside_a_wall(1.99 * kReach), 2.0);
  EXPECT_EQ(beside_a_wall(2.01 * kReach), 1.0);
}

/// A ball, a floor, and two boxes far from it and from each other.
NetworkDescription two_boxes_over_a_floor() {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {mass(1.0, Vec3(0.0, 1.0, 0.0))};
  scene.radius = {kReach};
  std::vector<std::uint32_t> surfaces = {add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero())};
  for (const double x : {-5.0, 5.0})
    surfaces.push_back(add_surface(scene, box(Vec3(1.0, 1.0, kNoEnd)), Vec3(x, 9.0, 0.0)));
  touch(scene, 1, of_one_state(contact(100.0, 0.0)), kReach, -1.0, surfaces);
  return scene;
}

/// @param turn  first number of its matrix
void drive(NetworkDescription& scene, std::uint32_t surface, std::uint32_t function,
           double turn = 1.0) {
  engine::Drive drive{surface, function, false, scene.mats[surface].position};
  drive.turn[0] = turn;
  scene.drives.push_back(drive);
  scene.mats[surface].kind = MatKind::kPort;
  scene.time_functions.resize(2);
}

TEST(SurfaceBound, CountsDrivenSurfacesWithAllThatTheyMayComeTo) {
  const auto most = [](const NetworkDescription& scene) {
    return plan::partner_bounds(scene, scene.sets[0]).possible.back();
  };
  NetworkDescription scene = two_boxes_over_a_floor();
  EXPECT_EQ(most(scene), 1.0);
  drive(scene, 2, 0);
  EXPECT_EQ(most(scene), 2.0) << "it may come to the floor, or to the other box";
  NetworkDescription together = scene;
  drive(together, 3, 0);
  EXPECT_EQ(most(together), 2.0) << "they keep their distance";
  NetworkDescription apart = scene;
  drive(apart, 3, 1);
  EXPECT_EQ(most(apart), 3.0);
  NetworkDescription across = scene;
  drive(across, 3, 0, -1.0);
  EXPECT_EQ(most(across), 3.0);
  NetworkDescription at_rest = two_boxes_over_a_floor();
  at_rest.sets[0].set_p = {2, 3};
  EXPECT_EQ(most(at_rest), 1.0);
  drive(at_rest, 3, 0);
  EXPECT_EQ(most(at_rest), 2.0);
}

TEST(SurfaceBound, IsNeverBelowTheTrueNumberOfSegmentsAtAnyPlace) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    const auto place = [&](double reach) {
      const double x = uniform(-reach, reach);
      return Vec3(x, uniform(-reach, reach), 0.0);
    };
    Shapes shapes;
    for (int s = 0; s < 8; ++s) {
      const Vec3 direction = place(1.0).normalized();
      if (s < 6) {
        shapes.add(segment(direction, uniform(0.05, 0.5)), place(1.0));
      } else {
        shapes.add(plane(direction, true), place(1.0));
      }
    }
    const double reach = uniform(0.05, 0.3);
    const double bound = shapes.most(reach, 2);
    double most = 0.0;
    for (int n = 0; n < 3000; ++n) {
      const Vec3 here = place(1.2);
      double count = 0.0;
      for (std::size_t s = 0; s < shapes.surfaces.size(); ++s) {
        if (engine::distance_from(shapes.surfaces[s], shapes.centres[s], here).distance < reach)
          count += 1.0;
      }
      most = std::max(most, count);
    }
    EXPECT_LE(most, bound) << seed;
  }
}

TEST(SurfaceBound, IsNeverBelowTheTrueNumberAtAnyPlace) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    const auto place = [&](double reach) {
      return Vec3(uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach));
    };
    Shapes shapes;
    for (int s = 0; s < 8; ++s) {
      const auto kind = random() % 3;
      const Vec3 direction = place(1.0).normalized();
      if (kind == 0) shapes.add(plane(direction, true), place(1.0));
      if (kind == 1) shapes.add(box(place(0.3).cwiseAbs() + Vec3::Constant(0.01)), place(1.0));
      if (kind == 2) {
        const double half = random() % 3 == 0 ? kNoEnd : uniform(0.05, 0.5);
        shapes.add(cylinder(direction, uniform(0.05, 0.3), half), place(1.0));
      }
    }
    const double reach = uniform(0.05, 0.3);
    const double bound = shapes.most(reach);
    double most = 0.0;
    for (int n = 0; n < 3000; ++n) {
      const Vec3 here = place(1.2);
      double count = 0.0;
      for (std::size_t s = 0; s < shapes.surfaces.size(); ++s) {
        const double distance =
            engine::distance_from(shapes.surfaces[s], shapes.centres[s], here).distance;
        if (distance < reach) count += 1.0;
      }
      most = std::max(most, count);
    }
    EXPECT_LE(most, bound) << seed;
  }
}

constexpr double kStiffness = 2000.0;
constexpr double kMass = 0.2;

/// A ball pressed into the corner of a floor and a wall that lean towards each other by this angle
/// [rad]: at 0 both push along the same line.
NetworkDescription ball_in_corner(double angle, double step) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = step;
  scene.mats = {mass(kMass, Vec3(1e-3, 0.04, 0.0))};
  scene.radius = {0.05};
  scene.gravity = Vec3(0.0, -9.81, 0.0);
  const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
  const std::uint32_t wall =
      add_surface(scene, plane(Vec3(std::sin(angle), std::cos(angle), 0.0)), Vec3::Zero());
  touch(scene, 1, contact(kStiffness), 0.05, -1.0, {floor, wall});
  return scene;
}

TEST(SurfaceBound, OfOneFloorIsThatOfALinkWithAFixedPoint) {
  NetworkDescription scene = ball_in_corner(0.0, 1e-4);
  scene.sets[0].set_p.pop_back();
  const plan::StepBound bound = plan::certified_bound(scene, plan::liaison_graph(scene));
  EXPECT_NEAR(bound.step, 2.0 * std::sqrt(kMass / kStiffness), 1e-12);
}

TEST(SurfaceBound, CountsTwoThatPushAtOnceTwice) {
  const double limit = 2.0 * std::sqrt(kMass / (2.0 * kStiffness));
  const NetworkDescription scene = ball_in_corner(1e-6, 1e-4);
  const plan::StepBound bound = plan::certified_bound(scene, plan::liaison_graph(scene));
  EXPECT_NEAR(bound.step, limit, 1e-9 * limit);
  // and beyond it the start surely diverges
  EXPECT_NEAR(plan::StartTangent(scene).diverging_step(), limit, 1e-5 * limit);
  // a contact that comes and goes gains energy near its limit: what holds is bounded up to it
  const auto held = [](double step) {
    NetworkDescription stuck = ball_in_corner(1e-6, step);
    stuck.state_machines[0].states[0].pulls = true;
    stuck.sets[0].range = 1e30;
    return largest_excursion(stuck);
  };
  EXPECT_LT(held(0.999 * limit), 1.0);
  EXPECT_GT(held(1.01 * limit), 1e6);
}

/// A ball of 10 g and a radius of 10 mm between a floor and a ceiling 60 mm above it.
NetworkDescription ball_in_gap(StateMachine state_machine, double range) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {mass(0.01, Vec3(0.0, 0.005, 0.0))};
  scene.radius = {0.01};
  const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
  const std::uint32_t ceiling = add_surface(scene, plane(-Vec3::UnitY()), Vec3(0.0, 0.06, 0.0));
  touch(scene, 1, std::move(state_machine), range, -1.0, {floor, ceiling});
  return scene;
}

/// Touched for the first time, a ball is bound for good.
StateMachine glue(engine::RestRule rest = engine::RestRule::kKeep) {
  engine::LinkState idle;
  idle.pulls = false;
  return Behaving()
      .state(idle)
      .exit(q(Quantity::kDistance) < Term(0.012), 1, rest)
      .state(500.0)
      .state_machine;
}

TEST(SurfaceBound, IsWatchedWhereBondsOutlastTheirRange) {
  const auto limit_of = [](const StateMachine& state_machine) {
    NetworkDescription scene = ball_in_gap(state_machine, 0.02);
    scene.step = 0.0075;  // K' is 2.8 for one
    return plan::plan_of(scene, 10.0).stability.sets[0];
  };
  EXPECT_TRUE(limit_of(contact(500.0)).is_guaranteed());
  EXPECT_FALSE(limit_of(glue()).is_guaranteed());
  EXPECT_EQ(limit_of(glue()).most, 1u);
}

TEST(SurfaceBound, CountsWhatPushesBeyondTheRestLengthOfItsSet) {
  const auto step_of = [](const StateMachine& state_machine, double range) {
    const NetworkDescription scene = ball_in_gap(state_machine, range);
    return plan::certified_bound(scene, plan::liaison_graph(scene)).step;
  };
  const double one = 2.0 * std::sqrt(0.01 / 3e4);
  EXPECT_NEAR(step_of(contact(3e4), 0.04), one, 1e-9);
  const Term early = two(Operation::kMin, Term(0.0 * q(Quantity::kDistance)),
                         3e4 * (q(Quantity::kDistance) - 0.031));
  StateMachine law = state_machine(0.0, expression_law(early));
  law.states[0].pulls = false;
  EXPECT_NEAR(step_of(law, 0.04), one / std::sqrt(2.0), 1e-3 * one);
}

TEST(SurfaceBound, IsNotCertainWhereANormalFlips) {
  const auto uncertain = [](const Surface& surface, const StateMachine& state_machine,
                            double speed) {
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = 1e-4;
    scene.mats = {mass(0.01, Vec3(0.0, 0.2, 0.0), Vec3(0.0, -speed, 0.0))};
    scene.radius = {0.01};
    touch(scene, 1, state_machine, 0.02, -1.0, {add_surface(scene, surface, Vec3::Zero())});
    return plan::plan_of(scene, 10.0).stability.uncertainty.has_value();
  };
  const Surface wall = plane(Vec3::UnitY(), true);
  const Surface stone = box(Vec3(0.03, 0.025, kNoEnd));
  // K r^2 / 2 is 20 mJ, and the ball has 5 at 1 m/s.
  EXPECT_FALSE(uncertain(wall, contact(400.0), 1.0));
  EXPECT_TRUE(uncertain(wall, contact(400.0), 2.1));
  EXPECT_TRUE(uncertain(stone, contact(400.0), 2.1));
  EXPECT_FALSE(uncertain(plane(Vec3::UnitY()), contact(400.0), 20.0));
  EXPECT_FALSE(uncertain(cylinder(Vec3::UnitZ(), 0.03), contact(400.0), 2.1));
  EXPECT_FALSE(uncertain(stone, glue(), 0.1));
  EXPECT_TRUE(uncertain(stone, glue(engine::RestRule::kHere), 0.1));
}

/// Balls of 10 g and a radius of 10 mm, 0.2 m above a thin wall that takes 20 mJ to pass.
NetworkDescription balls_above_a_wall(std::uint32_t count = 1) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  for (std::uint32_t i = 0; i < count; ++i) scene.mats.push_back(mass(0.01, Vec3(0.0, 0.2, 0.0)));
  scene.radius.assign(count, 0.01);
  touch(scene, count, contact(400.0), 0.02, -1.0,
        {add_surface(scene, plane(Vec3::UnitY(), true), Vec3::Zero())});
  return scene;
}

bool is_certain(const NetworkDescription& scene) {
  return !plan::plan_of(scene, 10.0).stability.uncertainty.has_value();
}

TEST(SurfaceBound, IsNotCertainWhereAFallCarriesABallThroughAWall) {
  NetworkDescription scene = balls_above_a_wall();
  scene.gravity = Vec3(0.0, -8.0, 0.0);  // 16 mJ in 0.2 m
  EXPECT_TRUE(is_certain(scene));
  scene.gravity = Vec3(0.0, -10.5, 0.0);
  EXPECT_FALSE(is_certain(scene));
}

TEST(SurfaceBound, CountsTheFallOfEachBodyAlone) {
  NetworkDescription scene = balls_above_a_wall(6);
  scene.gravity = Vec3(0.0, -8.0, 0.0);
  EXPECT_TRUE(is_certain(scene)) << "six bodies";
  scene.links.push_back({2, 3, 0.0, 1.0, 0.0});
  EXPECT_FALSE(is_certain(scene)) << "a body of two";
}

TEST(SurfaceBound, IsNotCertainWhereASpringThrowsABallThroughAWall) {
  const auto holds = [](double stored) {
    NetworkDescription scene = balls_above_a_wall();
    scene.mats.push_back(fixed(Vec3(0.0, 0.3, 0.0)));
    scene.radius.push_back(0.0);
    scene.links.push_back({2, 0, 2.0 * stored / (0.1 * 0.1), 0.0, 0.2});  // pressed by 0.1 m
    return is_certain(scene);
  };
  EXPECT_TRUE(holds(0.015));
  EXPECT_FALSE(holds(0.025));
}

TEST(SurfaceBound, WatchesTheEnergyThatABallPassesAWallWith) {
  NetworkDescription scene = balls_above_a_wall();
  scene.mats[0].velocity = Vec3(0.0, -1.0, 0.0);
  ASSERT_TRUE(is_certain(scene));
  const plan::ReachLimit limit = plan::reach_limit(scene);
  ASSERT_EQ(limit.pairs.size(), 1u);
  EXPECT_NEAR(limit.pairs[0].energy, 0.02, 1e-3);
  for (const double speed : {1.9, 2.1}) {
    scene.mats[0].velocity = Vec3(0.0, -speed, 0.0);
    const World world = make_world(scene);
    EXPECT_EQ(plan::is_beyond(limit, world, world.energy()), speed > 2.0) << speed;
  }
}

/// A ball is thrown at a thin wall: by its speed, by its weight, by a spring.
struct Throw {
  NetworkDescription scene;
  bool is_certain = false;

  explicit Throw(unsigned seed) {
    Chance chance(seed);
    scene.dimension = 1 + static_cast<int>(seed % 3U);
    const Vec3 down = scene.dimension == 1 ? Vec3(-Vec3::UnitX()) : Vec3(-Vec3::UnitY());
    const double weight = chance(0.005, 0.05);
    const double radius = chance(0.005, 0.03);
    const double height = radius + chance(0.0, 0.3);
    const double stiffness = std::pow(10.0, chance(2.0, 4.0));
    const double barrier = 0.5 * stiffness * radius * radius;
    const auto energy = [&] { return chance(0.0, 1.0) < 0.4 ? barrier * chance(0.05, 1.5) : 0.0; };
    const Vec3 aside = scene.dimension == 1 ? Vec3(0, 0, 0) : Vec3(chance(-0.2, 0.2), 0, 0);
    scene.mats = {mass(weight, -height * down, std::sqrt(2.0 * energy() / weight) * down + aside)};
    scene.radius = {radius};
    scene.gravity = energy() / (weight * (height + radius)) * down;
    const double pressed = height + radius;
    scene.mats.push_back(fixed(-(height + 0.01) * down));
    scene.radius.push_back(0.0);
    scene.links.push_back({1, 0, 2.0 * energy() / (pressed * pressed), 0.0, 0.01 + pressed});
    touch(scene, 1, contact(stiffness), 2.0 * radius, -1.0,
          {add_surface(scene, plane(down, true), Vec3::Zero())});
    const double limit = plan::certified_bound(scene, plan::liaison_graph(scene)).step;
    scene.step = limit * chance(0.02, 0.3);
    is_certain = test::is_certain(scene);
  }

  bool passes() const {
    const Vec3 start = scene.mats[0].position;
    World world = make_world(scene);
    for (int n = 0; n < 20000; ++n) {
      world.step();
      if (world.position(0).dot(start) <= 0.0) return true;
    }
    return false;
  }
};

TEST(SurfaceBound, LetsNoBallPassAThinWallWhereItIsCertain) {
  int certain = 0;
  int pass = 0;
  for (unsigned seed = 1; seed <= 120; ++seed) {
    const Throw one(seed);
    if (one.is_certain) {
      ++certain;
      EXPECT_FALSE(one.passes()) << "seed " << seed;
    } else {
      pass += one.passes() ? 1 : 0;
    }
  }
  EXPECT_GT(certain, 20);
  EXPECT_GT(pass, 20);
}

/// A ball that falls on stairs, followed by the reference integrator.
TEST(SurfaceBound, LetsTheReferenceIntegratorFollowTheSameBall) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-5;
  scene.gravity = Vec3(0.0, -9.81, 0.0);
  scene.mats = {mass(kMass, Vec3(0.03, 0.3, 0.0), Vec3(0.4, 0.0, 0.0))};
  scene.radius = {0.05};
  std::vector<std::uint32_t> surfaces;
  surfaces.push_back(add_surface(scene, box(Vec3(0.1, 0.1, kNoEnd)), Vec3(0.0, 0.0, 0.0)));
  surfaces.push_back(add_surface(scene, cylinder(Vec3::UnitZ(), 0.08), Vec3(0.25, 0.0, 0.0)));
  surfaces.push_back(add_surface(scene, plane(Vec3::UnitY()), Vec3(0.0, -0.1, 0.0)));
  touch(scene, 1, contact(kStiffness), 0.05, -1.0, surfaces);
  World world = make_world(scene);
  const int steps = 40000;
  run(world, steps);

  plan::ReferenceIntegrator reference(scene, 1e-9);
  reference.advance_to(steps * scene.step);

  EXPECT_LT((reference.position(0) - world.position(0)).norm(), 1e-3);
}

}  // namespace
}  // namespace cordis::test
