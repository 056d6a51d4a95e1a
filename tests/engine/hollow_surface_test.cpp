// tests/engine/hollow_surface_test.cpp -- balls in and around hollow boxes and cylinders.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/surfaces.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::distance_from;
using engine::hollow_surfaces;
using engine::IntegratorKind;
using engine::SurfaceDistance;

constexpr double kHollowBall = 0.05;  // radius [m]

/// A hollow box or cylinder of 1, 2 or 3 dimensions; a third of them have no end along an axis.
Surface any_body(Chance& chance, int dimension) {
  const bool is_endless = chance.random() % 3 == 0;
  if (dimension > 1 && chance.random() % 2 == 0) {
    if (dimension == 2) return cylinder(Vec3::UnitZ(), chance(0.2, 0.5));
    return cylinder(chance.place(1.0).normalized(), chance(0.2, 0.5),
                    is_endless ? kNoEnd : chance(0.2, 0.5));
  }
  Vec3 half = Vec3::Constant(kNoEnd);
  for (int axis = 0; axis < dimension; ++axis) half[axis] = chance(0.2, 0.5);
  if (is_endless && dimension > 1) half[1] = kNoEnd;
  return box(half);
}

TEST(HollowSurface, HasAFaceForEachEndOfItsBody) {
  const auto kinds = [](const Surface& body) {
    std::vector<SurfaceKind> list;
    for (const Surface& surface : hollow_surfaces(body)) list.push_back(surface.kind);
    return list;
  };
  using enum SurfaceKind;
  const std::vector<SurfaceKind> room = {kBox,     kBoxFace, kBoxFace, kBoxFace,
                                         kBoxFace, kBoxFace, kBoxFace};
  EXPECT_EQ(kinds(box(Vec3::Constant(1.0))), room);
  EXPECT_EQ(kinds(box(Vec3(1.0, kNoEnd, kNoEnd))), (std::vector{kBox, kBoxFace, kBoxFace}));
  EXPECT_EQ(kinds(cylinder(Vec3::UnitZ(), 1.0)), (std::vector{kCylinder, kCylinderWall}));
  EXPECT_EQ(kinds(cylinder(Vec3::UnitX(), 1.0, 2.0)),
            (std::vector{kCylinder, kCylinderWall, kCylinderEnd, kCylinderEnd}));
}

/// What is not inside meets the body as if it were solid. Inside each face acts, and the nearest of them is as far
/// as the solid is deep.
TEST(HollowSurface, ActsOutsideAsTheSolidBodyAndInsideWithEachFace) {
  for (unsigned seed = 1; seed <= 3000; ++seed) {
    Chance chance(seed);
    const int dimension = 1 + static_cast<int>(seed % 3);
    const Surface body = any_body(chance, dimension);
    const Vec3 centre = chance.place(0.3, dimension);
    const Vec3 place = centre + chance.place(0.8, dimension);
    const SurfaceDistance solid = distance_from(body, centre, place);

    double nearest = kNoEnd;
    for (const Surface& surface : hollow_surfaces(body)) {
      const SurfaceDistance here = distance_from(surface, centre, place);
      const bool is_outside = surface.kind == body.kind;
      ASSERT_EQ(here.is_beyond, is_outside == (solid.distance < 0.0)) << seed;
      ASSERT_GE(here.distance, 0.0) << seed;
      ASSERT_NEAR(here.normal.norm(), 1.0, 1e-12) << seed;
      if (!is_outside) nearest = std::min(nearest, here.distance);
      if (is_outside && solid.distance > 0.0) {
        EXPECT_EQ(here.distance, solid.distance);
        EXPECT_EQ(here.normal, solid.normal);
      }
      // The normal points away from the surface to the place, whose nearest point is on the surface.
      const Vec3 foot = place - here.distance * here.normal;
      ASSERT_NEAR(distance_from(surface, centre, foot).distance, 0.0, 1e-12) << seed;
      const Vec3 far = centre + chance.place(0.8, dimension);
      const double other = distance_from(surface, centre, far).distance;
      ASSERT_LE(std::abs(other - here.distance), (far - place).norm() + 1e-12) << seed;
    }
    if (solid.distance < 0.0) {
      ASSERT_NEAR(nearest, -solid.distance, 1e-12) << seed;
    }
  }
}

