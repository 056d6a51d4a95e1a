// tests/sim/device_exchange_test.cpp
#include "sim_node/devices/device_exchange.h"

#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

namespace cordis::sim {
namespace {

using engine::Vec3;

constexpr std::uint32_t kDevice = 9;
constexpr std::uint64_t kEpoch = 1000;
constexpr double kStiffness = 50.0;  // [N/m]
constexpr double kRate = 1000.0;     // [Hz]

/// A port mass (0) held by a spring and a damper to a fixed point (1), along x, and a free mass
/// (2).
engine::World world_with_a_port(double viscosity = 0.0) {
  engine::NetworkDescription network;
  network.dimension = 3;
  network.step = 1e-3;
  network.mats.resize(3);
  network.mats[0].kind = engine::MatKind::kPort;
  network.mats[0].position = Vec3(1.0, 0.0, 0.0);
  network.mats[1].kind = engine::MatKind::kFixed;
  network.mats[2].mass = 0.5;
  network.mats[2].position = Vec3(0.0, 1.0, 0.0);
  network.links.push_back({0, 1, kStiffness, viscosity, 1.0});
  return engine::World(std::make_shared<const engine::Network>(network));
}

scene::Port port_at(std::uint32_t mat, const Vec3& rest, std::uint32_t axis,
                    const Vec3& direction) {
  scene::Port port;
  port.mat = mat;
  port.rest = rest;
  port.axes = {axis};
  port.directions = {direction};
  return port;
}

DeviceExchange mass_exchange() {
  return {"key", kDevice, Role::kMass, {port_at(0, Vec3(1.0, 0.0, 0.0), 1, Vec3::UnitX())},
          kRate, 77};
}

msg::GesturePositions sample_at(std::uint64_t number, double position) {
  msg::GesturePositions sample;
  sample.device_id(kDevice);
  sample.epoch(kEpoch);
  sample.sample(number);
  sample.time_nsec(static_cast<std::int64_t>(number) * 1'000'000);
  sample.axis_count(2);
  sample.position_m().fill(0.0);
  sample.position_m()[1] = position;
  return sample;
}

/// Plays ticks in which the device repeats one position until it has taken over.
std::uint64_t settle(DeviceExchange& exchange, engine::World& world, double position,
                     int sub_steps = 1) {
  std::uint64_t number = 0;
  for (int tick = 0; tick < 150; ++tick) {
    exchange.receive(sample_at(++number, position));
    exchange.begin_tick();
    for (int j = 1; j <= sub_steps; ++j) {
      exchange.play(world, j, static_cast<double>(j) / sub_steps);
      world.step();
    }
  }
  return number;
}

TEST(DeviceExchange, ADeviceThatIsSupportedAtLastIsNotAnsweredUntilItsGuardHasLetGo) {
  DeviceExchange device("key", 9, Role::kMass, {}, 1000.0, 1);
  msg::GesturePositions sample;
  sample.epoch(5);
  sample.axis_count(1);
  std::uint64_t number = 0;
  const auto tick = [&](bool is_supported) {
    sample.sample(++number);
    device.receive(sample, is_supported);
    device.begin_tick();
  };
  tick(true);
  EXPECT_FALSE(device.is_restarting()) << "it was never refused";
  for (int n = 0; n < 200; ++n) tick(false);
  tick(true);
  EXPECT_FALSE(device.is_restarting()) << "it was refused for a moment";
  for (int n = 0; n < 300; ++n) tick(false);
  EXPECT_TRUE(device.is_disconnected());
  EXPECT_FALSE(device.is_silent()) << "it is answered on arrival, and measured";
  EXPECT_FALSE(device.is_restarting());

  int ticks = 0;
  tick(true);
  while (device.is_restarting() && ticks < 1000) {
    tick(true);
    ++ticks;
  }

  EXPECT_EQ(ticks, 250);
  for (int n = 0; n < 22; ++n) device.begin_tick();
  EXPECT_TRUE(device.is_silent());
}

TEST(DeviceExchange, KeepsThePlaceOfADescribedProcessForASecond) {
  DeviceExchange device("key", 9, Role::kMass, {}, 1000.0, 1);
  EXPECT_FALSE(device.is_described());
  msg::GesturePositions sample;
  sample.epoch(5);
  sample.axis_count(1);
  sample.sample(1);
  device.receive(sample, /*is_supported=*/false);
  device.record_described();
  EXPECT_TRUE(device.is_described()) << "it waits for the next tick";
  for (int n = 0; n < 999; ++n) device.begin_tick();
  EXPECT_TRUE(device.is_described());
  DeviceExchange of_next_scene("key", 9, Role::kMass, {}, 1000.0, 1);
  of_next_scene.take_over(device, /*at_once=*/false);
  EXPECT_TRUE(of_next_scene.is_described());
  of_next_scene.begin_tick();
  EXPECT_FALSE(of_next_scene.is_described());
}

TEST(DeviceExchange, AnswersAPositionWithTheForceOfTheLinksAtThatPosition) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  const std::uint64_t number = settle(exchange, world, 0.02);

