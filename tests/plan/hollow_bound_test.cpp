// tests/plan/hollow_bound_test.cpp -- the certificate of hollow bodies, and their reference motion.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/reference/reference_integrator.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "sim_node/plan/stability/start_tangent.h"
#include "sim_node/plan/stability/step_bound.h"
#include "sim_node/plan/stability/surface_bound.h"
#include "tests/engine/programs.h"
#include "tests/engine/surfaces.h"
#include "tests/plan/networks.h"
#include "tests/plan/shapes.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

constexpr double kLayer = kReachOfShapes;

const Surface kRoom = box(Vec3(0.3, 0.4, kNoEnd));
constexpr double kThrownMass = 0.001;   // [kg]
constexpr double kThrownRadius = 0.01;  // [m]
const Surface kTube = cylinder(Vec3::UnitZ(), 0.3);

TEST(HollowBound, CountsTheFacesOfOneCorner) {
  EXPECT_EQ(Shapes().add_hollow(box(Vec3::Constant(0.3))).most(), 3.0);
  EXPECT_EQ(Shapes().add_hollow(kRoom).most(kLayer, 2), 2.0);
  EXPECT_EQ(Shapes().add_hollow(kRoom).most(kLayer, 3), 2.0);
  EXPECT_EQ(Shapes().add_hollow(box(Vec3(0.3, kNoEnd, kNoEnd))).most(kLayer, 1), 1.0);
  EXPECT_EQ(Shapes().add_hollow(kTube).most(kLayer, 2), 1.0);
  EXPECT_EQ(Shapes().add_hollow(cylinder(Vec3::UnitX(), 0.3, 0.5)).most(), 2.0);
}

TEST(HollowBound, CountsOppositeFacesThatABallTouchesAtOnce) {
  EXPECT_EQ(Shapes().add_hollow(box(Vec3(1.001 * kLayer, 0.4, kNoEnd))).most(kLayer, 2), 2.0);
  EXPECT_EQ(Shapes().add_hollow(box(Vec3(0.999 * kLayer, 0.4, kNoEnd))).most(kLayer, 2), 3.0);
  EXPECT_EQ(Shapes().add_hollow(cylinder(Vec3::UnitX(), 0.3, 1.001 * kLayer)).most(), 2.0);
  EXPECT_EQ(Shapes().add_hollow(cylinder(Vec3::UnitX(), 0.3, 0.999 * kLayer)).most(), 3.0);
}

TEST(HollowBound, CountsWhatIsInsideByItsGapFromEachFace) {
  const auto with_post = [](const Surface& body, const Vec3& place) {
    return Shapes().add_hollow(body).add(cylinder(Vec3::UnitZ(), 0.1), place).most(kLayer, 2);
  };
  EXPECT_EQ(with_post(kRoom, Vec3::Zero()), 2.0) << "the faces of a corner";
  EXPECT_EQ(with_post(kTube, Vec3(0.2 - 2.01 * kLayer, 0.0, 0.0)), 1.0);
  EXPECT_EQ(with_post(kTube, Vec3(0.2 - 1.99 * kLayer, 0.0, 0.0)), 2.0);
  // and in a corner of the room with both faces
  const auto in_corner = [&](double gap) {
    return Shapes()
        .add_hollow(kRoom)
        .add(box(Vec3(0.1, 0.1, kNoEnd)), Vec3(0.2 - gap, 0.3 - gap, 0.0))
        .most(kLayer, 2);
  };
  EXPECT_EQ(in_corner(1.99 * kLayer), 3.0);
  EXPECT_EQ(in_corner(2.01 * kLayer), 2.0);
}

TEST(HollowBound, CountsTheOutsideOnlyWithWhatIsOutside) {
  const Surface wide = box(Vec3(kNoEnd, 0.4, kNoEnd));
  const auto with_floor = [&](double gap) {
    return Shapes()
        .add_hollow(wide)
        .add(plane(Vec3::UnitY()), Vec3(0.0, -0.4 - gap, 0.0))
        .most(kLayer, 2);
  };
  EXPECT_EQ(with_floor(1.99 * kLayer), 2.0) << "the floor and the outside, above it";
  // Matter belongs above the floor, and is pushed out of what lies below: outside of the body that is so too.
  const auto with_wall = [&](double gap) {
    return Shapes()
        .add_hollow(wide)
        .add(plane(Vec3::UnitY(), true), Vec3(0.0, -0.4 - gap, 0.0))
        .most(kLayer, 2);
  };
  EXPECT_EQ(with_wall(1.99 * kLayer), 2.0);
  EXPECT_EQ(with_wall(2.01 * kLayer), 1.0);
  // One in the other: between them are the outside of one and the inside of the other.
  const auto nested = [&](double gap) {
    return Shapes()
        .add_hollow(kTube)
        .add_hollow(cylinder(Vec3::UnitZ(), 0.3 - gap))
        .most(kLayer, 2);
  };
  EXPECT_EQ(nested(1.99 * kLayer), 2.0);
  EXPECT_EQ(nested(2.01 * kLayer), 1.0);
}

