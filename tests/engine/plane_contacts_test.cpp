// tests/engine/plane_contacts_test.cpp -- balls on planes, which take one pass.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/surfaces.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::IntegratorKind;

/// A plane that moves for a while, stands, and moves again.
void move_at_times(NetworkDescription& scene, std::uint32_t plane, const Vec3& way) {
  engine::TimeFunction function;
  function.time = {0.0, 0.02, 0.05, 0.09, 0.13};
  function.value = {Vec3::Zero(), Vec3::Zero(), way, way, Vec3(0.5 * way)};
  drive_mat(scene, plane, function);
}

LinkState random_contact(Chance& chance) {
  LinkState state = contact(chance(100.0, 900.0), chance(0.0, 1.0) < 0.4 ? 0.0 : chance(0.0, 1.0));
  state.pulls = chance(0.0, 1.0) < 0.3;
  state.pushes = state.pulls && chance(0.0, 1.0) < 0.3 ? false : true;
  if (chance(0.0, 1.0) < 0.3) state.force_limit = chance(0.5, 5.0);
  return state;
}

/// Half of the scenes in 2-D and 3-D have friction.
Friction random_friction(int dimension, Chance& chance) {
  if (chance(0.0, 1.0) < 0.5 || dimension == 1) return {};
  const double kinetic = chance(0.0, 0.6);
  return {kinetic + chance(0.0, 0.3), kinetic, chance(50.0, 500.0), chance(0.0, 0.5)};
}

/// Balls fly among planes, come near them and leave. Members of the set are some of the MATs in any order.
NetworkDescription random_scene(unsigned seed) {
  Chance chance(seed);
  const int dimension = 1 + static_cast<int>(seed / 4 % 3);
  const auto balls = static_cast<std::uint32_t>(chance(1.0, 75.0));
  NetworkDescription scene = cloud(balls, 1.2, 3.0, dimension, seed);
  if (dimension > 1) scene.gravity = Vec3(0.0, -9.81, 0.0);
  const IntegratorKind kinds[] = {IntegratorKind::kCordis, IntegratorKind::kLeapfrog,
                                  IntegratorKind::kImplicit};
  scene.integrator = kinds[seed / 5 % 3];
  const bool is_floor_alone = seed % 4 == 0;
  std::vector<std::uint32_t> planes;
  const int plane_count = is_floor_alone ? 1 : 1 + static_cast<int>(chance(0.0, 12.0));
  for (int i = 0; i < plane_count; ++i) {
    const Vec3 normal = chance.place(1.0, dimension).normalized();
    const Vec3 up = dimension == 1 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY());
    const bool has_radius = chance(0.0, 1.0) < 0.5;
    const Vec3 centre = is_floor_alone ? Vec3(-0.5 * up) : Vec3(chance(-0.7, -0.4) * normal);
    planes.push_back(add_surface(scene, plane(is_floor_alone ? up : normal), centre));
    if (has_radius) scene.radius.back() = chance(0.0, 0.02);
  }
  const bool is_all = seed % 5 != 0;
  for (std::uint32_t i = 0; i < balls; ++i) {
    if (chance(0.0, 1.0) < 0.1) scene.mats[i].kind = MatKind::kFixed;
    if (scene.mats[i].kind == MatKind::kFixed) scene.mats[i].velocity = Vec3::Zero();
  }
  const double rest_length = chance(0.0, 1.0) < 0.5 ? -1.0 : chance(0.0, 0.06);
  StateMachine liaison = of_one_state(random_contact(chance));
  liaison.friction = random_friction(dimension, chance);
  if (liaison.friction.acts())
    scene.integrator = IntegratorKind::kCordis;  // the only one that takes it
  touch(scene, balls, liaison, chance(0.03, 0.1), rest_length, planes);
  std::vector<std::uint32_t>& members = scene.sets[0].set_q;
  if (!is_all) {
    std::shuffle(members.begin(), members.end(), chance.random);
    members.resize((members.size() + 1) / 2);
  }
  if (seed % 7 == 0) move_at_times(scene, planes.back(), chance.place(0.2, dimension));
  return scene;
}