  const msg::GestureForces& answer = exchange.answer_forces(world, true, 5);

  // The spring is 0.02 m longer than at rest and pulls the port back: no delay, the force of this
  // very position.
  EXPECT_NEAR(answer.force_n()[1], -kStiffness * 0.02, 1e-12);
  EXPECT_EQ(answer.force_n()[0], 0.0);
  EXPECT_EQ(answer.device_id(), kDevice);
  EXPECT_EQ(answer.epoch(), 77u);
  EXPECT_EQ(answer.answered_epoch(), kEpoch);
  EXPECT_EQ(answer.answered_sample(), number);
  EXPECT_EQ(answer.answered_time_nsec(), static_cast<std::int64_t>(number) * 1'000'000);
  EXPECT_EQ(answer.axis_count(), 2u);
}

TEST(DeviceExchange, RampsAPositionOverTheSubStepsAndAnswersAtItsEnd) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  const std::uint64_t number = settle(exchange, world, 0.0, 4);
  exchange.receive(sample_at(number + 1, 0.004));
  exchange.begin_tick();

  for (int j = 1; j <= 4; ++j) {
    exchange.play(world, j, j / 4.0);
    world.step();
    EXPECT_NEAR(world.position(0).x(), 1.0 + 0.001 * j, 1e-15);
  }
  EXPECT_NEAR(exchange.answer_forces(world, true, 0).force_n()[1], -kStiffness * 0.004, 1e-12);
}

TEST(DeviceExchange, KeepsTheWholeVirtualDampingOverSubSteps) {
  constexpr double kViscosity = 2.0;  // [N s/m]
  constexpr double kSpeed = 0.1;      // [m/s]
  for (const int sub_steps : {1, 4}) {
    engine::NetworkDescription network = world_with_a_port(kViscosity).network().description();
    network.step = 1e-3 / sub_steps;
    engine::World world(std::make_shared<const engine::Network>(network));
    DeviceExchange exchange = mass_exchange();
    std::uint64_t number = settle(exchange, world, 0.0, sub_steps);
    double position = 0.0;
    for (int tick = 0; tick < 10; ++tick) {
      position += kSpeed * 1e-3;
      exchange.receive(sample_at(++number, position));
      exchange.begin_tick();
      for (int j = 1; j <= sub_steps; ++j) {
        exchange.play(world, j, static_cast<double>(j) / sub_steps);
        world.step();
      }
    }
    EXPECT_NEAR(exchange.answer_forces(world, true, 0).force_n()[1],
                -kStiffness * position - kViscosity * kSpeed, 1e-9)
        << sub_steps << " sub-steps";
  }
}

