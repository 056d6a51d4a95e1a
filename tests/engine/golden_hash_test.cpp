// tests/engine/golden_hash_test.cpp -- the same bits as ever, on every vector width and
// optimisation level.
//
// Built twice: against the engine as it is shipped, and against the same sources compiled with -O1.
#include <cstdint>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/engine/many_states.h"
#include "tests/engine/rubbing.h"
#include "tests/engine/scenes.h"
#include "tests/support/golden_hashes.h"

namespace cordis::test {
namespace {

// Scenes and their motions are made with + - * / alone: sin and cos differ from one C library to
// the next.

using engine::IntegratorKind;

/// A number in [0, 1), different for each index.
double scattered(std::uint32_t index) {
  return static_cast<double>(index * 2654435761U >> 8) / 16777216.0;
}

/// 1 dimension: 43 masses in a medium, plucked, both ends fixed; 44 links, of which 4 share the
/// last batch.
World plucked_string(VectorWidth width, IntegratorKind integrator = IntegratorKind::kCordis) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-4;
  scene.integrator = integrator;
  scene.medium_viscosity = 1e-4;
  for (std::uint32_t i = 0; i < 45; ++i) {
    const Vec3 position(i < 11 ? 0.002 * i : 0.02 * (44 - i) / 33.0, 0, 0);
    scene.mats.push_back(i == 0 || i == 44 ? fixed(Vec3::Zero()) : mass(5e-4, position));
  }
  for (std::uint32_t i = 0; i < 44; ++i) scene.links.push_back({i, i + 1, 900.0, 0.01, 0.0});
  World world = make_world(scene, width);

  run(world, 2000);
  return world;
}

/// 2 dimensions: a ring of 29 masses without viscosity, turning, pulled by a force that comes and
/// goes.
World turning_ring(VectorWidth width) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 5e-4;
  scene.gravity = Vec3(0, -9.81, 0);
  for (std::uint32_t i = 0; i < 29; ++i) {
    const double t = i / 29.0;  // a point of the unit circle, from the rational parameter 2 t - 1
    const double u = 2.0 * t - 1.0;
    const Vec3 position((1.0 - u * u) / (1.0 + u * u), 2.0 * u / (1.0 + u * u), 0);
    scene.mats.push_back(mass(0.01 + 0.01 * scattered(i), position,
                              Vec3(-2.0 * position.y(), 2.0 * position.x(), 0)));
  }
  for (std::uint32_t i = 0; i < 29; ++i) {
    scene.links.push_back({i, (i + 1) % 29, 200.0, 0.0, 0.1});
    scene.links.push_back({i, (i + 7) % 29, 50.0, 0.0, 0.4});
  }
  World world = make_world(scene, width);

  for (int n = 0; n < 2000; ++n) {
    if (n % 250 == 0) world.set_external_force(3, Vec3(n % 500 == 0 ? 2.0 : -0.5, 0.25, 0));
    world.step();
  }
  return world;
}

/// 3 dimensions: a net of 12 x 12 masses held at two corners, under gravity, pushed by a port.
World pushed_net(VectorWidth width, IntegratorKind integrator = IntegratorKind::kCordis) {
  NetworkDescription scene;
  scene.step = 1e-3;
  scene.integrator = integrator;
  scene.gravity = Vec3(0, 0, -9.81);
  scene.medium_viscosity = 1e-3;
  for (std::uint32_t i = 0; i < 144; ++i) {
    const Vec3 position(0.05 * (i % 12), 0.05 * (i / 12), 0.002 * scattered(i));
    scene.mats.push_back(i == 0 || i == 11 ? fixed(position) : mass(0.02, position));
  }
  scene.mats.push_back(port(Vec3(0.25, 0.3, 0.05)));
  for (std::uint32_t i = 0; i < 144; ++i) {
    const double stiffness = 100.0 + 50.0 * scattered(1000 + i);
    if (i % 12 < 11) scene.links.push_back({i, i + 1, stiffness, 0.05, 0.05});
    if (i < 132) scene.links.push_back({i, i + 12, stiffness, 0.05, 0.05});
    if (i % 12 < 11 && i < 132) scene.links.push_back({i, i + 13, 0.5 * stiffness, 0.02, 0.07});
  }
  scene.links.push_back({144, 77, 300.0, 0.2, 0.04});
  World world = make_world(scene, width);

  for (int n = 0; n < 2000; ++n) {
    const double phase = n % 400 / 400.0;
    world.impose_position(144, Vec3(0.25, 0.3, 0.05 - 0.2 * phase * (1.0 - phase)));
    world.step();
  }
  return world;
}

/// 3 dimensions: a net whose dampers are implicit.
World heavily_damped_net(VectorWidth width) {
  NetworkDescription scene = free_cluster(40, 157, 20.0);
  scene.integrator = IntegratorKind::kLeapfrog;
  scene.medium_viscosity = 0.01;
  World world = make_world(scene, width);
  run(world, 2000);
  return world;
}