TEST(HollowSurface, HasNoDirectionOnItsWallsAndOnTheAxisOfACylinder) {
  const Vec3 aside(0.3, 0.0, 0.0);
  for (const Surface& body : {box(Vec3(0.3, 0.4, kNoEnd)), cylinder(Vec3::UnitZ(), 0.3)}) {
    for (const Surface& surface : hollow_surfaces(body)) {
      const SurfaceDistance here = distance_from(surface, Vec3::Zero(), aside);
      if (here.distance > 0.0) continue;
      EXPECT_EQ(here.normal, Vec3(Vec3::Zero()));
      EXPECT_FALSE(here.is_beyond);
    }
  }
  const Surface wall = hollow_surfaces(cylinder(Vec3::UnitZ(), 0.3))[1];
  const SurfaceDistance middle = distance_from(wall, aside, aside);
  EXPECT_EQ(middle.distance, 0.3);
  EXPECT_EQ(middle.normal, Vec3(Vec3::Zero()));
}

/// A ball of 0.2 kg that touches a hollow body at the origin, without friction and viscosity.
NetworkDescription ball_at_hollow(const Surface& body, int dimension, const Vec3& place,
                                  const Vec3& velocity, double stiffness, double step = 1e-5) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = step;
  scene.mats = {mass(0.2, place, velocity)};
  scene.radius = {kHollowBall};
  const std::vector<std::uint32_t> surfaces = add_hollow(scene, body, Vec3::Zero());
  touch(scene, 1, of_one_state(contact(stiffness, 0.0)), kHollowBall, -1.0, surfaces);
  return scene;
}

/// Between two walls a ball flies free and then swings half a period in the wall. The axes do not see each other.
TEST(HollowContact, InABoxIsAsBetweenTwoWallsAlongEachAxis) {
  constexpr double kStiffness = 2000.0;
  const Vec3 half(0.3, 0.2, 0.25);
  const Vec3 speed(0.7, -0.45, 0.31);
  World world = make_world(ball_at_hollow(box(half), 3, Vec3::Zero(), speed, kStiffness));
  const double w = std::sqrt(kStiffness / 0.2);
  const auto position_of = [&](int axis, double time) {
    const double free = half[axis] - kHollowBall;
    const double fast = std::abs(speed[axis]);
    const double in_wall = std::numbers::pi / w;
    const double across = 2.0 * free / fast;
    double left = time + 0.5 * across;  // since it left the lower wall
    double side = speed[axis] < 0.0 ? -1.0 : 1.0;
    for (; left > across + in_wall; left -= across + in_wall) side = -side;
    if (left < across) return side * (fast * left - free);
    return side * (free + fast / w * std::sin(w * (left - across)));
  };
  double largest = 0.0;
  for (int n = 1; n <= 300'000; ++n) {
    world.step();
    for (int axis = 0; axis < 3; ++axis) {
      largest = std::max(largest, std::abs(world.position(0)[axis] - position_of(axis, n * 1e-5)));
    }
  }
  // Where in a step it touches is not resolved: each of 10 bounces is late by less than a step.
  EXPECT_LT(largest, 10.0 * 1e-5 * 0.7);
}

/// A pendulum of the length of the way of its centre: R - r, and what the weight presses.
TEST(HollowContact, InACylinderSwingsAsAPendulum) {
  constexpr double kRadius = 0.4;
  constexpr double kStiffness = 20'000.0;
  constexpr double kGravity = 9.81;
  const double length = kRadius - kHollowBall + 0.2 * kGravity / kStiffness;
  constexpr double kSmall = 1e-3;  // [rad]: the period is longer by a^2 / 16
  for (const IntegratorKind kind : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    for (const int dimension : {2, 3}) {
      const double half_length = dimension == 2 ? kNoEnd : 0.5;
      NetworkDescription scene = ball_at_hollow(
          cylinder(Vec3::UnitZ(), kRadius, half_length), dimension,
          length * Vec3(std::sin(kSmall), -std::cos(kSmall), 0.0), Vec3::Zero(), kStiffness, 1e-4);
      scene.gravity = Vec3(0.0, -kGravity, 0.0);
      scene.integrator = kind;
      World world = make_world(scene);
      std::vector<double> crossings;
      double before = world.position(0).x();
      for (int n = 1; n <= 200'000; ++n) {
        world.step();
        const double x = world.position(0).x();
        if (before > 0.0 && x <= 0.0) crossings.push_back((n - x / (x - before)) * 1e-4);
        before = x;
      }
      ASSERT_GT(crossings.size(), 10u);
      const double period =
          (crossings.back() - crossings.front()) / (static_cast<double>(crossings.size()) - 1.0);
      const double expected = 2.0 * std::numbers::pi * std::sqrt(length / kGravity);
      EXPECT_NEAR(period / expected, 1.0, 1e-6) << to_string(kind) << dimension;
      EXPECT_EQ(world.position(0).z(), 0.0);
    }
  }
}

