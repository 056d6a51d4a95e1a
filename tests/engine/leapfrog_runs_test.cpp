// tests/engine/leapfrog_runs_test.cpp -- `leapfrog` by axis, beside a scalar loop and by MAT.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/links/link_runs.h"
#include "tests/engine/random_runs.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Drive;
using engine::IntegratorKind;
using engine::layout_of;
using engine::TimeFunction;

/// From one seed to the next: no multiple of 3, the number of dimensions.
constexpr std::uint32_t kStepOfSeeds = kSeedStride / 3 + 1;

/// The scheme of `leapfrog` with extrapolated dampers, one MAT and one link after the other.
class ScalarLeapfrog {
 public:
  explicit ScalarLeapfrog(const NetworkDescription& scene) : scene_(scene) {
    const double dt = scene.step;
    weight_step_ = scene.gravity * dt * dt;
    for (const Mat& mat : scene.mats) {
      position_.push_back(mat.position);
      moved_.push_back(dt * mat.velocity);
      extrapolated_.push_back(mat.position - dt * mat.velocity);
    }
    force_ = scalar_forces(scene, position_, extrapolated_);
    for (std::size_t i = 0; i < scene.mats.size(); ++i) {
      if (scene.mats[i].kind != MatKind::kMass) continue;
      const Vec3 pushed = this->pushed(i) - (1.0 - retention(i)) * moved_[i];
      moved_[i] -= 0.5 * pushed;
    }
  }

  /// A port is where the outside puts it, before a step.
  void move_port(std::size_t port, const Vec3& position) {
    extrapolated_[port] = position_[port];
    position_[port] = position;
  }
  void step() {
    force_ = scalar_forces(scene_, position_, extrapolated_);
    for (std::size_t i = 0; i < scene_.mats.size(); ++i) {
      if (scene_.mats[i].kind != MatKind::kMass) continue;
      Vec3 pushed = this->pushed(i);
      if (scene_.has_medium()) pushed -= (1.0 - retention(i)) * (position_[i] - extrapolated_[i]);
      moved_[i] += pushed;
      extrapolated_[i] = position_[i] - 0.5 * pushed;
      position_[i] += moved_[i];
    }
  }

  const Vec3& position(std::size_t mat) const { return position_[mat]; }
  const Vec3& force(std::size_t mat) const { return force_[mat]; }

 private:
  double retention(std::size_t mat) const {
    return 1.0 - scene_.step * scene_.medium_viscosity_on(scene_.mats[mat]) / scene_.mats[mat].mass;
  }
  Vec3 pushed(std::size_t mat) const {
    return scene_.step * scene_.step / scene_.mats[mat].mass * force_[mat] + weight_step_;
  }

  const NetworkDescription& scene_;
  Vec3 weight_step_;
  std::vector<Vec3> position_;
  std::vector<Vec3> moved_;  // in the last step
  std::vector<Vec3> extrapolated_;
  std::vector<Vec3> force_;
};

/// A random network in 1 to 3 dimensions with all that `leapfrog` takes by axis, and what acts on it.
class LeapfrogScene {
 public:
  explicit LeapfrogScene(std::uint32_t seed)
      : random_(seed),
        network(random_.network(1 + static_cast<int>(seed % 3), 80 + random_.below(40))) {
    network.integrator = IntegratorKind::kLeapfrog;
    if (random_.once_in(3)) {
      for (Link& link : network.links) link.viscosity *= 300.0;
    }
    if (random_.once_in(2)) vary_masses();
    if (random_.once_in(2) && network.dimension > 1) add_vector_springs();
    add_drives();
  }

