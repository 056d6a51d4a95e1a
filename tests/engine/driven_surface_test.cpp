// tests/engine/driven_surface_test.cpp -- balls on surfaces that follow a function of time.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/rubbing.h"
#include "tests/engine/surfaces.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;
using engine::Quantity;

constexpr std::uint32_t kSwarm = 37;

Term time_now() {
  return q(Quantity::kAge);
}

/// Moves surfaces by a formula of time along each axis.
void drive(NetworkDescription& scene, const std::vector<std::uint32_t>& surfaces,
           const std::array<Term, 3>& way) {
  engine::TimeFunction function;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene.dimension); ++axis)
    function.formula[axis] = way[axis].program;
  const auto number = static_cast<std::uint32_t>(scene.time_functions.size());
  scene.time_functions.push_back(function);
  for (const std::uint32_t mat : surfaces) {
    scene.mats[mat].kind = MatKind::kPort;
    scene.drives.push_back({mat, number, false, scene.mats[mat].position});
  }
}

void drive_evenly(NetworkDescription& scene, const std::vector<std::uint32_t>& surfaces,
                  const Vec3& velocity) {
  drive(scene, surfaces,
        {Term(velocity.x()) * time_now(), Term(velocity.y()) * time_now(),
         Term(velocity.z()) * time_now()});
}

/// Shapes that a ball may touch in a space.
std::vector<std::string> shapes_in(int dimension) {
  if (dimension == 1) return {"plane", "plane of both sides", "box"};
  if (dimension == 2) return {"plane", "plane of both sides", "box", "cylinder", "polyline"};
  return {"plane", "plane of both sides", "box", "cylinder", "endless cylinder"};
}

/// Adds some surfaces of one shape.
std::vector<std::uint32_t> add_some(NetworkDescription& scene, const std::string& shape,
                                    Chance& chance) {
  const int dimension = scene.dimension;
  if (shape == "polyline") {
    return add_polyline(scene, {Vec3(-0.5, -0.4, 0), Vec3(-0.1, -0.5, 0), Vec3(0.4, -0.2, 0),
                                Vec3(0.5, 0.3, 0), Vec3(0.2, 0.5, 0)});
  }
  std::vector<std::uint32_t> numbers;
  for (int i = 0; i < 3; ++i) {
    Surface surface = plane(chance.place(1.0, dimension).normalized(), shape != "plane");
    Vec3 half = Vec3::Constant(kNoEnd);
    for (int axis = 0; axis < dimension; ++axis) half[axis] = chance(0.05, 0.3);
    if (shape == "box") surface = box(half);
    const double length = shape == "cylinder" && dimension == 3 ? chance(0.05, 0.4) : kNoEnd;
    const Vec3 axis = dimension == 2 ? Vec3(Vec3::UnitZ()) : chance.place(1.0).normalized();
    if (shape.find("cylinder") != std::string::npos)
      surface = cylinder(axis, chance(0.05, 0.3), length);
    numbers.push_back(add_surface(scene, surface, chance.place(0.5, dimension)));
  }
  return numbers;
}

/// Comes near and leaves, in two states.
StateMachine of_two_states(const engine::Friction& friction) {
  LinkState free_state;
  free_state.name = "free";
  LinkState bound = contact(300.0, 0.3);
  bound.pulls = true;
  StateMachine machine = Behaving()
                             .state(free_state)
                             .exit(q(Quantity::kElongation) < -0.005, 1, RestRule::kHere)
                             .state(bound)
                             .exit(q(Quantity::kSpeed) > 0.7, 0)
                             .exit(q(Quantity::kSpeedX) > 2.5, 0)
                             .state_machine;
  machine.friction = friction;
  return machine;
}

/// What balls and surfaces do to each other.
std::vector<std::pair<std::string, StateMachine>> liaisons() {
  const engine::Friction friction{0.6, 0.4, 200.0, 0.1};
  return {{"elastic", of_one_state(contact(400.0, 0.0))},
          {"viscous", of_one_state(contact(400.0, 0.6))},
          {"rubbing", rubbing(contact(400.0, 0.3), friction)},
          {"two states", of_two_states({})},
          {"two states that rub", of_two_states(friction)}};
}

struct TwoFrames {
  std::string name;
  NetworkDescription fixed;   // balls that move at -V
  NetworkDescription driven;  // surfaces that move at V
  Vec3 velocity;
};