/// A contact whose force is asked for is not computed in one pass.
NetworkDescription by_any_surface(NetworkDescription scene) {
  scene.groups = {{false, {}, scene.sets[0].set_q}, {false, {}, scene.sets[0].set_p}};
  scene.contacts = {{0, 1}};
  return scene;
}

void expect_same(const World& world, const World& expected, const std::string& name) {
  const auto mats = static_cast<std::uint32_t>(world.network().mat_count());
  for (std::uint32_t i = 0; i < mats; ++i) {
    ASSERT_EQ(world.position(i), expected.position(i)) << name << ", MAT " << i;
    ASSERT_EQ(world.link_force(i), expected.link_force(i)) << name << ", MAT " << i;
  }
  const Energy energy = world.energy();
  const Energy other = expected.energy();
  ASSERT_EQ(energy.total(), other.total()) << name;
  ASSERT_EQ(energy.elastic, other.elastic) << name;
  ASSERT_EQ(energy.elastic_error, other.elastic_error) << name;
  ASSERT_EQ(energy.dissipated, other.dissipated) << name;
  ASSERT_EQ(world.largest_partners(0).of_q, expected.largest_partners(0).of_q) << name;
}

/// Springs of friction: which contacts have them, which slide, and how long they are. @return how many slide
std::size_t expect_same_stretches(const World& world, const World& expected,
                                  const std::string& name) {
  const std::vector<engine::StartStretch> found = world.contact_stretches(0);
  const std::vector<engine::StartStretch> other = expected.contact_stretches(0);
  EXPECT_EQ(found.size(), other.size()) << name;
  std::size_t slide = 0;
  for (std::size_t i = 0; i < std::min(found.size(), other.size()); ++i) {
    EXPECT_EQ(found[i].member_a, other[i].member_a) << name;
    EXPECT_EQ(found[i].member_b, other[i].member_b) << name;
    EXPECT_EQ(found[i].slides, other[i].slides) << name;
    EXPECT_EQ(found[i].stretch, other[i].stretch) << name;
    slide += found[i].slides;
  }
  return slide;
}

TEST(PlaneContacts, HaveTheBitsOfTheStepsForAnySurface) {
  double largest = 0.0;
  std::size_t stick = 0;
  std::size_t slide = 0;
  for (unsigned seed = 1; seed <= 126; seed += kSeedStride) {
    const NetworkDescription scene = random_scene(seed);
    World expected = make_world(by_any_surface(scene), VectorWidth::kSse2);
    std::vector<World> worlds;
    for (const VectorWidth width : engine::supported_vector_widths())
      worlds.push_back(make_world(scene, width));
    for (int n = 0; n < 200; ++n) {
      expected.step();
      for (std::size_t w = 0; w < worlds.size(); ++w) {
        worlds[w].step();
        const std::string name = "seed " + std::to_string(seed) + ", step " + std::to_string(n) +
                                 ", width " + std::to_string(w);
        ASSERT_NO_FATAL_FAILURE(expect_same(worlds[w], expected, name));
        if (n % 10 != 0) continue;
        const std::size_t sliding = expect_same_stretches(worlds[w], expected, name);
        ASSERT_FALSE(HasFailure());
        slide += sliding;
        stick += expected.contact_stretches(0).size() - sliding;
      }
      for (const std::uint32_t plane : scene.sets[0].set_p)
        largest = std::max(largest, expected.link_force(plane).norm());
    }
  }
  EXPECT_GT(largest, 1.0);
  EXPECT_GT(stick, 20u);
  EXPECT_GT(slide, 20u);
}