/// 3 dimensions: links of every law, changing state under every kind of condition.
World changing_links(VectorWidth width, IntegratorKind integrator = IntegratorKind::kCordis) {
  NetworkDescription scene = network_of_many_states(3);
  scene.integrator = integrator;
  World world = make_world(scene, width);
  stir(world, 2000);
  return world;
}

/// Balls that rub, with pairs of two states, in a box whose floor is shaken, round a block and a rod.
World shaken_balls(VectorWidth width, int dimension) {
  NetworkDescription scene = rubbing_cloud(dimension, 17, /*states=*/true);
  scene.gravity = -9.81 * Vec3::UnitY();
  scene.medium_viscosity = 1e-3;
  const engine::Friction friction{0.5, 0.3, 200.0, 0.1};
  const Vec3 half_size(0.06, 0.04, dimension == 2 ? kNoEnd : 0.05);
  const std::uint32_t block = add_surface(scene, box(half_size), Vec3(0.1, -0.2, 0));
  const Vec3 axis = dimension == 2 ? Vec3(Vec3::UnitZ()) : Vec3(0.6, 0.0, 0.8);
  const std::uint32_t rod = add_surface(scene, cylinder(axis, 0.05), Vec3(-0.1, -0.15, 0));
  touch(scene, 40, rubbing(contact(300.0, 0.05), friction), 0.1, -1.0, {block, rod});

  engine::TimeFunction shake;  // a wave of parabolas
  shake.time = {0.0, 0.02, 0.05, 0.09, 0.15, 0.4};
  for (const double height : {0.0, 0.02, -0.01, 0.03, 0.0, 0.01})
    shake.value.emplace_back(0.5 * height, height, 0.0);
  shake.smooth = true;
  scene.time_functions = {shake};
  constexpr std::uint32_t kFloor = 42;  // of the walls, the one that carries
  scene.mats[kFloor].kind = MatKind::kPort;
  scene.drives = {{kFloor, 0, false, scene.mats[kFloor].position}};
  World world = make_world(scene, width);

  run(world, 2000);
  return world;
}

/// 3 dimensions: seven rods that are stiff against bending, clamped and blown at by a force that a formula gives.
World blown_rods(VectorWidth width) {
  NetworkDescription scene;
  scene.step = 2e-4;
  scene.gravity = Vec3(0, -9.81, 0);
  const Term now = q(engine::Quantity::kAge);
  engine::TimeFunction wind;
  wind.formula = {(Term(0.02) * now * (Term(0.4) - now)).program, Term(0.001).program,
                  (Term(0.05) * now * now).program};
  scene.time_functions = {wind};
  for (std::uint32_t rod = 0; rod < 7; ++rod) {
    const std::uint32_t first = 9 * rod;
    for (std::uint32_t i = 0; i < 9; ++i) {
      const Vec3 place(0.1 * rod, 0.05 * i, 0.002 * scattered(first + i));
      scene.mats.push_back(i < 2 ? fixed(place) : mass(0.001 + 0.001 * scattered(i), place));
      if (i > 0) scene.links.push_back({first + i - 1, first + i, 400.0, 0.002, 0.05});
      if (i > 1)
        scene.bends.push_back(
            {first + i - 2, first + i - 1, first + i, 0.01, 1e-6, 0.0, 0.05, 0.05});
    }
    scene.drives.push_back({first + 8, 0, true});
  }
  World world = make_world(scene, width);

  run(world, 2000);
  return world;
}

/// 3 dimensions: a net in a well that turns about an axis, with a drag that one of its masses sets.
World whirled_net(VectorWidth width, IntegratorKind integrator) {
  NetworkDescription scene;
  scene.step = 5e-4;
  scene.integrator = integrator;
  engine::Variable leader;
  leader.quantity = engine::VariableKind::kPosition;
  leader.index = 24;
  leader.direction = Vec3::UnitX();
  scene.variables = {leader};
  Term drag(0.0);
  drag.program.code = {{engine::Operation::kVariable, engine::Quantity::kDistance, 0.0, 0}};
  drag = Term(0.01) + Term(0.01) * drag * drag;
  const auto force = [&](std::size_t axis, const Term& whirl) {
    return (Term(-2.0) * q(engine::kPlaceInForce[axis]) + whirl -
            drag * q(engine::kVelocityInForce[axis]))
        .program;
  };
  engine::TimeFunction field;
  field.formula = {force(0, Term(-0.5) * q(engine::kPlaceInForce[1])),
                   force(1, Term(0.5) * q(engine::kPlaceInForce[0])), force(2, Term(0.0))};
  scene.time_functions = {field};
  for (std::uint32_t i = 0; i < 49; ++i) {
    const Vec3 place(0.1 * (i % 7), 0.1 * (i / 7) - 0.2, 0.05 * scattered(i));
    scene.mats.push_back(mass(0.02 + 0.01 * scattered(i + 49), place));
    if (i % 7 > 0) scene.links.push_back({i - 1, i, 60.0, 0.01, 0.1});
    if (i > 6) scene.links.push_back({i - 7, i, 60.0, 0.01, 0.1});
    scene.drives.push_back({i, 0, true});
  }
  World world = make_world(scene, width);

  run(world, 2000);
  return world;
}