/// Balls that a moving frame brings to surfaces, and what it is in that frame.
TwoFrames seen_from_two_frames(int dimension, const std::string& shape,
                               const std::pair<std::string, StateMachine>& liaison,
                               IntegratorKind integrator) {
  TwoFrames result;
  result.name = std::to_string(dimension) + "-D, " + shape + ", " + liaison.first + ", " +
                to_string(integrator);
  Chance chance(static_cast<unsigned>(7 * dimension));
  for (int axis = 0; axis < dimension; ++axis) result.velocity[axis] = axis == 1 ? 1.1 : -1.7;
  for (int axis = dimension; axis < 3; ++axis) result.velocity[axis] = 0.0;
  // Most begin out of range, and come into it by the way of the surfaces alone.
  NetworkDescription scene = cloud(kSwarm, 1.4, 0.2, dimension, 3);
  scene.integrator = integrator;
  scene.step = 5e-4;
  const std::vector<std::uint32_t> surfaces = add_some(scene, shape, chance);
  touch(scene, kSwarm, liaison.second, 0.05, -1.0, surfaces);
  result.fixed = result.driven = scene;
  for (std::uint32_t i = 0; i < kSwarm; ++i) result.fixed.mats[i].velocity -= result.velocity;
  drive_evenly(result.driven, surfaces, result.velocity);
  return result;
}

/// Each shape with each liaison.
template <class Check>
void for_each_contact(Check check) {
  for (const int dimension : {1, 2, 3}) {
    for (const std::string& shape : shapes_in(dimension)) {
      for (const auto& liaison : liaisons()) {
        // On a line nothing slides.
        if (dimension > 1 || !liaison.second.friction.acts()) check(dimension, shape, liaison);
      }
    }
  }
}

template <class Check>
void for_each_case(Check check) {
  for_each_contact([&](int dimension, const std::string& shape, const auto& liaison) {
    for (const IntegratorKind kind :
         {IntegratorKind::kCordis, IntegratorKind::kLeapfrog, IntegratorKind::kImplicit}) {
      if (kind != IntegratorKind::kCordis && liaison.second.friction.acts()) continue;
      check(seen_from_two_frames(dimension, shape, liaison, kind));
    }
  });
}

TEST(DrivenSurface, ThatMovesEvenlyPushesAsAFixedOneInItsFrame) {
  for_each_case([](const TwoFrames& seen) {
    World fixed = make_world(seen.fixed);
    World driven = make_world(seen.driven);
    double pushed = 0.0;
    for (int n = 1; n <= rounds(1000); ++n) {
      fixed.step();
      driven.step();
      const Vec3 way = n * seen.driven.step * seen.velocity;
      for (std::uint32_t i = 0; i < kSwarm; ++i) {
        ASSERT_LT((driven.position(i) - way - fixed.position(i)).norm(), 1e-9)
            << seen.name << ", step " << n << ", ball " << i;
      }
      for (const Surface& surface : seen.driven.surfaces) {
        const Vec3 force = driven.link_force(surface.mat);
        ASSERT_LT((force - fixed.link_force(surface.mat)).norm(), 1e-6) << seen.name << ' ' << n;
        pushed = std::max(pushed, force.norm());
      }
    }
    EXPECT_GT(pushed, 0.0) << seen.name;
    EXPECT_NEAR(driven.energy().dissipated, fixed.energy().dissipated, 1e-9) << seen.name;
    EXPECT_NEAR(driven.energy().elastic, fixed.energy().elastic, 1e-9) << seen.name;
  });
}

TEST(DrivenSurface, BringsTheWorkThatItsDriveDoes) {
  for_each_contact([](int dimension, const std::string& shape, const auto& liaison) {
    const TwoFrames seen = seen_from_two_frames(dimension, shape, liaison, IntegratorKind::kCordis);
    World world = make_world(seen.driven);
    double work = 0.0;
    for (int n = 0; n < 1000; ++n) {
      world.step();
      for (const Surface& surface : seen.driven.surfaces)
        work -= seen.driven.step * world.link_force(surface.mat).dot(seen.velocity);
    }
    const engine::Energy energy = world.energy();
    EXPECT_LT(std::abs(energy.residual()), 1e-13 * energy.largest) << seen.name;
    EXPECT_GT(std::abs(energy.port_work), 1e-3) << seen.name;
    EXPECT_NEAR(energy.port_work, work, 0.01 * std::abs(work)) << seen.name;
  });
}