TEST(HollowBound, IsNeverBelowTheTrueNumberAtAnyPlace) {
  double counted = 0.0;
  double bounded = 0.0;
  for (unsigned seed = 1; seed <= 90; ++seed) {
    Chance chance(seed);
    const int dimension = 2 + static_cast<int>(seed % 2);
    Shapes bodies;
    for (int s = 0; s < 5; ++s) {
      Surface body = chance.shape(dimension);
      const bool is_body = body.kind == SurfaceKind::kBox || body.kind == SurfaceKind::kCylinder;
      if (body.kind == SurfaceKind::kPlane) body.both_sides = true;
      if (body.kind == SurfaceKind::kBox && chance.random() % 3 == 0) body.half_size.x() = kNoEnd;
      const Vec3 centre = chance.place(0.5, dimension);
      if (is_body && chance.random() % 4 != 0) {
        bodies.add_hollow(body, centre);
      } else {
        bodies.add(body, centre);
      }
    }
    const double reach = chance(0.03, 0.2);
    const double bound = bodies.most(reach, dimension);
    double most = 0.0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 here = chance.place(0.9, dimension);
      double count = 0.0;
      for (std::size_t s = 0; s < bodies.surfaces.size(); ++s) {
        const auto from = engine::distance_from(bodies.surfaces[s], bodies.centres[s], here);
        if (from.distance < reach && !from.is_beyond) count += 1.0;
      }
      most = std::max(most, count);
    }
    EXPECT_LE(most, bound) << seed;
    counted += most;
    bounded += bound;
  }
  EXPECT_LT(bounded, 1.5 * counted) << "it is near";
}

/// A ball of 0.2 kg and 0.05 m at the bottom of a hollow cylinder of 0.4 m, which begins at rest.
NetworkDescription ball_at_bottom(double stiffness, double range, double rest, double start,
                                  double step) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = step;
  scene.mats = {mass(0.2, Vec3(1e-6, start - 0.4, 0.0))};
  scene.radius = {0.05};
  scene.gravity = Vec3(0.0, -stiffness * (rest - start) / 0.2, 0.0);
  const auto surfaces = add_hollow(scene, cylinder(Vec3::UnitZ(), 0.4), Vec3::Zero());
  touch(scene, 1, contact(stiffness), range, rest, surfaces);
  return scene;
}

TEST(HollowBound, OfAPlainContactIsThatOfAFloor) {
  const NetworkDescription scene = ball_at_bottom(2000.0, 0.05, 0.05, 0.049, 1e-4);
  const double limit = 2.0 * std::sqrt(0.2 / 2000.0);
  EXPECT_NEAR(plan::certified_bound(scene, plan::liaison_graph(scene)).step, limit, 1e-12);
  EXPECT_NEAR(plan::StartTangent(scene).diverging_step(), limit, 1e-6 * limit);
  EXPECT_FALSE(plan::plan_of(scene, 0.1).stability.uncertainty.has_value());
}

/// Across, 18 N at 0.2 m from the axis are 90 N/m, nine times what the spring is along the normal.
TEST(HollowBound, CountsWhatAConcaveWallAddsAcross) {
  constexpr double kSpring = 10.0;
  const NetworkDescription scene = ball_at_bottom(kSpring, 0.25, 2.0, 0.2, 1e-3);
  const double across_at_start = kSpring * 1.8 / 0.2;
  const double limit = 2.0 * std::sqrt(0.2 / across_at_start);
  EXPECT_NEAR(plan::StartTangent(scene).diverging_step(), limit, 1e-6 * limit);
  const double across_at_range = kSpring * 1.75 / 0.15;
  EXPECT_NEAR(plan::certified_bound(scene, plan::liaison_graph(scene)).step,
              2.0 * std::sqrt(0.2 / across_at_range), 1e-9);
  const auto farthest_after = [](double step) {
    World world = make_world(ball_at_bottom(kSpring, 0.25, 2.0, 0.2, step));
    double farthest = 0.0;
    for (int n = 0; n < 300; ++n) {
      world.step();
      farthest = std::max(farthest, std::abs(world.position(0).x()));
    }
    return farthest;
  };
  EXPECT_LT(farthest_after(0.99 * limit), 1e-4);
  EXPECT_GT(farthest_after(1.02 * limit), 0.01);
}