/// 2 dimensions: a melt, at surfaces too.
World melt(VectorWidth width, IntegratorKind integrator) {
  NetworkDescription scene = cloud(60, 0.9, 1.0, 2, 23);
  scene.step = 5e-4;
  scene.integrator = integrator;
  scene.radius.clear();
  add_set(scene, lennard_jones(0.05, 0.1, 0.25), 0.25, 0.0, 60);
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    add_surface(scene, plane(-side), 0.6 * side);
  touch(scene, 60, of_one_state(contact(500.0, 0.1)), 0.05, 0.05, {60, 61, 62, 63});
  World world = make_world(scene, width);

  run(world, 2000);
  return world;
}

class GoldenHash : public testing::TestWithParam<VectorWidth> {
 protected:
  static void expect(const World& world, const std::string& name) {
    EXPECT_TRUE(std::isfinite(world.energy().total()));
    EXPECT_EQ(hexadecimal(world.state_hash()), golden_hashes("hashes.yaml").at(name))
        << name << ": the numbers of the engine have changed";
  }
};

TEST_P(GoldenHash, OfAPluckedStringStays) {
  expect(plucked_string(GetParam()), "plucked_string");
}

TEST_P(GoldenHash, OfATurningRingStays) {
  expect(turning_ring(GetParam()), "turning_ring");
}

TEST_P(GoldenHash, OfAPushedNetStays) {
  expect(pushed_net(GetParam()), "pushed_net");
}

TEST_P(GoldenHash, OfChangingLinksStays) {
  expect(changing_links(GetParam()), "changing_links");
}

TEST_P(GoldenHash, OfTheLeapfrogStays) {
  // the damping of the net is extrapolated, that of the string too; that of a net with heavy
  // dampers is implicit
  expect(plucked_string(GetParam(), IntegratorKind::kLeapfrog), "leapfrog_plucked_string");
  expect(pushed_net(GetParam(), IntegratorKind::kLeapfrog), "leapfrog_pushed_net");
  expect(changing_links(GetParam(), IntegratorKind::kLeapfrog), "leapfrog_changing_links");
  expect(heavily_damped_net(GetParam()), "leapfrog_heavily_damped_net");
}

TEST_P(GoldenHash, OfSetsSurfacesFrictionAndDrivesStays) {
  expect(shaken_balls(GetParam(), 2), "shaken_balls_2d");
  expect(shaken_balls(GetParam(), 3), "shaken_balls_3d");
  expect(melt(GetParam(), IntegratorKind::kCordis), "melt");
  expect(melt(GetParam(), IntegratorKind::kLeapfrog), "leapfrog_melt");
}

TEST_P(GoldenHash, OfBendsAndDrivenForcesStays) {
  expect(blown_rods(GetParam()), "blown_rods");
  expect(whirled_net(GetParam(), IntegratorKind::kCordis), "whirled_net");
  expect(whirled_net(GetParam(), IntegratorKind::kLeapfrog), "leapfrog_whirled_net");
}

TEST_P(GoldenHash, OfTheOtherIntegratorsStays) {
  NetworkDescription scene = free_cluster(40, 157, 0.0);
  scene.integrator = IntegratorKind::kSymplectic4;
  scene.gravity = Vec3(0, 0, -9.81);
  World symplectic = make_world(scene, GetParam());
  run(symplectic, 500);
  expect(symplectic, "symplectic4_cluster");
  scene = string_in_space(20, 0.05, 1e-3);
  scene.integrator = IntegratorKind::kImplicit;
  scene.gravity = Vec3(0, 0, -9.81);
  World implicit = make_world(scene, GetParam());
  run(implicit, 500);
  expect(implicit, "implicit_string");
  World modal = plucked_string(GetParam(), IntegratorKind::kModal);
  expect(modal, "modal_plucked_string");
}

TEST_P(GoldenHash, GoesWithTheSameEnergyAccountOnEveryWidth) {
  // the account is summed in an order of its own; it must not depend on the width either
  const engine::Energy narrow = pushed_net(VectorWidth::kSse2).energy();
  const engine::Energy energy = pushed_net(GetParam()).energy();

  EXPECT_EQ(energy.dissipated, narrow.dissipated);
  EXPECT_EQ(energy.port_work, narrow.port_work);
  EXPECT_EQ(energy.total(), narrow.total());
}

INSTANTIATE_TEST_SUITE_P(Widths, GoldenHash, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

}  // namespace
}  // namespace cordis::test