  /// Moves ports and pushes a mass before a step.
  void act(World& world, int step) const {
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
      if (network.mats[i].kind != MatKind::kPort || is_driven(i)) continue;
      Vec3 moved = network.mats[i].position;
      moved.x() += 1e-3 * (step % 40);
      world.impose_position(i, moved);
    }
    if (step % 10 == 0)
      world.set_external_force(mass_, step % 20 == 0 ? Vec3(0.3, 0, 0) : Vec3(Vec3::Zero()));
  }

  /// Parameters change as `ctl set` changes them; the dampers may become implicit, or extrapolated.
  NetworkDescription changed() {
    NetworkDescription other = network;
    const double factor = random_.once_in(3) ? 0.0 : random_.once_in(2) ? 200.0 : 0.005;
    for (Link& link : other.links) {
      link.viscosity *= factor;
      link.stiffness *= 0.9;
    }
    other.gravity.x() -= 1.0;
    return other;
  }

 private:
  bool is_driven(std::uint32_t mat) const {
    for (const Drive& drive : network.drives) {
      if (!drive.is_force && drive.mat == mat) return true;
    }
    return false;
  }
  void vary_masses() {
    for (Mat& mat : network.mats) {
      if (mat.kind != MatKind::kMass) continue;
      mat.weightless = random_.once_in(5);
      if (random_.once_in(5)) mat.medium_viscosity = random_.uniform(0.0, 0.05);
    }
  }
  void add_vector_springs() {
    for (int i = 0; i < 6; ++i) {
      const auto count = static_cast<std::uint32_t>(network.mats.size());
      const std::uint32_t a = random_.below(count);
      const std::uint32_t b = random_.below(count);
      const bool is_near =
          network.mats[a].position.norm() < 10.0 && network.mats[b].position.norm() < 10.0;
      if (a != b && is_near) network.links.push_back({a, b, 20.0, 0.05, 0.0, true});
    }
  }
  std::uint32_t add_function() {
    TimeFunction function;
    function.time = {0.0, 0.02, 0.05};
    function.value = {Vec3::Zero(), Vec3(0.02, 0, 0), Vec3(-0.01, 0, 0)};
    function.smooth = random_.once_in(2);
    network.time_functions.push_back(function);
    return static_cast<std::uint32_t>(network.time_functions.size() - 1);
  }
  /// One port follows a function, and one mass is pushed by another.
  void add_drives() {
    bool has_driven = false;
    bool has_pushed = false;
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
      const MatKind kind = network.mats[i].kind;
      if (kind == MatKind::kMass) mass_ = i;
      if (kind == MatKind::kPort && !has_driven) {
        network.drives.push_back({i, add_function(), false, network.mats[i].position});
        has_driven = true;
      } else if (kind == MatKind::kMass && !has_pushed) {
        network.drives.push_back({i, add_function(), true});
        has_pushed = true;
      }
    }
  }

  RandomRuns random_;
  std::uint32_t mass_ = 0;

 public:
  NetworkDescription network;
};

void expect_same_motion(const World& world, const World& other, const std::string& where) {
  for (std::uint32_t i = 0; i < world.network().mat_count(); ++i) {
    ASSERT_EQ(world.position(i), other.position(i)) << where << ", MAT " << i;
    ASSERT_EQ(world.velocity(i), other.velocity(i)) << where << ", MAT " << i;
    ASSERT_EQ(world.link_force(i), other.link_force(i)) << where << ", MAT " << i;
    ASSERT_EQ(Vec3(world.positions().col(i).head<3>()), world.position(i)) << where;
  }
}

World taken_over(const World& before, const NetworkDescription& scene, VectorWidth width) {
  World world = make_world(scene, width);
  std::vector<double> room;
  room.reserve(world.max_values_of_state());
  EXPECT_TRUE(world.take_over(before, room));
  return world;
}

class LeapfrogRuns : public testing::TestWithParam<VectorWidth> {};

