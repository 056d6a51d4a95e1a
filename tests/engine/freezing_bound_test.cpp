// tests/engine/freezing_bound_test.cpp -- the stated bound: where what rests is left out, all comes
// to rest where it would otherwise.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/struck_chain.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

constexpr double kBoundTolerance = 1e-6;  // [m]
constexpr double kLargestError = 20.0;    // in tolerances, as docs/reductions.md says

TEST(FreezingBound, LetsAPendulumHangPlumb) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 2e-4;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.medium_viscosity = 0.1;
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3(0.0244, -0.9997, 0))};
  scene.links = {{0, 1, 1e5, 0.0, 0.9999879179181012}};
  World world = make_world(frozen(scene, kBoundTolerance));

  run(world, 200000);

  EXPECT_LT(std::abs(world.position(1).x()), kBoundTolerance);
}

TEST(FreezingBound, LetsASwingingPendulumSwing) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 2e-4;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3(0.0244, -0.9997, 0))};
  scene.links = {{0, 1, 1e5, 0.0, 0.9999879179181012}};
  World world = make_world(frozen(scene, kBoundTolerance));
  double least = 1.0;
  double most = -1.0;

  for (int n = 0; n < 50000; ++n) {
    world.step();
    least = std::min(least, world.position(1).x());
    most = std::max(most, world.position(1).x());
  }

  EXPECT_NEAR(least, -0.0244, 1e-4);
  EXPECT_NEAR(most, 0.0244, 1e-4);
}

/// What docs/reductions.md says of a stiff pair on a soft spring.
TEST(FreezingBound, IsLateWhereAPairSwingsSlowlyAndIsOffByLittleWhereItComesToRest) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 2e-4;
  scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(1.003, 0, 0)), mass(1.0, Vec3(1.103, 0, 0))};
  scene.links = {{0, 1, 0.01, 0.0, 1.0}, {1, 2, 1e4, 1.0, 0.1}};
  const auto difference_after = [&](double seconds) {
    World whole = make_world(scene);
    World part = make_world(frozen(scene, kBoundTolerance));
    double largest = 0.0;
    double last = 0.0;
    for (double time = 0.0; time < seconds; time += 0.5) {
      run(whole, 2500);
      run(part, 2500);
      last = std::abs(part.position(1).x() - whole.position(1).x());
      largest = std::max(largest, last);
    }
    return std::pair(largest, last);
  };

  EXPECT_NEAR(difference_after(200.0).first, 1.5e-3, 0.05e-3);
  scene.medium_viscosity = 0.05;
  EXPECT_LT(difference_after(1000.0).second, kLargestError * kBoundTolerance);
}

TEST(FreezingBound, LetsAPulledBodyStart) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 2e-4;
  scene.mats.push_back(fixed(Vec3(10, 0, 0)));
  for (int i = 0; i < 5; ++i) scene.mats.push_back(mass(1.0, Vec3(0.1 * i, 0, 0)));
  for (std::uint32_t i = 1; i <= 5; ++i) {
    scene.links.push_back({0, i, 0.001, 0.0, 0.0});
    if (i < 5) scene.links.push_back({i, i + 1, 1e5, 0.0, 0.1});
  }
  World whole = make_world(scene);
  World part = make_world(frozen(scene, kBoundTolerance));

  run(whole, 40000);
  run(part, 40000);

  EXPECT_GT(whole.position(3).x(), 0.5);
  EXPECT_NEAR(part.position(3).x(), whole.position(3).x(), 1e-3);
}

TEST(FreezingBound, LetsAFreeBodyCoastThatIsFasterThanAQuarterToleranceInAWindow) {
  NetworkDescription scene;  // one tolerance in the first window
  scene.dimension = 2;
  scene.step = 2e-4;
  const Vec3 velocity(1e-5, 0, 0);
  scene.mats = {mass(1.0, Vec3::Zero(), velocity), mass(1.0, Vec3(0.1, 0, 0), velocity)};
  scene.links = {{0, 1, 1000.0, 1.0, 0.1}};
  World world = make_world(frozen(scene, kBoundTolerance));

  run(world, 1000000);

  EXPECT_NEAR(world.position(0).x(), 2000e-6, kBoundTolerance);
}

/// Draws the parts of a scene.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  double decade(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }

 private:
  std::mt19937 random_;
};

void join(NetworkDescription& scene, std::uint32_t a, std::uint32_t b, double stiffness,
          double viscosity, double rest_over_length = 1.0) {
  const Vec3 along = scene.mats[b].position - scene.mats[a].position;
  const double length = scene.dimension == 1 ? along.x() : along.norm();
  scene.links.push_back({a, b, stiffness, viscosity, rest_over_length * length});
}