TEST(DeviceExchange, GivesNoForceWhenTheSceneIsNotSafe) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  settle(exchange, world, 0.02);
  for (const double force : exchange.answer_forces(world, false, 0).force_n())
    EXPECT_EQ(force, 0.0);
}

TEST(DeviceExchange, TakesOverGraduallyFromADeviceThatWasAway) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  constexpr double kFar = 0.05;
  double before = 0.0;
  double largest_move = 0.0;
  std::uint64_t number = 0;
  for (int tick = 0; tick < 100; ++tick) {
    exchange.receive(sample_at(++number, kFar));
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
    largest_move = std::max(largest_move, std::abs(world.position(0).x() - 1.0 - before));
    before = world.position(0).x() - 1.0;
  }
  EXPECT_NEAR(before, kFar, 1e-15);      // the rounding of 1 + 0.05
  EXPECT_LT(largest_move, kFar / 99.0);  // 100 equal moves, not a jump
}

TEST(DeviceExchange, AnotherProcessOfTheDeviceTakesOverGradually) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  settle(exchange, world, 0.02);
  double force = exchange.answer_forces(world, true, 0).force_n()[1];
  double position = world.position(0).x() - 1.0;
  double largest_move = 0.0;
  double largest_rise = 0.0;
  for (std::uint64_t number = 1; number <= 100; ++number) {
    msg::GesturePositions sample = sample_at(number, 0.04);
    sample.epoch(kEpoch + 1);
    exchange.receive(sample);
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
    const double force_now = exchange.answer_forces(world, true, 0).force_n()[1];
    largest_rise = std::max(largest_rise, std::abs(force_now) - std::abs(force));
    largest_move = std::max(largest_move, std::abs(world.position(0).x() - 1.0 - position));
    force = force_now;
    position = world.position(0).x() - 1.0;
  }
  EXPECT_NEAR(position, 0.04, 1e-15);
  EXPECT_LT(largest_move, 0.02 / 99.0);
  EXPECT_NEAR(force, -kStiffness * 0.04, 1e-12);
  EXPECT_LT(largest_rise, 2.0 * kStiffness * 0.04 / 99.0) << "share and position grow together";
}

TEST(DeviceExchange, TakesOverGraduallyWhenTheSceneItselfStoodStill) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  const std::uint64_t before = settle(exchange, world, 0.0);

  // 50 samples of the device, 50 ms, went by unheard, and the hand by 20 mm.
  double last = 0.0;
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    exchange.receive(sample_at(before + 50 + tick, 0.02));
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
    const double position = world.position(0).x() - 1.0;
    EXPECT_LT(position - last, 0.02 / 99.0) << "within 0.1 s, tick " << tick;
    EXPECT_LE(std::abs(exchange.answer_forces(world, true, 0).force_n()[1]),
              kStiffness * 0.02 * static_cast<double>(tick + 1) / 100.0 + 1e-12);
    last = position;
  }
  EXPECT_NEAR(last, 0.02, 1e-15);
}

TEST(DeviceExchange, ASceneThatIsAlwaysLatePlaysWhatComes) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  std::uint64_t number = settle(exchange, world, 0.0);
  for (int tick = 0; tick < 150; ++tick) {
    exchange.receive(sample_at(number += 50, 0.02));
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
  }
  exchange.receive(sample_at(number += 50, 0.01));
  exchange.begin_tick();
  exchange.play(world, 1, 1.0);
  world.step();

  EXPECT_NEAR(world.position(0).x(), 1.01, 1e-15);
}

TEST(DeviceExchange, GivesNoForceToADeviceThatCannotBearTheScene) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  std::uint64_t number = settle(exchange, world, 0.02);

  for (int tick = 0; tick < 5; ++tick) {
    exchange.receive(sample_at(++number, 0.03), /*is_supported=*/false);
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
  }
  EXPECT_TRUE(exchange.is_disconnected());
  EXPECT_DOUBLE_EQ(world.position(0).x(), 1.02) << "its MAT holds still";
  const msg::GestureForces& answer = exchange.answer_forces(world, true, 0);
  EXPECT_EQ(answer.force_n()[1], 0.0);
  EXPECT_EQ(answer.answered_sample(), number) << "but it is answered";

  exchange.receive(sample_at(++number, 0.03));
  exchange.begin_tick();
  EXPECT_FALSE(exchange.is_disconnected());
}

