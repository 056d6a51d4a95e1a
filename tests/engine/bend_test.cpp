// tests/engine/bend_test.cpp -- liaisons of three MATs that resist bending.
#include <cmath>
#include <optional>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/engine/beams.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Bend;

class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  Vec3 vector(int dimension, double half) {
    Vec3 vector = Vec3::Zero();
    for (int axis = 0; axis < dimension; ++axis) vector[axis] = between(-half, half);
    return vector;
  }

 private:
  std::mt19937 random_;
};

enum class Pose { kAny, kStraight, kFolded, kCoincident };

/// Three masses in some pose, in motion, with a bend of unequal sides.
NetworkDescription three_masses(RandomNumbers& random, int dimension, Pose pose) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-4;
  const Vec3 a = random.vector(dimension, 0.1);
  const Vec3 side = random.vector(dimension, 0.1);
  Vec3 next = random.vector(dimension, 0.1);
  if (pose == Pose::kStraight) next = random.between(0.5, 2.0) * side;
  if (pose == Pose::kFolded) next = -side + random.vector(dimension, 1e-9);
  if (pose == Pose::kCoincident) next = Vec3::Zero();
  for (const Vec3& place : {a, Vec3(a + side), Vec3(a + side + next)}) {
    scene.mats.push_back(mass(random.between(0.01, 0.1), place, random.vector(dimension, 1.0)));
  }
  const double rest = dimension < 3 ? random.between(-3.0, 3.0) : 0.0;
  scene.bends = {{0, 1, 2, random.between(0.0, 0.1), random.between(0.0, 1e-3), rest,
                  random.between(0.05, 0.2), random.between(0.05, 0.2)}};
  return scene;
}

TEST(Bend, PutsNoForceAndNoTorqueOnAllThreeInAnyPose) {
  RandomNumbers random(1);
  for (int round = 0; round < 400; ++round) {
    for (int dimension = 1; dimension <= 3; ++dimension) {
      const auto pose = static_cast<Pose>(round % 4);
      const NetworkDescription scene = three_masses(random, dimension, pose);
      World world = make_world(scene);
      world.step();
      Vec3 force = Vec3::Zero();
      Vec3 torque = Vec3::Zero();
      double largest = 0.0;
      for (std::uint32_t i = 0; i < 3; ++i) {
        const Vec3 on_mat = world.link_force(i);
        force += on_mat;
        torque += scene.mats[i].position.cross(on_mat);
        largest = std::max(largest, on_mat.norm());
        ASSERT_TRUE(on_mat.allFinite());
      }
      EXPECT_LE(force.norm(), 1e-15 * largest);
      if (dimension == 1) continue;
      EXPECT_LE(torque.norm(), 1e-15 * largest) << round << " " << dimension;
    }
  }
}

/// Energy of a bend where three MATs are, as a formula of the angle for sides of their rest lengths [J].
double energy_at(double stiffness, double angle) {
  return stiffness * (1.0 - std::cos(angle));
}

TEST(Bend, StoresWhatItsAngleSays) {
  constexpr double kStiffness = 0.03;
  for (const double rest : {0.0, 0.7, -2.0}) {
    for (const double angle : {0.0, 0.01, -1.0, 3.0}) {
      NetworkDescription scene;
      scene.dimension = 2;
      scene.step = 1e-4;
      const Vec3 first(0.1, 0.0, 0.0);
      const Vec3 second(0.2 * std::cos(angle), 0.2 * std::sin(angle), 0.0);
      scene.mats = {fixed(-first), fixed(Vec3::Zero()), fixed(second)};
      scene.bends = {{0, 1, 2, kStiffness, 0.0, rest, 0.1, 0.2}};

      EXPECT_NEAR(make_world(scene).energy().elastic, energy_at(kStiffness, angle - rest), 1e-15);
    }
  }
}

