// tests/engine/friction_test.cpp -- contacts of sets that stick and slide.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/pairs/set_pairs.h"
#include "tests/engine/programs.h"
#include "tests/engine/rubbing.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::Friction;
using engine::IntegratorKind;
using engine::Snapshot;

struct StickSlip {
  double load, static_coefficient, kinetic_coefficient, mass, stiffness, speed;
  double slip_time, period, longest, shortest, taken;
};

/// A belt of this speed under a block on a spring, seen by who stands on the belt: the spring is drawn. The
/// figures are the closed form of stick and slip: stick 2 D / V, slip (2 / w) (pi - atan(D w / V)), with
/// D = (Fs - Fk) / K.
class Belt : public testing::TestWithParam<StickSlip> {};

TEST_P(Belt, SticksAndSlipsAsItsClosedForm) {
  const StickSlip expected = GetParam();
  constexpr double kTangential = 1e6;
  constexpr double kStep = 2e-5;
  const Friction friction{expected.static_coefficient, expected.kinetic_coefficient, kTangential,
                          300.0};
  NetworkDescription scene = pressed_ball(expected.load, friction, 1e5, 100.0, kStep);
  scene.mats[0].mass = expected.mass;
  const double height = scene.mats[0].position.y();
  scene.mats.push_back(port(Vec3(1.0, height, 0.0)));
  scene.radius.push_back(0.0);
  scene.links = {{0, 2, expected.stiffness, 0.0, 1.0}};
  World world = make_world(scene);
  world.set_external_force(0, Vec3(0.0, -expected.load, 0.0));

  double time = 0.0;
  double longest = -1.0;
  double shortest = 1.0;
  double slip_began = 0.0;
  double slip_ended = 0.0;
  double taken_before = 0.0;
  std::vector<double> periods;
  std::vector<double> slips;
  std::vector<double> taken;
  bool slipped = false;
  const double fast = 0.06 * expected.speed;
  while (time < 6.5 * expected.period) {
    time += kStep;
    world.impose_position(2, Vec3(1.0 + expected.speed * time, height, 0.0));
    world.step();
    const bool slips_now = world.velocity(0).x() > fast;
    if (slips_now && !slipped) {
      const double dissipated = world.energy().dissipated;
      if (slip_began > 0.0) {
        periods.push_back(time - slip_began);
        taken.push_back(dissipated - taken_before);
      }
      slip_began = time;
      taken_before = dissipated;
    }
    if (!slips_now && slipped) {
      slip_ended = time;
      slips.push_back(slip_ended - slip_began);
    }
    slipped = slips_now;
    if (periods.empty()) continue;
    const double elongation = world.position(2).x() - world.position(0).x() - 1.0;
    longest = std::max(longest, elongation);
    shortest = std::min(shortest, elongation);
  }

  ASSERT_GE(periods.size(), 4u);
  // The contact gives by Fk / 1e6 N/m, and a slip below `fast` is not seen: v = (Fs - Fk) t / m.
  const double give = expected.load * expected.static_coefficient / kTangential;
  const double force = expected.load * (expected.static_coefficient - expected.kinetic_coefficient);
  const double unseen = 2.0 * fast * expected.mass / force;
  for (std::size_t i = 1; i < periods.size(); ++i) {
    EXPECT_NEAR(periods[i], expected.period, 2e-3 * expected.period);
    EXPECT_NEAR(slips[i] + unseen, expected.slip_time, 2e-3 * expected.period);
    EXPECT_NEAR(taken[i], expected.taken, 2e-3 * expected.taken);
  }
  EXPECT_NEAR(longest, expected.longest, 4.0 * give);
  EXPECT_NEAR(shortest, expected.shortest, 4.0 * give);
}

INSTANTIATE_TEST_SUITE_P(
    Friction, Belt,
    testing::Values(StickSlip{10.0, 0.5, 0.3, 1.0, 100.0, 0.1, 0.40688878715914055,
                              0.80688878715914055, 0.052360679774997897, 0.0076393202250021030,
                              0.24206663614774216},
                    StickSlip{10.0, 0.8, 0.2, 0.2, 500.0, 0.3, 0.081377757431828109,
                              0.16137775743182811, 0.017416407864998738, -0.0094164078649987382,
                              0.096826654459096866}));

