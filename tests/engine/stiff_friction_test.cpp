// tests/engine/stiff_friction_test.cpp -- friction that `leapfrog` solves for its speed.
#include "sim_node/engine/integrators/stiff_friction.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test::stiff {
namespace {

using engine::IntegratorKind;
using engine::Law;

Law power_of_speed(double coefficient, double exponent) {
  return engine::Power{coefficient, exponent};
}

LinkState with_friction(const Law& law) {
  LinkState state;
  state.dissipation = law;
  return state;
}

/// MAT 0 fixed, MAT 1 of 1 kg at 1 m with the speed v0, between them one state.
NetworkDescription one_mass(const LinkState& state, double v0, double step) {
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 1.0, v0, step);
  scene.links.clear();
  scene.state_machines = {Behaving().state(state).state_machine};
  scene.state_links = {{0, 1, 0, 0.0}};
  scene.integrator = IntegratorKind::kLeapfrog;
  return scene;
}

/// (1 + p Z') x+ = (2 - K' + (2 p - 1) Z') x - (1 - (1 - p) Z') x-, m = 1 and dt = 1; p is 1/2 up to Z' = 2, and
/// there on 1 - 1 / Z'.
class DamperOfALink : public testing::TestWithParam<double> {};

TEST_P(DamperOfALink, IsTakenLaterTheHeavierItIs) {
  constexpr double kStiffness = 1.0;
  const double viscosity = GetParam();
  const double part = viscosity > 2.0 ? 1.0 - 1.0 / viscosity : 0.5;
  LinkState state;
  state.stiffness = kStiffness;
  state.viscosity = viscosity;
  World world = make_world(one_mass(state, 0.0, 1.0));
  run(world, 1);
  double before = 1.0;
  double now = world.position(1).x();
  for (int n = 1; n < 200; ++n) {
    const double next = ((2.0 - kStiffness + (2.0 * part - 1.0) * viscosity) * now -
                         (1.0 - (1.0 - part) * viscosity) * before) /
                        (1.0 + part * viscosity);
    world.step();
    ASSERT_NEAR(world.position(1).x(), next, 1e-8) << n;
    before = now;
    now = next;
  }
}

INSTANTIATE_TEST_SUITE_P(StiffFriction, DamperOfALink, testing::Values(0.5, 1.9, 2.1, 5.0, 300.0));

/// A block on dry friction, thrown or pushed: it comes to rest, and the friction is the push.
TEST(StiffFriction, OfADryContactEndsAllMotion) {
  constexpr double kStep = 1e-3;
  constexpr double kFriction = 5.3;
  for (const double push : {0.0, 3.0, -5.0}) {
    for (const double speed : {1.0, 0.0106, 0.005, 1e-6}) {
      for (const double medium : {0.0, 0.5}) {
        NetworkDescription scene =
            one_mass(with_friction(power_of_speed(kFriction, 0.0)), speed, kStep);
        scene.medium_viscosity = medium;
        World world = make_world(scene);
        world.set_external_force(1, Vec3(push, 0.0, 0.0));
        run(world, 4000);  // 0.3 N are left to stop 1 m/s
        for (int n = 0; n < 20; ++n) {
          world.step();
          ASSERT_NEAR(world.velocity(1).x(), 0.0, 1e-9) << push << ' ' << speed << ' ' << medium;
          ASSERT_NEAR(world.tension_of(0), push, 1e-6) << push << ' ' << speed;
        }
      }
    }
  }
}

/// Beside a heavy linear damper, which is implicit, friction opposes the motion, and all comes to rest.
TEST(StiffFriction, OfADryContactOpposesTheMotionBesideHeavyDampers) {
  for (const double viscosity : {1e3, 3e4, 1e6}) {
    for (const double friction : {5.0, 500.0, 2e3, 1e5}) {
      NetworkDescription scene = one_mass(with_friction(power_of_speed(friction, 0.0)), 1.0, 1e-3);
      scene.links.push_back({0, 1, 0.0, viscosity, 0.0});
      ASSERT_TRUE(engine::damps_implicitly(scene));
      World world = make_world(scene);
      run(world, 1);
      for (int n = 0; n < 300; ++n) {
        const double way = world.position(1).x() - 1.0;
        world.step();
        EXPECT_LE(std::abs(world.position(1).x() - 1.0 - way), 1e-3)
            << viscosity << ' ' << friction;
        if (n == 0) {
          EXPECT_GT(world.tension_of(0), -1e-9) << viscosity << ' ' << friction;
        }
      }
      EXPECT_NEAR(world.velocity(1).x(), 0.0, 1e-9) << viscosity << ' ' << friction;
    }
  }
}