TEST(HollowBound, IsNotCertainWhereABallIsWiderThanItsCylinder) {
  const auto why = [](double rest) {
    NetworkDescription scene = ball_at_bottom(2000.0, 0.5, rest, rest - 0.001, 1e-4);
    const plan::Plan plan = plan::plan_of(scene, 0.1);
    return plan.stability.uncertainty ? std::string(plan.stability.uncertainty->why) : "";
  };
  EXPECT_EQ(why(0.39), "");
  EXPECT_NE(why(0.41).find("acts on the axis of a hollow cylinder"), std::string::npos)
      << why(0.41);
}

/// A contact that comes and goes by conditions: nothing, and a spring that also pulls while it has not ended.
StateMachine touching(double stiffness, const Term& begins, const Term& ends) {
  return Behaving().state(0.0).exit(begins, 1).state(stiffness).exit(ends, 0).state_machine;
}

std::string why_uncertain(StateMachine machine, double rest, std::vector<double> radii = {0.05},
                          const std::vector<double>& tubes = {0.4}) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  for (std::size_t i = 0; i < radii.size(); ++i)
    scene.mats.push_back(mass(0.2, Vec3(0.0, 0.02 * static_cast<double>(i), 0.0)));
  scene.radius = std::move(radii);
  const auto count = static_cast<std::uint32_t>(scene.mats.size());
  std::vector<std::uint32_t> surfaces;
  for (const double tube : tubes) {
    for (const std::uint32_t surface :
         add_hollow(scene, cylinder(Vec3::UnitZ(), tube), Vec3::Zero()))
      surfaces.push_back(surface);
  }
  touch(scene, count, std::move(machine), 0.2, rest, surfaces);
  const plan::Plan plan = plan::plan_of(scene, 0.1);
  return plan.stability.uncertainty ? plan.stability.uncertainty->why : "";
}

TEST(HollowBound, OfAContactOfTwoStatesIsCertainWhereItsExitSurelyEndsItBeforeTheAxis) {
  const Term e = q(Quantity::kElongation);
  const Term d = q(Quantity::kDistance);
  EXPECT_EQ(why_uncertain(touching(2000.0, e < 0.0, e >= 0.0), -1.0), "");
  EXPECT_EQ(why_uncertain(touching(2000.0, e<-0.001, e> 0.01), -1.0), "") << "sticky";
  EXPECT_EQ(why_uncertain(touching(2000.0, e<0.0, d> 0.06), -1.0), "");
  EXPECT_EQ(why_uncertain(touching(2000.0, e < 0.0, e >= 0.0), -1.0, {0.05, 0.03}), "");
  // It begins wherever a ball is in the wall by then, and so it brings in energy, but not on the axis.
  const auto late = touching(2000.0, both(e<0.0, q(Quantity::kAge)> 0.1), e >= 0.0);
  EXPECT_EQ(why_uncertain(late, -1.0).find("nothing bounds the energy that its changes of state"),
            0U);
  const std::string on_axis = "it acts on the axis of a hollow cylinder, where the normal flips";
  struct Case {
    const char* name;
    Term begins;
    Term ends;
  };
  for (const Case& bad : {
           Case{"never ends", e<0.0, e> 9.0},
           Case{"may last", e < 0.0, both(e >= 0.0, q(Quantity::kAge) > 0.1)},
           Case{"ends by its force", e<0.0, q(Quantity::kForce)> 0.0},
           Case{"begins anywhere", q(Quantity::kAge) > 0.5, e >= 0.0},
           Case{"begins on the axis", e < 0.4, e >= 0.0},
           Case{"ends with a rising", e < 0.0, one(Operation::kRising, e)},
       }) {
    EXPECT_EQ(why_uncertain(touching(2000.0, bad.begins, bad.ends), -1.0), on_axis) << bad.name;
  }
  EXPECT_EQ(why_uncertain(touching(2000.0, e<0.0, d> 0.06), -1.0, {0.05, 0.03}), on_axis)
      << "a distance says nothing of rest lengths that differ";
  const auto begins_far_in = touching(2000.0, either(e<0.0, e> 0.5), both(e >= 0.0, e < 0.45));
  EXPECT_EQ(why_uncertain(begins_far_in, -1.0), "");
  EXPECT_EQ(why_uncertain(begins_far_in, -1.0, {0.05}, {0.4, 1.0}), on_axis) << "of the wider tube";
  StateMachine moves = touching(2000.0, e < 0.0, e >= 0.0);
  moves.exits[1].rest = RestRule::kHere;
  EXPECT_NE(why_uncertain(moves, -1.0), "");
  StateMachine from_a_third = touching(2000.0, e < 0.0, e >= 0.0);
  from_a_third.states.push_back(from_a_third.states[0]);
  from_a_third.states[2].first_exit = from_a_third.states[2].last_exit = 2;
  EXPECT_EQ(why_uncertain(from_a_third, -1.0), "");
  from_a_third.exits.push_back(from_a_third.exits[0]);
  from_a_third.exits[2].when = (q(Quantity::kAge) > 1.0).program;
  from_a_third.states[2].last_exit = 3;
  EXPECT_EQ(why_uncertain(from_a_third, -1.0), on_axis) << "entered on the axis by a third state";
}