TEST(Friction, HoldsABlockOnAnInclineInItsPlace) {
  for (const double mu : {0.2, 0.5, 1.0}) {
    const double angle = std::atan(0.98 * mu);
    World world = make_world(block_on_incline(angle, {mu, 0.8 * mu, 1e5, 200.0}));
    for (int n = 0; n <= 20000;
         ++n) {  // set down slowly: let go at once it would swing to twice that
      const double held = std::max(0.0, 1.0 - n / 10000.0);
      world.set_external_force(0, Vec3(-held * kGravity * std::sin(angle), 0.0, 0.0));
      world.step();
    }
    const Vec3 rest = world.position(0);
    EXPECT_NEAR(rest.x(), kGravity * std::sin(angle) / 1e5, 1e-9) << mu;  // K s = m g sin a
    run(world, rounds(1'000'000));
    EXPECT_NEAR(world.position(0).x(), rest.x(), 1e-9) << mu;
    EXPECT_NEAR(world.position(0).y(), rest.y(), 1e-9) << mu;
  }
}

TEST(Friction, StopsABlockThatSlidesDownAndHoldsIt) {
  for (const double mu : {0.2, 0.5, 1.0}) {
    const double angle = std::atan(0.9 * mu);
    NetworkDescription scene = block_on_incline(angle, {mu, mu, 1e5, 200.0});
    scene.mats[0].velocity = Vec3(0.1, 0.0, 0.0);
    World world = make_world(scene);
    run(world, 50000);
    const Vec3 rest = world.position(0);
    const double slower = kGravity * (mu * std::cos(angle) - std::sin(angle));
    EXPECT_NEAR(rest.x(), 0.1 * 0.1 / (2.0 * slower), 1e-4) << mu;
    run(world, 100'000);
    EXPECT_NEAR(world.position(0).x(), rest.x(), 1e-9) << mu;
  }
}

TEST(Friction, LetsABlockSlideWithTheAccelerationThatIsLeft) {
  for (const double mu : {0.2, 0.5, 1.0}) {
    const double angle = std::atan(1.3 * mu);
    World world = make_world(block_on_incline(angle, {mu, 0.8 * mu, 1e5, 200.0}));
    run(world, 5000);
    const double before = world.velocity(0).x();
    run(world, 5000);
    const double acceleration = (world.velocity(0).x() - before) / 0.5;
    const double expected = kGravity * (std::sin(angle) - 0.8 * mu * std::cos(angle));
    EXPECT_NEAR(acceleration, expected, 1e-9 * kGravity) << mu;
  }
}

/// A block of 0.02 kg on the floor that presses with 0.2 N, on a spring of 10 N/m to a wall; its place
/// is 0 where the spring is at rest.
struct SpringBlock {
  double damper;  // beside the spring [N s/m]
  double start;   // from where it is let go, at rest [m]
  Friction friction;
};

constexpr double kBlockMass = 0.02;
constexpr double kBlockLoad = 0.2;
constexpr double kBlockSpring = 10.0;

/// @return where it is after a time [m]
double place_at(double time, const SpringBlock& block, double rate) {
  NetworkDescription scene = pressed_ball(kBlockLoad, block.friction, 2000.0, 2.0, 1.0 / rate);
  scene.gravity = Vec3(0.0, -kBlockLoad / kBlockMass, 0.0);
  scene.mats[0].mass = kBlockMass;
  scene.mats[0].position.x() = block.start;
  scene.mats.push_back(fixed(Vec3(-1.0, scene.mats[0].position.y(), 0.0)));
  scene.radius.push_back(0.0);
  scene.links = {{2, 0, kBlockSpring, block.damper, 1.0}};
  World world = make_world(scene);
  run(world, static_cast<int>(time * rate));
  return world.position(0).x();
}

/// In closed form: half swings about the places where the spring carries the kinetic friction, each smaller
/// than the one before; it stays at the first end of one where the static friction carries the spring. [m]
double stays_at(const SpringBlock& block) {
  const double least = kBlockLoad * block.friction.kinetic_coefficient / kBlockSpring;
  const double most = kBlockLoad * block.friction.static_coefficient / kBlockSpring;
  const double ratio = 0.5 * block.damper / std::sqrt(kBlockSpring * kBlockMass);
  const double smaller = std::exp(-std::numbers::pi * ratio / std::sqrt(1.0 - ratio * ratio));
  double place = block.start;
  while (std::abs(place) > most) {
    const double side = place > 0.0 ? 1.0 : -1.0;
    place = -side * ((std::abs(place) - least) * smaller - least);
  }
  return place;
}

constexpr double kAllRates[] = {5000.0, 7000.0, 10000.0, 20000.0, 50000.0};
constexpr std::span kRates = std::span(kAllRates).first<rounds(5)>();
constexpr double kFrictionStiffness[] = {2e4, 6e4, 2e5};

TEST(Friction, StopsABlockOnASpringWhereTheClosedFormDoes) {
  for (const auto& [kinetic, start] :
       {std::pair(0.0, 0.0115), std::pair(0.0, -0.035), std::pair(0.05, 0.0125),
        std::pair(0.05, -0.04), std::pair(0.25, 0.025), std::pair(0.25, -0.066)}) {
    for (const double stiffness : kFrictionStiffness) {
      const SpringBlock block{0.3, start, {0.5, kinetic, stiffness, 1.0}};
      const double expected = stays_at(block);
      for (const double rate : kRates) {
        EXPECT_NEAR(place_at(1.5, block, rate), expected, 1e-4)
            << kinetic << ' ' << start << ' ' << stiffness << ' ' << rate;
      }
    }
  }
}

TEST(Friction, HoldsMostOfItsLimitWhereItsDamperIsCritical) {
  for (const auto& [kinetic, start] : {std::pair(0.05, 0.023), std::pair(0.25, -0.0185)}) {
    for (const double stiffness : kFrictionStiffness) {
      const double critical = 2.0 * std::sqrt(stiffness * kBlockMass);
      const SpringBlock block{0.02, start, {0.5, kinetic, stiffness, critical}};
      const double expected = stays_at(block);
      const double share = std::abs(expected) * kBlockSpring / (0.5 * kBlockLoad);
      EXPECT_NEAR(share, 0.77, 0.02) << "of the limit is held";
      for (const double rate : {20000.0, 50000.0}) {
        EXPECT_NEAR(place_at(1.5, block, rate), expected, 1e-4)
            << kinetic << ' ' << stiffness << ' ' << rate;
      }
    }
  }
}

TEST(Friction, StopsABlockOnASpringAtTheSamePlaceAtEveryRate) {
  for (const double kinetic : {0.0, 0.05, 0.25}) {
    const double expected = place_at(3.5, {0.02, 0.015, {0.5, kinetic, 2e5, 1.0}}, 50000.0);
    EXPECT_GT(std::abs(expected), 0.004) << kinetic;
    for (const double stiffness : kFrictionStiffness) {
      const SpringBlock block{0.02, 0.015, {0.5, kinetic, stiffness, 1.0}};
      for (const double rate : kRates) {
        EXPECT_NEAR(place_at(3.5, block, rate), expected, 1e-4)
            << kinetic << ' ' << stiffness << ' ' << rate;
      }
    }
  }
}

TEST(Friction, YieldsWhereTheForcePassesItsLimit) {
  const Friction friction{0.6, 0.4, 1e5, 300.0};
  for (const bool passes : {false, true}) {
    World world = make_world(pressed_ball(20.0, friction, 1e5, 100.0, 1e-4));
    const double draw = passes ? 12.0 * 1.001 : 12.0 * 0.999;
    for (int n = 0; n < 40000; ++n) {
      world.set_external_force(0, Vec3(draw * std::min(1.0, n / 20000.0), -20.0, 0.0));
      world.step();
    }
    if (!passes) {
      EXPECT_NEAR(world.position(0).x(), draw / 1e5, 1e-8);
      EXPECT_NEAR(world.link_force(0).x(), -draw, 1e-4);
      continue;
    }
    EXPECT_GT(world.velocity(0).x(), 1.0);
    EXPECT_NEAR(world.link_force(0).x(), -8.0, 1e-9);
    // and it comes to rest again, without that force
    world.set_external_force(0, Vec3(0.0, -20.0, 0.0));
    const Vec3 here = world.position(0);
    const double speed = world.velocity(0).x();
    run(world, 40000);
    EXPECT_NEAR(world.velocity(0).x(), 0.0, 1e-9);
    EXPECT_NEAR(world.position(0).x() - here.x(), speed * speed / (2.0 * 8.0), 1e-3);
  }
}

TEST(Friction, ForgetsWhatItHeldWhereNothingPresses) {
  World world = make_world(pressed_ball(20.0, {0.6, 0.4, 1e5, 300.0}, 1e5, 100.0, 1e-4));
  world.set_external_force(0, Vec3(10.0, -20.0, 0.0));
  run(world, 5000);
  EXPECT_GT(world.position(0).x(), 5e-5);
  world.set_external_force(0, Vec3(0.0, 20.0, 0.0));
  run(world, 200);
  const double speed = world.velocity(0).x();
  run(world, 200);
  EXPECT_EQ(world.link_force(0), Vec3::Zero());
  EXPECT_NEAR(world.velocity(0).x(), speed, 1e-12);
}

TEST(Friction, GraspsWithoutSlidingAndWithSliding) {
  constexpr double kStiffness = 2e4;
  constexpr double kSqueeze = 10.0;  // [N] of each finger: both together hold 2 mu 10 N = 10 N
  for (const double weight : {8.0, 12.0}) {
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = 1e-4;
    scene.gravity = Vec3(0.0, -kGravity, 0.0);
    const double apart = 2.0 * kRadius - kSqueeze / kStiffness;
    scene.mats = {mass(weight / kGravity, Vec3::Zero()), port(Vec3(-apart, 0.0, 0.0)),
                  port(Vec3(apart, 0.0, 0.0))};
    scene.radius = {kRadius, kRadius, kRadius};
    scene.state_machines = {rubbing(contact(kStiffness, 20.0), {0.5, 0.5, kStiffness, 50.0})};
    scene.sets = {{0, {0}, {1, 2}, 0.1, -1.0}};
    World world = make_world(scene);
    for (int n = 1; n <= 20000; ++n) {
      const double t = std::min(1.0, n / 10000.0);
      const double height = 0.1 * t * t * (3.0 - 2.0 * t);  // carried up by 10 cm
      world.impose_position(1, Vec3(-apart, height, 0.0));
      world.impose_position(2, Vec3(apart, height, 0.0));
      // it is handed over slowly
      const double held = std::max(0.0, 1.0 - n / 2000.0);
      world.set_external_force(0, Vec3(0.0, held * weight, 0.0));
      world.step();
    }
    if (weight < 2.0 * 0.5 * kSqueeze) {
      EXPECT_NEAR(world.position(0).y(), 0.1 - weight / (2.0 * kStiffness), 1e-5);
    } else {
      EXPECT_LT(world.position(0).y(), -0.05);  // it has slid out
    }
  }
}

/// A heap of balls on a floor, each in the gap of two below it: rows of 4, 3, 2 and 1.
NetworkDescription heap(double mu) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.gravity = Vec3(0.0, -kGravity, 0.0);
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < 4 - row; ++i) {
      const double x = kRadius * (2.0 * i + row);
      scene.mats.push_back(mass(0.1, Vec3(x, kRadius * (1.0 + std::sqrt(3.0) * row), 0.0)));
      scene.radius.push_back(kRadius);
    }
  }
  const auto count = static_cast<std::uint32_t>(scene.mats.size());
  const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
  const StateMachine pair = rubbing(contact(1e4, 5.0), {mu, mu, 1e4, 5.0});
  touch(scene, count, pair, kRadius, -1.0, {floor});
  SetLiaison within;
  within.range = 2.0 * kRadius;
  within.rest_length = -1.0;
  for (std::uint32_t i = 0; i < count; ++i) within.set_p.push_back(i);
  scene.sets.push_back(within);
  return scene;
}