/// A mass that no damper holds sticks as it does in a scene without any.
TEST(StiffFriction, OfADryContactSticksWhereOthersAreDamped) {
  NetworkDescription scene = one_mass(with_friction(power_of_speed(5.3, 0.0)), 1.0, 1e-3);
  scene.mats.push_back(mass(1.0, Vec3(3.0, 0.0, 0.0)));
  scene.links.push_back({0, 2, 0.0, 1e5, 0.0});
  ASSERT_TRUE(engine::damps_implicitly(scene));
  World world = make_world(scene);
  run(world, 200);
  for (int n = 0; n < 20; ++n) {
    world.step();
    EXPECT_NEAR(world.velocity(1).x(), 0.0, 1e-9);
    EXPECT_NEAR(world.tension_of(0), 0.0, 1e-6);
  }
}

/// It is carried along by a belt, and by one under a spring up to where that is stronger.
TEST(StiffFriction, OfADryContactCarriesWithoutRinging) {
  NetworkDescription scene = one_mass(with_friction(power_of_speed(5.0, 0.0)), 0.0, 1e-3);
  scene.mats[0].kind = engine::MatKind::kPort;
  World world = make_world(scene);
  for (int n = 0; n < 500; ++n) {
    world.impose_position(0, Vec3(0.2e-3 * n, 0.0, 0.0));
    world.step();
    if (n > 100) {
      ASSERT_NEAR(world.velocity(1).x(), 0.2, 1e-6) << n;
      ASSERT_NEAR(world.tension_of(0), 0.0, 1e-3) << n;
    }
  }
}

TEST(StiffFriction, BringDryFrictionToRestWhereItStopsAndHoldItThere) {
  // a power of 0: 2 N against any motion. From 3 m/s 1 kg stops after 1.5 s and 2.25 m.
  World world = make_world(one_mass(with_friction(power_of_speed(2.0, 0.0)), 3.0, 1e-3));
  run(world, 1000);
  EXPECT_NEAR(world.position(1).x(), 1.0 + 2.0, 1e-6);
  run(world, 1000);
  EXPECT_NEAR(world.position(1).x(), 1.0 + 2.25, 1e-6);
  const double stopped = world.position(1).x();

  world.set_external_force(1, Vec3(1.9, 0, 0));
  run(world, 1000);
  EXPECT_NEAR(world.position(1).x(), stopped, 1e-5);  // it holds
  EXPECT_NEAR(world.tension_of(0), 1.9, 1e-6);

  world.set_external_force(1, Vec3(5.0, 0, 0));
  const double held = world.position(1).x();
  run(world, 1000);
  EXPECT_NEAR(world.position(1).x() - held, 1.5, 5e-3);  // 3 m/s^2 for 1 s
}

TEST(StiffFriction, AreOfSecondOrder) {
  // a spring of 10 N/m against 50 (s/m)^3 N; 150 N s/m at 1 m/s: solved from 2 ms on
  const auto end = [](double step) {
    LinkState state = with_friction(power_of_speed(50.0, 3.0));
    state.stiffness = 10.0;
    World world = make_world(one_mass(state, 0.0, step));
    run(world, static_cast<int>(std::lround(1.0 / step)));
    return world.position(1).x();
  };
  const double truth = end(2e-5);

  EXPECT_LT(std::abs(end(1e-2) - truth), 1.3e-4);
  EXPECT_NEAR(std::log2((end(1e-2) - truth) / (end(5e-3) - truth)), 2.0, 0.1);
}

TEST(StiffFriction, InAChainAreSolvedTogether) {
  NetworkDescription scene = free_cluster(20, 0, 0.0, 1);
  scene.integrator = IntegratorKind::kLeapfrog;
  scene.state_machines = {
      Behaving().state(10.0, 5000.0).state_machine};  // Z' = 100 for two of 0.1 kg
  for (std::uint32_t i = 0; i + 1 < 20; ++i) scene.state_links.push_back({i, i + 1, 0, 0.0});
  World world = make_world(scene);
  const Vec3 momentum = world.momentum();
  run(world, 300);

  EXPECT_LT((world.momentum() - momentum).norm(), 1e-10);
  const double speed = momentum.x() / 20.0 / 0.1;
  for (std::uint32_t i = 0; i < 20; ++i)
    EXPECT_LT(std::abs(world.velocity(i).x()), 2.0 * std::abs(speed) + 0.2);
  EXPECT_LT(world.energy().total(), world.energy().largest);
}

TEST(StiffFriction, CannotBeFrozen) {
  NetworkDescription scene = one_mass(with_friction(power_of_speed(2.0, 0.0)), 3.0, 1e-3);
  scene.freeze_tolerance = 1e-6;
  EXPECT_TRUE(engine::refusal_of(scene).has_value());
  scene.integrator = IntegratorKind::kCordis;
  EXPECT_FALSE(engine::refusal_of(scene).has_value());
}

/// Bow friction [N] over the speed [m/s]: steep through 0, falling beyond 0.07 m/s.
Law bow_law(double force) {
  std::vector<double> speeds;
  std::vector<double> value;
  for (int i = -1000; i <= 1000; ++i) {
    const double speed = 1e-3 * i;
    speeds.push_back(speed);
    value.push_back(force * std::sqrt(200.0) * speed * std::exp(-100.0 * speed * speed + 0.5));
  }
  return engine::Table(speeds, value);
}