TEST(DeviceExchange, GivesItsForcesGraduallyToADeviceThatWasAway) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  std::uint64_t number = settle(exchange, world, 0.02);
  exchange.let_go();
  EXPECT_EQ(exchange.answer_forces(world, true, 0).force_n()[1], 0.0);

  double before = 0.0;
  double largest_change = 0.0;
  for (int tick = 0; tick < 100; ++tick) {
    exchange.receive(sample_at(++number, 0.02));
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
    const double force = exchange.answer_forces(world, true, 0).force_n()[1];
    largest_change = std::max(largest_change, std::abs(force - before));
    before = force;
  }

  EXPECT_NEAR(before, -kStiffness * 0.02, 1e-12);
  EXPECT_LT(largest_change, kStiffness * 0.02 / 99.0);  // 100 equal changes of a force of 1 N
}

TEST(DeviceExchange, GoesOnWithTheNumbersOfTheSceneBefore) {
  engine::World world = world_with_a_port();
  DeviceExchange before = mass_exchange();
  const std::uint64_t number = settle(before, world, 0.02);
  before.receive(sample_at(number + 1, 0.03));
  const std::uint64_t answers = before.answer_forces(world, true, 0).sample();
  DeviceExchange now = mass_exchange();
  now.take_over(before, /*at_once=*/false);

  EXPECT_TRUE(now.has_new_sample());
  EXPECT_EQ(now.receive(sample_at(number, 0.0)), DeviceExchange::Reception::kRefused);
  now.begin_tick();
  const msg::GestureForces& answer = now.answer_forces(world, true, 0);
  EXPECT_EQ(answer.sample(), answers + 1);
  EXPECT_EQ(answer.answered_sample(), number + 1);
  EXPECT_LT(std::abs(answer.force_n()[1]), 0.02 * kStiffness / 50.0) << "it takes over gradually";
}

TEST(DeviceExchange, PlaysOnAtOnceWhenTheSceneIsTheSame) {
  engine::World world = world_with_a_port();
  DeviceExchange before = mass_exchange();
  settle(before, world, 0.02);
  DeviceExchange now = mass_exchange();
  now.take_over(before, /*at_once=*/true);

  EXPECT_NEAR(now.answer_forces(world, true, 0).force_n()[1], -kStiffness * 0.02, 1e-12);
}

TEST(DeviceExchange, HoldsItsMatsWhenTheDeviceFallsSilent) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  settle(exchange, world, 0.02);
  EXPECT_FALSE(exchange.is_disconnected());
  for (int tick = 0; tick < 25; ++tick) {
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
  }
  EXPECT_TRUE(exchange.is_disconnected());
  EXPECT_DOUBLE_EQ(world.position(0).x(), 1.02);
}

TEST(DeviceExchange, MissesADeviceThatFallsSilentUntilItIsBack) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  for (int tick = 0; tick < 100; ++tick) exchange.begin_tick();
  EXPECT_TRUE(exchange.is_disconnected());
  EXPECT_FALSE(exchange.is_missed()) << "it was never there";

  const std::uint64_t number = settle(exchange, world, 0.0);
  for (int tick = 0; tick < 20; ++tick) exchange.begin_tick();
  EXPECT_FALSE(exchange.is_missed());
  exchange.begin_tick();
  EXPECT_TRUE(exchange.is_missed());

  exchange.receive(sample_at(number + 22, 0.0));
  exchange.begin_tick();
  EXPECT_FALSE(exchange.is_missed());
}