TEST(Friction, LetsAHeapStand) {
  const double height = heap(0.8).mats[9].position.y();
  World standing = make_world(heap(0.8));
  run(standing, 20000);
  const engine::Columns rest = standing.positions();
  EXPECT_NEAR(standing.position(9).y(), height, 0.05 * kRadius);
  run(standing, rounds(200'000));
  EXPECT_LT((standing.positions() - rest).cwiseAbs().maxCoeff(), 1e-9);
  World falling = make_world(heap(0.05));
  run(falling, 20000);
  EXPECT_LT(falling.position(9).y(), height - kRadius);
}

TEST(Friction, KeepsTheMomentumOfFreeBalls) {
  NetworkDescription scene = rubbing_cloud(3, 5);
  scene.sets.pop_back();
  World world = make_world(scene);
  const Vec3 before = world.momentum();
  const Vec3 turning = world.angular_momentum();
  run(world, 3000);
  EXPECT_LT((world.momentum() - before).norm(), 1e-12);
  EXPECT_GT((world.angular_momentum() - turning).norm(), 1e-6);  // balls do not turn
}

TEST(Friction, ClosesTheAccountAndOnlyTakesEnergy) {
  for (unsigned seed = 1; seed <= 12; seed += kSeedStride) {
    World world = make_world(rubbing_cloud(2 + static_cast<int>(seed % 2), seed, seed > 6));
    double taken = 0.0;
    for (int n = 0; n < 4000; ++n) {
      world.step();
      const Energy energy = world.energy();
      ASSERT_NEAR(energy.residual(), 0.0, 1e-12 * energy.largest) << seed << " step " << n;
      // The last half period is not whole: what is taken may fall by what a spring takes up in it.
      ASSERT_GT(energy.dissipated, taken - 1e-3 * energy.initial) << seed << " step " << n;
      taken = std::max(taken, energy.dissipated);
    }
    EXPECT_GT(taken, 0.5 * world.energy().initial) << seed;
  }
}

TEST(Friction, IsTheSameBitsAtEveryVectorWidth) {
  for (const bool states : {false, true}) {
    std::vector<std::uint64_t> hashes;
    for (const VectorWidth width : engine::supported_vector_widths()) {
      World world = make_world(rubbing_cloud(3, 3, states), width);
      run(world, 2000);
      hashes.push_back(world.state_hash());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
  }
}

TEST(Friction, GoesOnFromASnapshot) {
  for (const bool states : {false, true}) {
    World world = make_world(rubbing_cloud(3, 7, states));
    run(world, 1000);
    const Snapshot snapshot = world.snapshot();
    World other = make_world(rubbing_cloud(3, 7, states));
    other.restore(snapshot);
    EXPECT_EQ(other.state_hash(), world.state_hash());
    for (int n = 0; n < 500; ++n) {
      world.step();
      other.step();
      ASSERT_EQ(other.state_hash(), world.state_hash()) << n;
    }
    EXPECT_EQ(other.energy().dissipated, world.energy().dissipated);
    Snapshot cut = snapshot;
    cut.state.pop_back();
    EXPECT_THROW(other.restore(cut), std::invalid_argument);
  }
}

TEST(Friction, StepsWithoutAllocating) {
  World world = make_world(rubbing_cloud(3, 9));
  run(world, 3);
  const AllocationGuard guard;
  run(world, 200);
  EXPECT_EQ(guard.count(), 0u);
}

/// A sheet of points, fixed or driven, far above many balls that do not touch; at half a millisecond a driven
/// one is among them.
NetworkDescription sheet_above_balls(bool driven) {
  constexpr std::uint32_t kPoints = 100;
  constexpr std::uint32_t kBalls = 1000;
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-4;
  SetLiaison set;
  set.range = 0.1;
  set.rest_length = 0.1;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    scene.mats.push_back(fixed(Vec3(1e-4 * (i % 10), 1e-4 * (i / 10), 10.0)));
    set.set_p.push_back(i);
  }
  for (std::uint32_t i = 0; i < kBalls; ++i) {
    scene.mats.push_back(mass(1.0, 1e-3 * Vec3(i % 10, i / 10 % 10, i / 100)));
    set.set_q.push_back(kPoints + i);
  }
  scene.state_machines = {rubbing(contact(1.0, 0.0), {0.5, 0.4, 1.0, 0.0})};
  scene.sets = {set};
  if (!driven) return scene;
  engine::TimeFunction falls;
  falls.time = {4e-4, 5e-4};
  falls.value = {Vec3::Zero(), Vec3(0.0, 0.0, -9.99)};
  scene.time_functions = {falls};
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    engine::Drive drive;
    drive.mat = i;
    drive.origin = scene.mats[i].position;
    scene.drives.push_back(drive);
    scene.mats[i].kind = MatKind::kPort;
  }
  return scene;
}

TEST(Friction, KeepsNoRoomForContactsThatDrivenPointsDoNotHave) {
  const auto room_of = [](const NetworkDescription& scene) {
    const engine::StateTable table(scene.state_machines, scene.step, false);
    engine::SetPairs pairs(scene, 0, table, engine::pair_kernel(engine::best_vector_width()));
    std::vector<double> position;
    for (const Mat& mat : scene.mats) {
      position.insert(position.end(), {mat.position.x(), mat.position.y(), mat.position.z(), 0.0});
    }
    pairs.make_room(position.data());
    return pairs.contact_room();
  };
  EXPECT_EQ(room_of(sheet_above_balls(true)), room_of(sheet_above_balls(false)));
}

TEST(Friction, IsRememberedOfAllContactsThatBeginInOneStep) {
  World world = make_world(sheet_above_balls(true));
  for (int n = 0; n < 20; ++n) {
    const engine::StepReport report = world.step();
    ASSERT_EQ(report.forgotten_pairs, 0u) << n;
    if (report.wants_room) world.make_room();
  }
  EXPECT_EQ(world.position(0).z(), 10.0 - 9.99);
  EXPECT_GT(world.energy().elastic, 0.0);
}

TEST(Friction, TakesOtherParametersWhileItHolds) {
  World world = make_world(block_on_incline(0.3, {1.0, 0.8, 1e5, 200.0}));
  run(world, 20000);
  StateMachine softer = world.network().description().state_machines[0];
  softer.friction.stiffness = 5e4;
  world.replace_state_machine(0, softer);
  run(world, 20000);
  EXPECT_NEAR(world.position(0).x(), kGravity * std::sin(0.3) / 5e4, 1e-9);
  EXPECT_NEAR(world.energy().residual(), 0.0, 1e-12);
  softer.friction = {};
  EXPECT_THROW(world.replace_state_machine(0, softer), std::invalid_argument);
}

/// A block that an incline holds: its stretch carries the weight along the slope.
NetworkDescription standing_block(double angle) {
  NetworkDescription scene = block_on_incline(angle, {1.0, 0.8, 1e5, 200.0});
  scene.sets[0].stretches = {{0, 1, false, Vec3(kGravity * std::sin(angle) / 1e5, 0.0, 0.0)}};
  return scene;
}

TEST(Friction, HoldsFromTheStartWhatItIsSaidToHold) {
  const NetworkDescription scene = standing_block(0.6);
  const Vec3 start = scene.mats[0].position;
  World world = make_world(scene);
  run(world, rounds(200'000));
  EXPECT_LT((world.position(0) - start).norm(),
            1e-15);  // rounding of the forces, 1e-15 N, over 1e5 N/m
  const std::vector<engine::StartStretch> end = world.contact_stretches(0);
  ASSERT_EQ(end.size(), 1u);
  EXPECT_EQ(end[0].member_a, 0u);
  EXPECT_EQ(end[0].member_b, 1u);
  EXPECT_FALSE(end[0].slides);
  EXPECT_NEAR(end[0].stretch.x(), kGravity * std::sin(0.6) / 1e5, 1e-15);
  // weight and springs: (m g cos a)^2 / 2 K + (m g sin a)^2 / 2 K, with the same K
  const Energy energy = world.energy();
  EXPECT_NEAR(energy.elastic, 0.5 * kGravity * kGravity / 1e5, 1e-15);
  EXPECT_NEAR(energy.residual(), 0.0, 1e-15);
  EXPECT_NE(world.network().fingerprint(),
            make_world(block_on_incline(0.6, {1.0, 0.8, 1e5, 200.0})).network().fingerprint());
}

/// A world that goes on from where another one is, with the friction of its contacts.
NetworkDescription going_on(const World& world) {
  NetworkDescription scene = world.network().description();
  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
    scene.mats[i].position = world.position(i);
    if (scene.mats[i].kind == engine::MatKind::kMass) scene.mats[i].velocity = world.velocity(i);
  }
  for (std::size_t s = 0; s < scene.sets.size(); ++s)
    scene.sets[s].stretches = world.contact_stretches(s);
  return scene;
}

TEST(Friction, ClosesTheAccountFromContactsOfTheStart) {
  std::size_t contacts = 0;
  for (unsigned seed = 1; seed <= 12; seed += kSeedStride) {
    World before = make_world(rubbing_cloud(2 + static_cast<int>(seed % 2), seed, seed > 6));
    run(before, 1500);
    const NetworkDescription scene = going_on(before);
    for (const SetLiaison& set : scene.sets) contacts += set.stretches.size();
    std::vector<std::uint64_t> hashes;
    for (const VectorWidth width : engine::supported_vector_widths()) {
      World world = make_world(scene, width);
      for (int n = 0; n < 1000; ++n) {
        world.step();
        const Energy energy = world.energy();
        ASSERT_NEAR(energy.residual(), 0.0, 1e-12 * energy.largest) << seed << " step " << n;
      }
      hashes.push_back(world.state_hash());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]) << seed;
  }
  EXPECT_GT(contacts, 100u / kSeedStride);
}

TEST(Friction, RefusesContactsOfTheStartThatAreNone) {
  using engine::StartStretch;
  const auto refuses = [](const auto& spoil) {
    NetworkDescription scene = standing_block(0.3);
    spoil(scene, scene.sets[0].stretches);
    EXPECT_THROW(make_world(scene), std::invalid_argument);
  };
  EXPECT_NO_THROW(make_world(standing_block(0.3)));
  refuses([](auto& scene, auto& /*all*/) { scene.state_machines[0].friction = {}; });
  refuses([](auto& /*scene*/, auto& all) { all[0].member_a = 1; });
  refuses([](auto& /*scene*/, auto& all) { all[0].member_b = 0; });
  refuses([](auto& /*scene*/, auto& all) { all[0].member_b = 2; });
  refuses([](auto& /*scene*/, auto& all) { all[0].stretch.x() = kNan; });
  refuses([](auto& /*scene*/, auto& all) { all[0].stretch.z() = 1.0; });
  refuses([](auto& /*scene*/, auto& all) { all.push_back(all[0]); });
}

TEST(Friction, IsRefusedWhereItDoesNotAct) {
  const NetworkDescription good = block_on_incline(0.1, {0.5, 0.4, 1e4, 1.0});
  const auto refuses = [&](const auto& spoil) {
    NetworkDescription scene = good;
    spoil(scene);
    EXPECT_THROW(make_world(scene), std::invalid_argument);
  };
  EXPECT_NO_THROW(make_world(good));
  refuses([](auto& scene) { scene.state_machines[0].friction.kinetic_coefficient = 0.6; });
  refuses([](auto& scene) { scene.state_machines[0].friction.kinetic_coefficient = -0.1; });
  refuses([](auto& scene) { scene.state_machines[0].friction.static_coefficient = kNan; });
  refuses([](auto& scene) { scene.state_machines[0].friction.stiffness = -1.0; });
  refuses([](auto& scene) { scene.state_machines[0].friction.viscosity = -1.0; });
  refuses([](auto& scene) { scene.integrator = IntegratorKind::kLeapfrog; });
  refuses([](auto& scene) { scene.integrator = IntegratorKind::kSymplectic4; });
  refuses([](auto& scene) { scene.integrator = IntegratorKind::kImplicit; });
  refuses([](auto& scene) { scene.freeze_tolerance = 1e-6; });
  refuses([](auto& scene) {
    scene.mats.push_back(fixed(Vec3(1.0, 1.0, 0.0)));
    scene.radius.push_back(0.0);
    scene.state_links = {{0, 2, 0, 1.0}};
  });
  refuses([](auto& scene) {
    scene.dimension = 1;
    scene.gravity = Vec3::Zero();
    scene.mats[0].position = Vec3::Zero();
    scene.surfaces[0].axis = Vec3::UnitX();
  });
}

}  // namespace
}  // namespace cordis::test