/// 60 masses of 84 mg, 100 Hz, drawn by a bow of 5 N at 0.1 m/s: while it sticks, 117 N s/m.
NetworkDescription bowed(IntegratorKind integrator, double rate_hz) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1.0 / rate_hz;
  scene.integrator = integrator;
  scene.mats.assign(62, mass(8.4e-5, Vec3::Zero()));
  scene.mats.front() = scene.mats.back() = fixed(Vec3::Zero());
  for (std::uint32_t i = 0; i < 61; ++i) scene.links.push_back({i, i + 1, 12490.0, 0.004, 0.0});
  scene.mats.push_back(mass(1e3, Vec3::Zero(), Vec3(0.1, 0, 0)));
  scene.state_machines = {Behaving().state(with_friction(bow_law(5.0))).state_machine};
  scene.state_links = {{8, 62, 0, 0.0}};
  return scene;
}

/// Where the string is under the bow and at two thirds, 200 times in 45 ms.
std::vector<double> waveform(IntegratorKind integrator, int per_sample_of_44100) {
  World world = make_world(bowed(integrator, 44100.0 * per_sample_of_44100));
  std::vector<double> wave;
  for (int i = 0; i < 200; ++i) {
    run(world, 10 * per_sample_of_44100);
    wave.push_back(world.position(8).x());
    wave.push_back(world.position(40).x());
  }
  return wave;
}

double relative_error(const std::vector<double>& wave, const std::vector<double>& truth) {
  double error = 0.0;
  double motion = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    error += (wave[i] - truth[i]) * (wave[i] - truth[i]);
    motion += truth[i] * truth[i];
  }
  return std::sqrt(error / motion);
}

TEST(StiffFriction, PlayABowAtAudioRatesWhereAnExplicitLawChatters) {
  const std::vector<double> truth =
      waveform(IntegratorKind::kCordis, 32);  // stable from 700 kHz on

  EXPECT_LT(relative_error(waveform(IntegratorKind::kLeapfrog, 1), truth), 0.05);
  EXPECT_LT(relative_error(waveform(IntegratorKind::kLeapfrog, 4), truth), 0.01);
  EXPECT_GT(relative_error(waveform(IntegratorKind::kCordis, 4), truth), 0.5);
}

TEST(StiffFriction, KeepTheAccountOfABow) {
  const auto residual = [](int per_sample) {
    World world = make_world(bowed(IntegratorKind::kLeapfrog, 44100.0 * per_sample));
    run(world, 500 * per_sample);
    const engine::Energy energy = world.energy();
    return std::abs(energy.residual()) / energy.dissipated;
  };

  EXPECT_LT(residual(4), 1e-2);
}

TEST(StiffFriction, AreTheSameAtEveryVectorWidth) {
  std::vector<std::uint64_t> hashes;
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(bowed(IntegratorKind::kLeapfrog, 44100.0), width);
    run(world, 500);
    hashes.push_back(world.state_hash());
  }

  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

TEST(StiffFriction, GoOnFromASnapshotBitForBitWithoutAllocating) {
  World first = make_world(bowed(IntegratorKind::kLeapfrog, 44100.0));
  run(first, 101);
  World second = make_world(bowed(IntegratorKind::kLeapfrog, 44100.0));
  second.restore(first.snapshot());
  const AllocationGuard guard;
  run(first, 50);
  run(second, 50);

  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(first.state_hash(), second.state_hash());
}

TEST(StiffFriction, AreChosenAnewWhenAStateMachineIsReplaced) {
  World world = make_world(one_mass(with_friction(power_of_speed(0.1, 1.0)), 1.0, 1.0));
  world.replace_state_machine(
      0, Behaving().state(with_friction(power_of_speed(9.0, 1.0))).state_machine);
  run(world, 200);

  EXPECT_LT(std::abs(world.velocity(1).x()), 1e-6);  // extrapolated it would diverge from 1 on
}

TEST(StiffFriction, AreThoseBeyondThreeTenthsTogether) {
  NetworkDescription scene = one_mass({}, 0.0, 1.0);
  scene.state_machines = {Behaving().state(0.0, 3.0).state_machine,
                          Behaving().state(with_friction(power_of_speed(1.0, 0.5))).state_machine,
                          Behaving().state(5.0).state_machine};
  scene.state_links = {{0, 1, 0, 0.0}, {0, 1, 0, 0.0}, {0, 1, 1, 0.0}, {0, 1, 2, 0.0}};
  const std::vector<double> steps = engine::largest_extrapolated_steps(scene);

  EXPECT_DOUBLE_EQ(steps[0], 0.05);  // 0.3 / (3 + 3)
  EXPECT_DOUBLE_EQ(steps[1], 0.05);
  EXPECT_EQ(steps[2], 0.0);
  EXPECT_TRUE(std::isinf(steps[3]));
}

}  // namespace
}  // namespace cordis::test::stiff