TEST(HollowContact, OutsideIsThatOfTheSolidBodyBitForBit) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Chance chance(seed);
    const int dimension = 2 + static_cast<int>(seed % 2);
    const Surface body = any_body(chance, dimension);
    NetworkDescription solid = cloud(20, 1.6, 2.0, dimension, seed);
    // What begins inside is put far away.
    for (engine::Mat& mat : solid.mats) {
      const bool is_near = distance_from(body, Vec3::Zero(), mat.position).distance < kHollowBall;
      if (is_near) mat.position += Vec3(9.0, 9.0, 0.0);
    }
    solid.step = 2e-4;
    NetworkDescription hollow = solid;
    const LinkState state = contact(20'000.0, 0.3);  // none comes through it
    touch(solid, 20, of_one_state(state), kHollowBall, -1.0,
          {add_surface(solid, body, Vec3::Zero())});
    const std::vector<std::uint32_t> surfaces = add_hollow(hollow, body, Vec3::Zero());
    touch(hollow, 20, of_one_state(state), kHollowBall, -1.0, surfaces);
    World of_solid = make_world(solid);
    World of_hollow = make_world(hollow);
    double pushed = 0.0;
    for (int n = 0; n < 3000; ++n) {
      of_solid.step();
      of_hollow.step();
      pushed = std::max(pushed, of_solid.energy().elastic);
    }
    for (std::uint32_t i = 0; i < 20; ++i)
      ASSERT_EQ(of_hollow.position(i), of_solid.position(i)) << seed;
    EXPECT_EQ(of_hollow.link_force(20), of_solid.link_force(20)) << seed;
  }
}

/// It goes through each wall at once, and is thrown on by the other side: planes do so too.
TEST(HollowContact, LetsAFastBallThroughAsAThinPlaneDoes) {
  constexpr double kStiffness = 400.0;
  const double barrier =
      std::sqrt(kStiffness / 0.2) * kHollowBall;  // speed that just comes through
  for (const double speed : {0.9 * barrier, 1.2 * barrier}) {
    const Vec3 velocity(speed, 0.0, 0.0);
    NetworkDescription boxed =
        ball_at_hollow(box(Vec3(0.3, 0.3, kNoEnd)), 2, Vec3::Zero(), velocity, kStiffness, 1e-4);
    NetworkDescription walled = boxed;
    for (Surface& surface : walled.surfaces) surface = plane(-Vec3::UnitX(), true);
    walled.surfaces.resize(1);
    walled.mats.resize(2);
    walled.radius.resize(2);
    walled.surfaces[0].mat = 1;
    walled.mats[1].position = Vec3(0.3, 0.0, 0.0);
    walled.sets[0].set_p = {1};
    World box_world = make_world(boxed);
    World plane_world = make_world(walled);
    for (int n = 0; n < 2500; ++n) {
      box_world.step();
      plane_world.step();
      ASSERT_NEAR(box_world.position(0).x(), plane_world.position(0).x(), 1e-12) << n;
    }
    EXPECT_EQ(box_world.position(0).x() > 0.3, speed > barrier);
  }
}

TEST(HollowContact, KeepsBallsInsideAndTheirEnergy) {
  for (unsigned seed = 1; seed <= static_cast<unsigned>(rounds(12)); ++seed) {
    Chance chance(seed);
    const int dimension = 1 + static_cast<int>(seed % 3);
    const Surface body = any_body(chance, dimension);
    NetworkDescription scene;
    scene.dimension = dimension;
    scene.step = 2e-5;
    scene.integrator = seed % 2 == 0 ? IntegratorKind::kCordis : IntegratorKind::kLeapfrog;
    constexpr std::uint32_t kBalls = 12;
    for (std::uint32_t i = 0; i < kBalls; ++i) {
      scene.mats.push_back(mass(0.1, chance.place(0.04, dimension), chance.place(1.0, dimension)));
      scene.radius.push_back(kHollowBall);
    }
    const std::vector<std::uint32_t> surfaces = add_hollow(scene, body, Vec3::Zero());
    touch(scene, kBalls, of_one_state(contact(5000.0, 0.0)), kHollowBall, -1.0, surfaces);
    World world = make_world(scene);
    const double start = world.energy().total();
    for (int n = 0; n < 100'000; ++n) {
      world.step();
      if (n % 500 != 0) continue;
      for (std::uint32_t i = 0; i < kBalls; ++i) {
        ASSERT_LT(distance_from(body, Vec3::Zero(), world.position(i)).distance, 0.0) << seed;
      }
      const engine::Energy energy = world.energy();
      ASSERT_NEAR(energy.kinetic + energy.elastic - energy.elastic_error, start, 5e-3 * start)
          << seed << " at " << n;
    }
  }
}