/// What pulls on the way in has the stiffness of what pushes there, and the step that a floor has.
TEST(HollowBound, OfAContactOfTwoStatesIsThatOfAFloorAndHoldsItsEnergy) {
  constexpr double kStiffness = 2000.0;
  const Term e = q(Quantity::kElongation);
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Chance chance(seed);
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = 1e-4;
    const double angle = chance(0.0, 6.28);
    scene.mats = {mass(0.2, chance.place(0.2, 2), Vec3(std::cos(angle), std::sin(angle), 0.0))};
    scene.radius = {0.05};
    const auto surfaces = add_hollow(scene, cylinder(Vec3::UnitZ(), 0.4), Vec3::Zero());
    touch(scene, 1, touching(kStiffness, e < 0.0, e >= 0.0), 0.05, -1.0, surfaces);
    const double limit = 2.0 * std::sqrt(0.2 / kStiffness);
    ASSERT_NEAR(plan::certified_bound(scene, plan::liaison_graph(scene)).step, limit, 1e-9);
    ASSERT_FALSE(plan::plan_of(scene, 0.1).stability.uncertainty.has_value());
    scene.step = 0.1 * limit;  // K' = 0.04: no contact gains more than 1 %
    World world = make_world(scene);
    int hits = 0;
    for (int n = 0; n < 4000; ++n) {
      world.step();
      hits += static_cast<int>(world.events().size());
      ASSERT_LT(world.position(0).norm(), 0.4) << n;
    }
    EXPECT_GT(hits, 4);
    EXPECT_LT(world.energy().kinetic, 0.1 * 1.3);
  }
}

TEST(HollowBound, TellsOfABallThatComesThroughTheWallAsOfAPlane) {
  const auto is_uncertain = [](const Surface& body, double speed) {
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = 1e-4;
    scene.mats = {mass(0.01, Vec3::Zero(), Vec3(0.0, -speed, 0.0))};
    scene.radius = {0.01};
    touch(scene, 1, contact(400.0), 0.01, -1.0, add_hollow(scene, body, Vec3::Zero()));
    return plan::plan_of(scene, 10.0).stability.uncertainty.has_value();
  };
  // K r^2 / 2 is 20 mJ, and the ball has 5 at 1 m/s.
  for (const Surface& body : {kRoom, kTube}) {
    EXPECT_FALSE(is_uncertain(body, 1.0));
    EXPECT_TRUE(is_uncertain(body, 2.1));
  }
}

/// A spring to the middle at the place of the start: what it brings farther out is not known.
TEST(HollowBound, IsNotCertainBesideAForceByPlace) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {mass(0.01, Vec3::Zero(), Vec3(0.0, -1.0, 0.0))};
  scene.radius = {0.01};
  touch(scene, 1, contact(400.0), 0.01, -1.0, add_hollow(scene, kRoom, Vec3::Zero()));
  engine::TimeFunction well;
  well.formula[0] = (Term(-0.1) * q(engine::kPlaceInForce[0])).program;
  scene.time_functions = {well};
  scene.drives = {{0, 0, true}};
  const plan::Stability stability = plan::plan_of(scene, 10.0).stability;
  ASSERT_TRUE(stability.uncertainty.has_value());
  EXPECT_EQ(stability.uncertainty->liaison.kind, engine::LiaisonKind::kForce);
}