TEST(Bend, TurnsItsEndByTheSineOfTheAngle) {
  constexpr double kStiffness = 0.03;
  constexpr double kAngle = 0.4;
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-4;
  const Vec3 end(0.2 * std::cos(kAngle), 0.0, 0.2 * std::sin(kAngle));
  scene.mats = {fixed(Vec3(-0.1, 0, 0)), fixed(Vec3::Zero()), fixed(end)};
  scene.bends = {{0, 1, 2, kStiffness, 0.0, 0.0, 0.1, 0.2}};
  World world = make_world(scene);
  world.step();

  const Vec3 moment = end.cross(world.link_force(2));
  EXPECT_NEAR(moment.y(), kStiffness * std::sin(kAngle), 1e-15);
  EXPECT_NEAR(moment.norm(), std::abs(moment.y()), 1e-15);
}

/// A free chain with bends and viscosity of its own, curled up, in motion.
NetworkDescription curled_chain(int dimension, double viscosity) {
  RandomNumbers random(3);
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-4;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const double turn = 0.5 * i;
    Vec3 place(0.05 * std::cos(turn), 0.05 * std::sin(turn), 0.01 * i);
    for (int axis = dimension; axis < 3; ++axis) place[axis] = 0.0;
    scene.mats.push_back(mass(0.01, place, random.vector(dimension, 0.5)));
    if (i > 0) scene.links.push_back({i - 1, i, 100.0, viscosity, dimension == 1 ? 0.0 : 0.03});
    const double rest = dimension < 3 ? random.between(-0.5, 0.5) : 0.0;
    if (i > 1) {
      scene.bends.push_back({i - 2, i - 1, i, 0.02, 0.002 * viscosity, rest,
                             random.between(0.02, 0.04), random.between(0.02, 0.04)});
    }
  }
  return scene;
}

class BentChain : public testing::TestWithParam<int> {};