INSTANTIATE_TEST_SUITE_P(Widths, LeapfrogRuns, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

TEST_P(LeapfrogRuns, MoveAsAScalarLoopMovesThem) {
  int by_axis = 0;
  for (std::uint32_t seed = 0; seed < 240; seed += kStepOfSeeds) {
    RandomRuns random(seed);
    NetworkDescription scene = random.network(1 + static_cast<int>(seed % 3), 75 + seed % 40);
    scene.integrator = IntegratorKind::kLeapfrog;
    ASSERT_FALSE(engine::damps_implicitly(scene));
    if (layout_of(scene).is_by_axis()) ++by_axis;
    World world = make_world(scene, GetParam());
    const NetworkDescription in_order = in_order_of_step(scene);
    ScalarLeapfrog scalar(in_order);

    for (int n = 0; n < 30; ++n) {
      move_ports(scene, world, n);
      for (std::size_t i = 0; i < scene.mats.size(); ++i) {
        if (scene.mats[i].kind == MatKind::kPort)
          scalar.move_port(i, scene.mats[i].position + Vec3(1e-3 * (n % 40), 0, 0));
      }
      world.step();
      scalar.step();

      for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
        ASSERT_EQ(world.link_force(i), scalar.force(i))
            << "seed " << seed << ", step " << n << ", MAT " << i;
        ASSERT_EQ(world.position(i), scalar.position(i))
            << "seed " << seed << ", step " << n << ", MAT " << i;
      }
    }
  }
  EXPECT_GT(by_axis, static_cast<int>(100 / kStepOfSeeds));
}

TEST_P(LeapfrogRuns, MoveTheMatsAsThoseStoredByMat) {
  int light = 0;
  int heavy = 0;
  for (std::uint32_t seed = 0; seed < 240; seed += kStepOfSeeds) {
    LeapfrogScene scene(seed);
    scene.network =
        in_order_of_step(scene.network);  // implicit dampers keep the order of the network
    if (layout_of(scene.network).is_by_axis())
      ++(engine::damps_implicitly(scene.network) ? heavy : light);
    World world = make_world(scene.network, GetParam());
    World by_mat = make_world(gathered(scene.network), VectorWidth::kSse2);
    ASSERT_FALSE(layout_of(by_mat.network().description()).is_by_axis());
    const std::string where = "seed " + std::to_string(seed);

    for (int n = 0; n < 40; ++n) {
      for (World* either : {&world, &by_mat}) {
        scene.act(*either, n);
        either->step();
      }
    }
    expect_same_motion(world, by_mat, where);
    const engine::Energy energy = world.energy();
    const engine::Energy expected = by_mat.energy();
    const double rounding =
        1e-12 * (1.0 + expected.largest);  // the works are summed in another order
    EXPECT_EQ(energy.kinetic, expected.kinetic) << where;
    EXPECT_NEAR(energy.elastic, expected.elastic, rounding) << where;
    EXPECT_NEAR(energy.dissipated, expected.dissipated, rounding) << where;
    EXPECT_NEAR(energy.port_work, expected.port_work, rounding) << where;
    EXPECT_NEAR(energy.residual(), expected.residual(), rounding) << where;

    const NetworkDescription changed = scene.changed();
    World later = taken_over(world, changed, GetParam());
    World by_mat_later = taken_over(by_mat, gathered(changed), VectorWidth::kSse2);
    ASSERT_EQ(layout_of(changed).is_by_axis(), layout_of(scene.network).is_by_axis());
    for (int n = 40; n < 70; ++n) {
      for (World* either : {&later, &by_mat_later}) {
        scene.act(*either, n);
        either->step();
      }
    }
    expect_same_motion(later, by_mat_later, where + ", changed");
  }
  EXPECT_GT(light, static_cast<int>(50 / kStepOfSeeds));
  EXPECT_GT(heavy, static_cast<int>(30 / kStepOfSeeds));
}