TEST(DeviceExchange, DoesNotMissADeviceThatItHasLetGoOfOrThatIsRefused) {
  engine::World world = world_with_a_port();
  DeviceExchange exchange = mass_exchange();
  const std::uint64_t number = settle(exchange, world, 0.0);

  exchange.let_go();
  for (int tick = 0; tick < 100; ++tick) exchange.begin_tick();
  EXPECT_FALSE(exchange.is_missed()) << "the scene was paused";

  exchange.receive(sample_at(number + 100, 0.0));
  exchange.begin_tick();
  exchange.receive(sample_at(number + 101, 0.0), /*is_supported=*/false);
  for (int tick = 0; tick < 100; ++tick) exchange.begin_tick();
  EXPECT_FALSE(exchange.is_missed()) << "the scene refuses it";
}

TEST(DeviceExchange, LetsGoOfAMassWhenTheForceFallsSilent) {
  engine::World world = world_with_a_port();
  scene::Port port = port_at(2, Vec3(0.0, 1.0, 0.0), 0, Vec3::UnitY());
  port.role = Role::kLiaison;
  DeviceExchange exchange("key", kDevice, Role::kLiaison, {port}, kRate, 77);
  msg::GestureForces push;
  push.device_id(kDevice);
  push.epoch(kEpoch);
  push.axis_count(1);
  push.force_n().fill(0.0);
  push.force_n()[0] = 3.0;
  for (int tick = 1; tick <= 200; ++tick) {
    push.sample(static_cast<std::uint64_t>(tick));
    exchange.receive(push);
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
  }
  const double speed = world.velocity(2).y();
  EXPECT_GT(speed, 3.0 / 0.5 * 0.1);  // F/m for at least the 100 ticks after it has taken over
  EXPECT_NEAR(exchange.answer_positions(world, true, 0).position_m()[0],
              world.position(2).y() - 1.0, 1e-15);

  for (int tick = 0; tick < 25; ++tick) {
    exchange.begin_tick();
    exchange.play(world, 1, 1.0);
    world.step();
  }
  const double speed_when_disconnected = world.velocity(2).y();
  world.step();
  EXPECT_NEAR(world.velocity(2).y(), speed_when_disconnected, 1e-12) << "no force acts any more";
}

TEST(DeviceExchange, RefusesWhatIsMalformedOrNotFinite) {
  DeviceExchange exchange = mass_exchange();
  using Reception = DeviceExchange::Reception;
  msg::GesturePositions sample = sample_at(1, 0.0);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    sample.position_m()[1] = bad;
    EXPECT_EQ(exchange.receive(sample), Reception::kRefused);
  }
  sample = sample_at(1, 0.0);
  for (const std::uint32_t count : {0u, 1u, 17u, 4'000'000'000u}) {  // the port needs axis 1
    sample.axis_count(count);
    EXPECT_EQ(exchange.receive(sample), Reception::kRefused) << count;
  }
  EXPECT_EQ(exchange.refused_count(), 6u);
  EXPECT_FALSE(exchange.has_received());
}

TEST(DeviceExchange, DistinguishesNewFromRepeatedAndOldSamples) {
  DeviceExchange exchange = mass_exchange();
  using Reception = DeviceExchange::Reception;
  EXPECT_EQ(exchange.receive(sample_at(5, 0.0)), Reception::kNew);
  EXPECT_EQ(exchange.receive(sample_at(5, 0.0)), Reception::kRepeated);
  EXPECT_EQ(exchange.receive(sample_at(4, 0.0)), Reception::kRefused);
  EXPECT_EQ(exchange.receive(sample_at(9, 0.0)), Reception::kNew);
  EXPECT_EQ(exchange.lost_sample_count(), 3u);
  msg::GesturePositions of_a_new_epoch = sample_at(1, 0.0);
  of_a_new_epoch.epoch(kEpoch + 1);
  EXPECT_EQ(exchange.receive(of_a_new_epoch), Reception::kNew) << "the device was restarted";
}

}  // namespace
}  // namespace cordis::sim