TEST_P(BentChain, KeepsItsMomenta) {
  World world = make_world(curled_chain(GetParam(), 0.05));
  const Vec3 momentum = world.momentum();
  const Vec3 angular = world.angular_momentum();

  run(world, 10'000);

  EXPECT_LT((world.momentum() - momentum).norm(), 1e-12);
  EXPECT_LT((world.angular_momentum() - angular).norm(), 1e-12);
}

TEST_P(BentChain, HasAnAccountThatCloses) {
  World world = make_world(curled_chain(GetParam(), 0.05));
  for (int n = 0; n < 50'000; ++n) {
    world.step();
    const engine::Energy energy = world.energy();
    ASSERT_LT(std::abs(energy.residual()), 1e-11 * energy.largest) << n;
  }
  EXPECT_GT(world.energy().dissipated, 0.0);
}

TEST_P(BentChain, KeepsItsEnergyOverALongRun) {
  World world = make_world(curled_chain(GetParam(), 0.0));
  const double before = world.energy().total();
  double largest = 0.0;
  for (int n = 0; n < rounds(300'000); ++n) {
    world.step();
    if (n % 16 != 0) continue;
    const engine::Energy energy = world.energy();
    largest = std::max(largest, std::abs(energy.total() - before - energy.elastic_error));
  }
  EXPECT_LT(largest, 0.01 * before);
}

TEST_P(BentChain, HasTheSameBitsOnEveryWidthAndAfterASnapshot) {
  std::optional<std::uint64_t> hash;
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(curled_chain(GetParam(), 0.05), width);
    run(world, 300);
    const engine::Snapshot snapshot = world.snapshot();
    World restored = make_world(curled_chain(GetParam(), 0.05), width);
    restored.restore(snapshot);
    for (World* each : {&world, &restored}) {
      run(*each, 300);
      if (!hash) hash = each->state_hash();
      EXPECT_EQ(each->state_hash(), *hash);
      EXPECT_EQ(each->energy().dissipated, world.energy().dissipated);
    }
  }
}

TEST_P(BentChain, StepsWithoutAllocating) {
  World world = make_world(curled_chain(GetParam(), 0.05));
  const AllocationGuard guard;
  run(world, 10);
  EXPECT_EQ(guard.count(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, BentChain, testing::Values(1, 2, 3));

/// The angle of a fixed side and a mass beside it that swings, over the start.
double decay_after(double time, engine::IntegratorKind integrator, double step) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.integrator = integrator;
  scene.mats = {fixed(Vec3::Zero()), fixed(Vec3::Zero()), mass(0.1, Vec3(0.001, 0, 0))};
  scene.bends = {{0, 1, 2, 0.4, 0.004, 0.0, 0.1, 0.2}};
  World world = make_world(scene);
  run(world, static_cast<int>(std::lround(time / step)));
  return world.position(2).x() / 0.001;
}

TEST(Bend, SwingsAndFadesAsItsClosedFormSays) {
  // m x'' = -(B x + Z x') / l^2
  const double w2 = 0.4 / 0.04 / 0.1;
  const double s = 0.5 * 0.004 / 0.04 / 0.1;
  const double w = std::sqrt(w2 - s * s);
  const double exact = std::exp(-s) * (std::cos(w) + s / w * std::sin(w));
  for (const auto integrator : {engine::IntegratorKind::kCordis, engine::IntegratorKind::kLeapfrog,
                                engine::IntegratorKind::kImplicit}) {
    const double coarse = decay_after(1.0, integrator, 2e-4) - exact;
    const double fine = decay_after(1.0, integrator, 1e-4) - exact;
    EXPECT_LT(std::abs(coarse), 2e-3);
    const bool second_order = integrator == engine::IntegratorKind::kLeapfrog;
    EXPECT_NEAR(coarse / fine, second_order ? 4.0 : 2.0, 0.1) << to_string(integrator);
  }
}

class Beam : public testing::TestWithParam<int> {};

TEST_P(Beam, BendsUnderALoadAtItsTipAsEulerSays) {
  const CantileverBeam beam(GetParam());
  NetworkDescription scene = beam.network();
  scene.medium_viscosity = 2.0 * beam.angular_frequency(1) * scene.mats.back().mass;
  World world = make_world(scene);
  const auto tip = static_cast<std::uint32_t>(scene.mats.size() - 1);
  const double load = 0.01 * beam.length() / beam.tip_deflection(1.0);
  world.set_external_force(tip, load * beam.across());

  run(world, beam.steps(12.0));

  const Vec3 moved = world.position(tip) - scene.mats[tip].position;
  const double ratio = moved.dot(beam.across()) / beam.tip_deflection(load);
  EXPECT_NEAR(ratio, 1.0, 0.002);
  RecordProperty("ratio", std::to_string(ratio));
}

TEST_P(Beam, VibratesAsEulerSays) {
  const CantileverBeam beam(GetParam());
  // The slowest ones last the longest: under sanitizers the fastest is enough.
  for (int mode = 3; mode > 3 - rounds(3); --mode) {
    NetworkDescription scene = beam.network();
    beam.displace(mode, 1e-5, scene);
    World world = make_world(scene);

    const double ratio = beam.frequency_of(mode, world) * 2.0 * M_PI / beam.angular_frequency(mode);

    EXPECT_NEAR(ratio, 1.0, 0.002) << mode;
    RecordProperty("ratio_" + std::to_string(mode), std::to_string(ratio));
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Beam, testing::Values(1, 2, 3));

TEST(Bend, IsRefusedWhereItCannotBe) {
  const auto refused = [](auto change) {
    RandomNumbers random(1);
    NetworkDescription scene = three_masses(random, 3, Pose::kAny);
    change(scene);
    EXPECT_THROW(make_world(scene), std::invalid_argument);
  };
  refused([](NetworkDescription& scene) { scene.bends[0].mat_c = 3; });
  refused([](NetworkDescription& scene) { scene.bends[0].mat_c = 0; });
  refused([](NetworkDescription& scene) { scene.bends[0].stiffness = -1.0; });
  refused([](NetworkDescription& scene) { scene.bends[0].viscosity = kNan; });
  refused([](NetworkDescription& scene) { scene.bends[0].length_ab = 0.0; });
  refused([](NetworkDescription& scene) { scene.bends[0].rest_angle = 0.1; });
  refused([](NetworkDescription& scene) { scene.freeze_tolerance = 1e-6; });
  refused([](NetworkDescription& scene) {
    scene.bends[0].viscosity = 1e-3;
    scene.integrator = engine::IntegratorKind::kSymplectic4;
  });
}

}  // namespace
}  // namespace cordis::test