void add_net(NetworkDescription& scene, Draw& draw) {
  const std::uint32_t wide = 3 + draw.below(4);
  const std::uint32_t high = 2 + draw.below(3);
  const double stiffness = draw.decade(20.0, 2000.0);
  const double viscosity = draw.decade(0.01, 0.3);
  const double mass_of_each = draw.decade(0.01, 0.1);
  for (std::uint32_t y = 0; y < high; ++y) {
    for (std::uint32_t x = 0; x < wide; ++x) {
      const Vec3 place =
          scene.dimension > 1 ? Vec3(0.1 * x, -0.1 * y, 0) : Vec3(0.1 * x + 0.03 * y, 0, 0);
      const bool hangs = y == 0 && (x == 0 || x + 1 == wide);
      scene.mats.push_back(hangs ? fixed(place) : mass(mass_of_each, place));
    }
  }
  for (std::uint32_t y = 0; y < high; ++y) {
    for (std::uint32_t x = 0; x < wide; ++x) {
      const std::uint32_t i = y * wide + x;
      if (x + 1 < wide) join(scene, i, i + 1, stiffness, viscosity, 0.8);
      if (y + 1 < high) join(scene, i, i + wide, stiffness, viscosity, 0.8);
    }
  }
}

void add_string(NetworkDescription& scene, Draw& draw) {
  const std::uint32_t count = 5 + draw.below(25);
  const double stiffness = draw.decade(100.0, 10000.0);
  for (std::uint32_t i = 0; i < count; ++i) {
    scene.mats.push_back(mass(0.02, Vec3(0.02 * i, 0, 0)));
  }
  for (std::uint32_t i = 0; i + 1 < count; ++i) join(scene, i, i + 1, stiffness, 0.1);
  const Vec3 end(0.02 * count + draw.between(0.1, 1.0), 0, 0);
  scene.mats.push_back(fixed(end));
  const std::uint32_t step = 1 + draw.below(5);  // some are pulled, by something soft
  for (std::uint32_t i = 0; i < count; i += step) {
    join(scene, i, count, draw.decade(0.1, 3.0), 0.0, draw.between(0.5, 0.99));
  }
  if (scene.dimension > 1) scene.gravity = Vec3::Zero();
}

void add_pendulum(NetworkDescription& scene, Draw& draw) {
  const std::uint32_t count = 1 + draw.below(3);
  const double slant = scene.dimension > 1 ? draw.between(-1.0, 1.0) : 0.0;
  const Vec3 along(std::sin(slant), -std::cos(slant), 0);
  scene.mats.push_back(fixed(Vec3::Zero()));
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 place = 0.2 * (i + 1) * along;
    scene.mats.push_back(mass(0.05, scene.dimension > 1 ? place : Vec3(0.2 * (i + 1), 0, 0)));
    join(scene, i, i + 1, draw.decade(1e3, 3e4), 0.5);
  }
}

/// Balls in a hexagonal patch that hold together, hung from its highest row.
void add_set(NetworkDescription& scene, Draw& draw) {
  constexpr double kSpacing = 0.01;
  engine::SetLiaison set;
  const std::uint32_t wide = scene.dimension > 1 ? 3 + draw.below(5) : 8;
  const std::uint32_t high = scene.dimension > 1 ? 2 + draw.below(3) : 1;
  for (std::uint32_t y = 0; y < high; ++y) {
    for (std::uint32_t x = 0; x < wide; ++x) {
      const Vec3 place(kSpacing * (x + 0.5 * (y % 2)), -std::sqrt(0.75) * kSpacing * y, 0);
      set.set_p.push_back(static_cast<std::uint32_t>(scene.mats.size()));
      const bool hangs = scene.dimension > 1 ? y == 0 : x == 0;
      scene.mats.push_back(hangs ? fixed(place) : mass(1e-3, place));
    }
  }
  engine::LinkState bond;
  bond.stiffness = draw.decade(50.0, 500.0);
  bond.viscosity = draw.between(0.02, 0.2);
  engine::StateMachine state_machine;
  state_machine.states = {bond};
  scene.state_machines = {state_machine};
  set.range = 1.4 * kSpacing;
  set.rest_length = kSpacing * draw.between(0.97, 1.0);
  scene.sets = {set};
}