/// Shaken along two axes by as much as the range, and carried off.
TwoFrames shaken(int dimension, const std::string& shape,
                 const std::pair<std::string, StateMachine>& liaison) {
  TwoFrames result = seen_from_two_frames(dimension, shape, liaison, IntegratorKind::kCordis);
  std::vector<std::uint32_t> surfaces = result.fixed.sets[0].set_p;
  result.driven = result.fixed;
  const Term swing = Term(0.05) * one(engine::Operation::kSin, Term(90.0) * time_now());
  drive(result.driven, surfaces,
        {swing - Term(0.4) * time_now(),
         dimension > 1 ? Term(-0.5) * swing : Term(0.0) * time_now(), Term(0.0) * time_now()});
  return result;
}

TEST(DrivenSurface, HasTheSameBitsOnEveryVectorWidthAndAfterRestore) {
  for_each_contact([](int dimension, const std::string& shape, const auto& liaison) {
    const TwoFrames seen = shaken(dimension, shape, liaison);
    std::optional<std::uint64_t> hash;
    for (const engine::VectorWidth width : engine::supported_vector_widths()) {
      World world = make_world(seen.driven, width);
      run(world, rounds(400));
      const engine::Snapshot snapshot = world.snapshot();
      const double total = world.energy().total();
      run(world, rounds(500));
      if (!hash) hash = world.state_hash();
      EXPECT_EQ(world.state_hash(), *hash) << seen.name << to_string(width);
      World elsewhere = make_world(seen.driven, width);
      for (World* other : {&world, &elsewhere}) {
        other->restore(snapshot);
        EXPECT_EQ(other->energy().total(), total) << seen.name << to_string(width);
        run(*other, rounds(500));
        EXPECT_EQ(other->state_hash(), *hash) << seen.name << to_string(width);
      }
    }
  });
}

TEST(DrivenSurface, ThatComesFasterAndFasterPressesWithMassTimesAcceleration) {
  constexpr double kStiffness = 4000.0;
  constexpr double kAcceleration = 3.0;
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {mass(0.2, Vec3(0.0, 0.05, 0.0))};
  scene.radius = {0.05};
  const std::uint32_t piston = add_surface(scene, plane(Vec3::UnitY()), Vec3(4.0, 0.0, 0.0));
  touch(scene, 1, of_one_state(contact(kStiffness, 40.0)), 0.05, -1.0, {piston});
  drive(scene, {piston},
        {Term(0.0) * time_now(), Term(0.5 * kAcceleration) * time_now() * time_now(),
         Term(0.0) * time_now()});
  World world = make_world(scene);
  for (int n = 0; n < 20'000; ++n) {
    AllocationGuard guard;
    world.step();
  }
  const double height = world.position(0).y() - world.position(piston).y();
  EXPECT_NEAR(0.05 - height, 0.2 * kAcceleration / kStiffness, 1e-10);
  EXPECT_NEAR(world.link_force(piston).y(), -0.2 * kAcceleration, 1e-6);
  EXPECT_EQ(world.link_force(piston).x(), 0.0);
}

/// The way of the surfaces is counted however long they move, and however little in a step.
TEST(DrivenSurface, ReachesBallsAfterAnyWay) {
  for (const double per_step : {1e-9, 1e-5, 3e-4, 0.02, 7.0}) {
    constexpr double kStep = 1e-3;
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = kStep;
    // The first turns of the way are spent before it comes to the ball.
    const double far = 1500.0 * per_step;
    scene.mats = {mass(1.0, Vec3(0.0, 0.05 + far, 0.0))};
    scene.radius = {0.05};
    const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
    touch(scene, 1, of_one_state(contact(100.0, 0.0)), 0.05, -1.0, {floor});
    drive_evenly(scene, {floor}, Vec3(0.0, per_step / kStep, 0.0));
    World world = make_world(scene);
    for (int n = 0; n < 1520; ++n) {
      const double depth = world.position(floor).y() + 0.05 - world.position(0).y();
      world.step();
      ASSERT_NEAR(world.link_force(0).y(), 100.0 * std::max(depth, 0.0), 1e-9 * (1.0 + far))
          << per_step << " m a step, step " << n;
    }
    EXPECT_GT(world.link_force(0).y(), 0.0) << per_step;
  }
}