TEST_P(LeapfrogRuns, HaveTheSameBitsOnEveryWidthAndFromASnapshotOn) {
  for (std::uint32_t seed = 0; seed < 90; seed += kStepOfSeeds) {
    const LeapfrogScene scene(seed);
    World narrow = make_world(scene.network, VectorWidth::kSse2);
    World world = make_world(scene.network, GetParam());
    for (int n = 0; n < 37; ++n) {
      for (World* either : {&narrow, &world}) {
        scene.act(*either, n);
        either->step();
      }
    }
    ASSERT_EQ(world.state_hash(), narrow.state_hash()) << "seed " << seed;
    EXPECT_EQ(world.energy().dissipated, narrow.energy().dissipated) << "seed " << seed;
    EXPECT_EQ(world.energy().total(), narrow.energy().total()) << "seed " << seed;

    World restored = make_world(scene.network, GetParam());
    restored.restore(narrow.snapshot());
    EXPECT_EQ(restored.state_hash(), world.state_hash()) << "seed " << seed;
    const AllocationGuard guard;
    for (int n = 37; n < 70; ++n) {
      for (World* either : {&restored, &world}) {
        scene.act(*either, n);
        either->step();
      }
    }
    EXPECT_EQ(guard.count(), 0U);
    EXPECT_EQ(restored.state_hash(), world.state_hash()) << "seed " << seed;
    EXPECT_EQ(restored.energy().total(), world.energy().total()) << "seed " << seed;
  }
}

/// What freezes is stored by MAT.
TEST_P(LeapfrogRuns, HaveTheBitsOfAStepThatLeavesOutWhatRests) {
  int compared = 0;
  for (std::uint32_t seed = 0; seed < 90; seed += kStepOfSeeds) {
    LeapfrogScene scene(seed);
    scene.network = in_order_of_step(scene.network);  // what freezes keeps the order of the network
    if (engine::damps_implicitly(scene.network) || !layout_of(scene.network).is_by_axis()) continue;
    NetworkDescription freezes = scene.network;
    freezes.freeze_tolerance = 1e-30;
    ASSERT_FALSE(layout_of(freezes).is_by_axis());
    World world = make_world(scene.network, GetParam());
    World frozen = make_world(freezes, GetParam());
    for (int n = 0; n < 40; ++n) {
      for (World* either : {&world, &frozen}) {
        scene.act(*either, n);
        either->step();
      }
    }
    ASSERT_EQ(frozen.asleep_count(), 0U);
    for (std::uint32_t i = 0; i < scene.network.mats.size(); ++i) {
      ASSERT_EQ(world.position(i), frozen.position(i)) << "seed " << seed << ", MAT " << i;
      ASSERT_EQ(world.velocity(i), frozen.velocity(i)) << "seed " << seed << ", MAT " << i;
    }
    ++compared;
  }
  EXPECT_GT(compared, static_cast<int>(20 / kStepOfSeeds));
}

TEST_P(LeapfrogRuns, CountTheMatsThatAreNotFinite) {
  for (std::uint32_t count = 9; count < 40; ++count) {
    NetworkDescription scene = string_in_space(count, 0.05, 1e-3);
    scene.integrator = IntegratorKind::kLeapfrog;
    ASSERT_TRUE(layout_of(scene).is_by_axis());
    for (std::uint32_t mat = 1; mat <= count; mat += 4) {
      World world = make_world(scene, GetParam());
      EXPECT_EQ(world.step().non_finite_mats, 0U);
      world.set_external_force(mat, Vec3(0, 1e308, 0));
      world.step();
      world.set_external_force(mat, Vec3::Zero());
      std::uint32_t found = 0;
      for (int n = 0; n < 3; ++n) found = world.step().non_finite_mats;
      std::uint32_t expected = 0;
      for (std::uint32_t i = 0; i < world.network().mat_count(); ++i)
        expected += world.position(i).allFinite() ? 0 : 1;
      EXPECT_GT(found, 0U) << count << " masses, MAT " << mat;
      EXPECT_EQ(found, expected) << count << " masses, MAT " << mat;
    }
  }
}

}  // namespace
}  // namespace cordis::test