void add_tangle(NetworkDescription& scene, Draw& draw) {
  const std::uint32_t count = 5 + draw.below(20);
  const auto point = [&] {
    Vec3 place = Vec3::Zero();
    for (int axis = 0; axis < scene.dimension; ++axis) place[axis] = draw.between(0.0, 1.0);
    return place;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    scene.mats.push_back(mass(draw.decade(0.03, 0.3), point()));
  }
  for (int i = 0; i < 4; ++i) scene.mats.push_back(fixed(point()));
  const auto mat_count = static_cast<std::uint32_t>(scene.mats.size());
  for (std::uint32_t i = 0; i < count; ++i) {  // nothing flies off
    join(scene, i, count + draw.below(4), draw.decade(1.0, 300.0), 0.1, 0.0);
  }
  for (std::uint32_t i = 0; i < 2 * count; ++i) {
    const std::uint32_t a = draw.below(count);
    const std::uint32_t b = draw.below(mat_count);
    if (a == b) continue;
    join(scene, a, b, draw.decade(1.0, 300.0), draw.between(0.0, 0.3), draw.between(0.0, 0.2));
    if (i % 8 == 0) scene.maxwell_links.push_back({a, b, draw.between(5.0, 20.0), 0.5});
  }
}

NetworkDescription random_scene(std::uint32_t seed) {
  Draw draw(seed);
  NetworkDescription scene;
  scene.dimension = static_cast<int>(1 + draw.below(3));
  scene.step = 2e-4;
  scene.integrator =
      draw.below(2) == 0 ? engine::IntegratorKind::kCordis : engine::IntegratorKind::kLeapfrog;
  scene.gravity = draw.between(0.0, 1.0) < 0.8 ? Vec3(0, -9.81, 0) : Vec3(Vec3::Zero());
  if (scene.dimension == 1) scene.gravity = Vec3(draw.between(-2.0, 2.0), 0, 0);
  scene.medium_viscosity = draw.decade(0.02, 0.5);
  switch (seed % 5) {
    case 0:
      add_net(scene, draw);
      break;
    case 1:
      add_string(scene, draw);
      break;
    case 2:
      add_pendulum(scene, draw);
      break;
    case 3:
      add_set(scene, draw);
      break;
    default:
      add_tangle(scene, draw);
      break;
  }
  return scene;
}

/// Pulls one for half a second, then runs until nothing moves by a tenth of the tolerance in half a
/// second. @return false: it does not
bool come_to_rest(World& world, const NetworkDescription& scene) {
  constexpr int kBlock = 2500;
  std::vector<Vec3> before(scene.mats.size(), Vec3::Zero());
  const auto pulled = static_cast<std::uint32_t>(scene.mats.size() / 2);
  for (int block = 0; block < 1000; ++block) {
    for (std::uint32_t i = 0; i < before.size(); ++i) before[i] = world.position(i);
    if (scene.mats[pulled].kind == engine::MatKind::kMass) {
      const double weight = 0.5 * scene.mats[pulled].mass;
      world.set_external_force(pulled, block == 0 ? Vec3(weight, 0, 0) : Vec3(Vec3::Zero()));
    }
    run(world, kBlock);
    double moved = 0.0;
    for (std::uint32_t i = 0; i < before.size(); ++i) {
      moved = std::max(moved, (world.position(i) - before[i]).norm());
    }
    if (block > 0 && moved < 0.1 * kBoundTolerance) return true;
  }
  return false;
}

TEST(FreezingBound, HoldsInRandomScenes) {
  double worst = 0.0;
  std::uint32_t asleep_count = 0;
  for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(rounds(200)); ++seed) {
    const NetworkDescription scene = random_scene(seed);
    World whole = make_world(scene);
    World part = make_world(frozen(scene, kBoundTolerance));
    EXPECT_TRUE(come_to_rest(whole, scene)) << "seed " << seed;
    EXPECT_TRUE(come_to_rest(part, scene)) << "seed " << seed;

    double error = 0.0;
    for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
      error = std::max(error, (whole.position(i) - part.position(i)).norm() / kBoundTolerance);
    }
    std::cout << "seed " << seed << ", kind " << seed % 5 << ": " << error << " tolerances, "
              << part.asleep_count() << " of " << scene.mats.size() << " asleep\n";
    EXPECT_LT(error, kLargestError) << "seed " << seed;
    worst = std::max(worst, error);
    if (part.asleep_count() > 0) ++asleep_count;
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(2 * asleep_count, static_cast<std::uint32_t>(rounds(200)));
}

}  // namespace
}  // namespace cordis::test