/// More pairs come into range in one step than there was room for at the start.
TEST(DrivenSurface, ForgetsNoPairThatItComesTo) {
  for (const auto& liaison : liaisons()) {
    NetworkDescription scene = cloud(kSwarm, 0.02, 0.0, 2, 5);
    std::vector<std::uint32_t> surfaces;
    for (int i = 0; i < 40; ++i)
      surfaces.push_back(add_surface(scene, box(Vec3(0.2, 0.2, kNoEnd)), Vec3(-1.0, 0.0, 0.0)));
    touch(scene, kSwarm, liaison.second, 0.05, -1.0, surfaces);
    drive_evenly(scene, surfaces, Vec3(0.1 / scene.step, 0.0, 0.0));
    World world = make_world(scene);
    bool is_given_room = false;
    for (int n = 0; n < 9; ++n) {
      const engine::StepReport report = world.step();
      EXPECT_EQ(report.forgotten_pairs, 0U) << liaison.first << ", step " << n;
      is_given_room = is_given_room || report.wants_room;
      if (report.wants_room) world.make_room();
    }
    const bool remembers = liaison.second.friction.acts() || liaison.second.states.size() > 1;
    EXPECT_EQ(is_given_room, remembers) << liaison.first;
  }
}

/// Balls at rest under springs, far from a box that comes from the side.
NetworkDescription box_comes(int way_of_box) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 2e-4;
  scene.medium_viscosity = 0.5;
  scene.gravity = Vec3(0.0, -9.81, 0.0);
  for (std::uint32_t i = 0; i < kSwarm; ++i) {
    // They begin above where they rest, and fall asleep there.
    scene.mats.push_back(mass(0.05, Vec3(0.1 * i, 0.012, 0.0)));
    scene.radius.push_back(0.03);
  }
  for (std::uint32_t i = 0; i < kSwarm; ++i) {
    scene.mats.push_back(fixed(Vec3(0.1 * i, 0.3, 0.0)));
    scene.radius.push_back(0.0);
    scene.links.push_back({i, kSwarm + i, 400.0, 0.5, 0.3});
  }
  const std::uint32_t ram = add_surface(scene, box(Vec3(0.2, 0.05, kNoEnd)), Vec3(-1.0, 0.0, 0.0));
  const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3(0.0, -0.5, 0.0));
  touch(scene, kSwarm, of_one_state(contact(500.0, 0.5)), 0.03, -1.0, {ram, floor});
  drive(
      scene, {ram},
      {Term(way_of_box) * Term(0.25) * time_now(), Term(0.0) * time_now(), Term(0.0) * time_now()});
  return scene;
}

TEST(DrivenSurface, WakesWhatItComesTo) {
  NetworkDescription scene = box_comes(1);
  World whole = make_world(scene);
  scene.freeze_tolerance = 1e-6;
  World part = make_world(scene);
  std::uint32_t max_asleep = 0;
  double farthest = 0.0;
  for (int n = 0; n < 30'000; ++n) {
    whole.step();
    part.step();
    max_asleep = std::max(max_asleep, part.asleep_count());
    for (std::uint32_t i = 0; i < kSwarm; ++i) {
      ASSERT_LT((whole.position(i) - part.position(i)).norm(), 2e-4) << n << ", ball " << i;
    }
    farthest = std::max(farthest, std::abs(whole.position(3).x() - 0.3));
  }
  EXPECT_EQ(max_asleep, kSwarm);
  EXPECT_GT(farthest, 0.02);
  EXPECT_LT(part.asleep_count(), kSwarm);
  EXPECT_GT(part.asleep_count(), kSwarm / 2);
}

TEST(DrivenSurface, IsRefusedWhereOnlyAForceIsDrivenOrNothing) {
  NetworkDescription scene = box_comes(1);
  EXPECT_NO_THROW(make_world(scene));
  NetworkDescription port = scene;
  port.drives.clear();
  EXPECT_THROW(make_world(port), std::invalid_argument);
  NetworkDescription pushed = scene;
  pushed.drives.back().is_force = true;
  pushed.mats[pushed.drives.back().mat].kind = MatKind::kMass;
  pushed.mats[pushed.drives.back().mat].mass = 1.0;
  EXPECT_THROW(make_world(pushed), std::invalid_argument);
}

}  // namespace
}  // namespace cordis::test