/// Random balls in and around random hollow bodies, whose centres are within `away` of the origin.
NetworkDescription among_bodies(unsigned seed, std::uint32_t balls, int bodies, double away,
                                const LinkState& law) {
  Chance chance(seed);
  const int dimension = 1 + static_cast<int>(seed % 3);
  NetworkDescription scene = cloud(balls, 1.2, 2.0, dimension, seed);
  std::vector<std::uint32_t> surfaces;
  for (int b = 0; b < bodies; ++b) {
    for (const std::uint32_t one :
         add_hollow(scene, any_body(chance, dimension), chance.place(away, dimension)))
      surfaces.push_back(one);
  }
  touch(scene, balls, of_one_state(law), kHollowBall, -1.0, surfaces);
  return scene;
}

TEST(HollowContact, HasTheSameBitsOnEveryVectorWidthAndAfterRestore) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const NetworkDescription scene = among_bodies(seed, 60, 3, 0.4, contact(400.0, 0.2));
    std::optional<std::uint64_t> hash;
    for (const engine::VectorWidth width : engine::supported_vector_widths()) {
      World world = make_world(scene, width);
      for (int n = 0; n < 300; ++n) world.step();
      const engine::Snapshot snapshot = world.snapshot();
      for (int n = 0; n < 300; ++n) world.step();
      if (!hash) hash = world.state_hash();
      EXPECT_EQ(world.state_hash(), *hash) << to_string(width);
      world.restore(snapshot);
      for (int n = 0; n < 300; ++n) world.step();
      EXPECT_EQ(world.state_hash(), *hash) << to_string(width) << ", restored";
    }
  }
}

/// It is a plain sum over all surfaces that act at a place.
TEST(HollowContact, IsTheSumOverAllSurfacesThatAct) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const NetworkDescription scene = among_bodies(seed, 30, 2, 0.3, contact(400.0, 0.0));
    World world = make_world(scene);
    std::vector<Vec3> now;
    std::vector<Vec3> before;
    world.step();
    for (std::uint32_t i = 0; i < 30; ++i) {
      now.push_back(world.position(i));
      before.push_back(scene.mats[i].position);
    }
    double inside = 0.0;
    double outside = 0.0;
    for (int n = 0; n < 400; ++n) {
      world.step();
      for (std::uint32_t i = 0; i < 30; ++i) {
        Vec3 force = Vec3::Zero();
        for (const Surface& surface : scene.surfaces) {
          const auto [distance, normal, is_beyond] =
              distance_from(surface, scene.mats[surface.mat].position, now[i]);
          const double push = 400.0 * (scene.radius[i] - distance);
          if (is_beyond || !(distance < kHollowBall) || !(push > 0.0)) continue;
          force += push * normal;
          const bool is_body =
              surface.kind == SurfaceKind::kBox || surface.kind == SurfaceKind::kCylinder;
          (is_body ? outside : inside) += push;
        }
        const Vec3 next =
            2.0 * now[i] - before[i] + scene.step * scene.step / scene.mats[i].mass * force;
        before[i] = now[i];
        now[i] = next;
        ASSERT_LT((world.position(i) - next).norm(), 1e-9) << "seed " << seed << " step " << n;
      }
    }
    EXPECT_GT(inside, 0.0) << seed;
    EXPECT_GT(outside, 0.0) << seed;
  }
}

TEST(HollowSurface, RefusesWhatIsNoFace) {
  const NetworkDescription good =
      ball_at_hollow(box(Vec3(0.3, 0.2, kNoEnd)), 2, Vec3::Zero(), Vec3::Zero(), 100.0);
  EXPECT_NO_THROW(make_world(good));
  const auto refuses = [&](const auto& spoil) {
    NetworkDescription scene = good;
    spoil(scene.surfaces[1]);
    EXPECT_THROW(make_world(scene), std::invalid_argument);
  };
  refuses([](Surface& face) { face.axis = Vec3(0.6, 0.8, 0.0); });
  refuses([](Surface& face) { face.axis = Vec3::UnitZ(); });
  refuses([](Surface& face) { face.half_size.x() = 0.0; });
  refuses([](Surface& face) { face.kind = SurfaceKind::kCylinderEnd; });
}

}  // namespace
}  // namespace cordis::test