TEST(PlaneContacts, GoOnWithTheSameBitsAfterASnapshot) {
  for (unsigned seed = 1; seed <= 126; seed += kSeedStride) {
    World world = make_world(random_scene(seed));
    run(world, 77);
    const engine::Snapshot snapshot = world.snapshot();
    run(world, 123);
    World later = make_world(random_scene(seed));
    later.restore(snapshot);
    run(later, 123);
    EXPECT_EQ(later.state_hash(), world.state_hash()) << seed;
    ASSERT_NO_FATAL_FAILURE(expect_same(later, world, "seed " + std::to_string(seed)));
  }
}

/// Between the two, a law that bends takes the steps for any surface.
TEST(PlaneContacts, GoOnAfterAnotherLiaisonTookTheirPlace) {
  for (unsigned seed = 2; seed <= 60; seed += kSeedStride) {
    NetworkDescription scene = random_scene(seed);
    World expected = make_world(by_any_surface(scene));
    World world = make_world(scene);
    const StateMachine linear = scene.state_machines[0];
    StateMachine bent = linear;
    bent.states[0].elasticity = engine::Power{300.0, 2.0};
    for (int n = 0; n < 200; ++n) {
      if (n % 40 == 20) {
        world.replace_state_machine(0, n % 80 == 20 ? bent : linear);
        expected.replace_state_machine(0, n % 80 == 20 ? bent : linear);
      }
      world.step();
      expected.step();
      const std::string name = "seed " + std::to_string(seed) + ", step " + std::to_string(n);
      ASSERT_NO_FATAL_FAILURE(expect_same(world, expected, name));
    }
  }
}

/// The last batch is filled up by 0 to 7 balls; the first one begins with planes.
TEST(PlaneContacts, OfEveryNumberOfBallsAndPlanesAreTheSame) {
  for (std::uint32_t balls = 1; balls <= 40; ++balls) {
    for (const int plane_count : {1, 2, 9, 64, 65}) {
      NetworkDescription scene = cloud(balls, 0.5, 0.5, 2, balls);
      std::vector<std::uint32_t> planes;
      for (int i = 0; i < plane_count; ++i)
        planes.push_back(add_surface(scene, plane(Vec3::UnitY()), Vec3(0.0, -0.01 * i, 0.0)));
      touch(scene, balls, of_one_state(contact(50.0, 0.1)), 0.05, -1.0, planes);
      World expected = make_world(by_any_surface(scene));
      World world = make_world(scene);
      run(expected, 30);
      run(world, 30);
      const std::string name = std::to_string(balls) + " balls on " + std::to_string(plane_count);
      ASSERT_NO_FATAL_FAILURE(expect_same(world, expected, name));
    }
  }
}

TEST(PlaneContacts, BeginWithTheStretchesOfTheirStart) {
  for (unsigned seed = 6; seed <= 60; seed += 3) {
    const NetworkDescription scene = random_scene(seed);
    if (!scene.drives.empty()) continue;  // it starts where its function begins
    World world = make_world(scene);
    run(world, 100);
    NetworkDescription later = scene;
    later.sets[0].stretches = world.contact_stretches(0);
    for (std::uint32_t i = 0; i < later.mats.size(); ++i)
      later.mats[i].position = world.position(i);
    World from_there = make_world(later);
    World expected = make_world(by_any_surface(later));
    for (int n = 0; n < 20; ++n) {
      from_there.step();
      expected.step();
      const std::string name = "seed " + std::to_string(seed) + ", step " + std::to_string(n);
      ASSERT_NO_FATAL_FAILURE(expect_same(from_there, expected, name));
      expect_same_stretches(from_there, expected, name);
      ASSERT_FALSE(HasFailure());
    }
  }
}

TEST(PlaneContacts, StepWithoutAllocating) {
  for (unsigned seed = 10; seed < 26; ++seed) {  // with friction and without
    World world = make_world(random_scene(seed));
    run(world, 3);
    const AllocationGuard guard;
    run(world, 200);
    EXPECT_EQ(guard.count(), 0u) << seed;
  }
}

}  // namespace
}  // namespace cordis::test