/// @return how far the world is from the reference after this time [m]
double away_from_reference(const NetworkDescription& scene, int steps) {
  World world = make_world(scene);
  run(world, steps);
  plan::ReferenceIntegrator reference(scene, 1e-9);
  reference.advance_to(steps * scene.step);
  return (reference.position(0) - world.position(0)).norm();
}

NetworkDescription thrown_ball(const Vec3& place, const Vec3& velocity) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-5;
  scene.gravity = Vec3(0.0, -9.81, 0.0);
  scene.mats = {mass(0.2, place, velocity)};
  scene.radius = {0.05};
  return scene;
}

TEST(HollowBound, LetsTheReferenceIntegratorFollowABallInsideAndOutside) {
  for (const Surface& body : {kRoom, kTube}) {
    for (const bool is_inside : {true, false}) {
      NetworkDescription scene = is_inside ? thrown_ball(Vec3(0.1, 0.0, 0.0), Vec3(0.4, 0.2, 0.0))
                                           : thrown_ball(Vec3(0.1, 0.5, 0.0), Vec3(0.3, 0.0, 0.0));
      const auto surfaces = add_hollow(scene, body, Vec3::Zero());
      touch(scene, 1, contact(20'000.0), 0.05, -1.0, surfaces);
      EXPECT_LT(away_from_reference(scene, 60'000), 1e-3) << is_inside;
    }
  }
}

/// It rolls over a corner, where one line pushes.
TEST(HollowBound, LetsTheReferenceIntegratorFollowABallOverAPolyline) {
  NetworkDescription scene = thrown_ball(Vec3(-0.3, 0.06, 0.0), Vec3(0.8, 0.0, 0.0));
  const auto lines = add_polyline(scene, {Vec3(-1, 0, 0), Vec3(0, 0, 0), Vec3(1, -0.4, 0)});
  touch(scene, 1, contact(1000.0), 0.05, -1.0, lines);
  EXPECT_LT(away_from_reference(scene, 60'000), 1e-3);
}

/// A ball of 1 g and 10 mm radius that flies at a thin wall.
NetworkDescription ball_at_thin_wall(double stiffness, double speed, double distance,
                                     double viscosity = 0.0) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {mass(kThrownMass, Vec3(kThrownRadius + distance, 0, 0))};
  scene.mats[0].velocity = Vec3(-speed, 0, 0);
  const std::uint32_t wall = add_surface(scene, plane(Vec3::UnitX(), true), Vec3::Zero());
  StateMachine contact = state_machine(stiffness);
  contact.states[0].pulls = false;
  contact.states[0].viscosity = viscosity;
  touch(scene, 1, std::move(contact), kThrownRadius, kThrownRadius, {wall});
  return scene;
}

TEST(HollowBound, LetsNoBallThroughAThinWallThatIsCertifiedToHoldIt) {
  Chance draw(7);
  const auto holds = [](double stiffness, double speed) {
    const NetworkDescription scene =
        ball_at_thin_wall(stiffness, speed, 0.001, /*viscosity=*/1e-4 * stiffness);
    return plan::stability_of(scene, plan::liaison_graph(scene)).holds();
  };
  for (int n = 0; n < rounds(100); ++n) {
    const double number = draw(0.02, 0.98);  // K'
    const double stiffness = number * kThrownMass * 1e6;
    const double fastest = kThrownRadius * std::sqrt(stiffness / kThrownMass);
    double low = 0.0;
    double high = 1.1 * fastest;
    for (int halving = 0; halving < 30; ++halving) {
      const double middle = 0.5 * (low + high);
      (holds(stiffness, middle) ? low : high) = middle;
    }
    const double share = low * low / (fastest * fastest);  // of the energy that the wall takes
    EXPECT_GT(share, 0.95 * (1.0 - 0.25 * number)) << number;
    const double speed = std::sqrt(0.98) * low;
    for (int phase = 0; phase < 40; ++phase) {
      World world = make_world(ball_at_thin_wall(stiffness, speed, draw(0.0, 1e-3 * speed)));
      run(world, 40);
      ASSERT_GT(world.position(0).x(), 0.0) << number << ' ' << share;
    }
  }
}

}  // namespace
}  // namespace cordis::test
