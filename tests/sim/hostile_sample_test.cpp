// tests/sim/hostile_sample_test.cpp -- whoever takes part in a session may write a sample: no
// number in it ends the scene or silences the device.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/devices/device_exchange.h"
#include "sim_node/run/simulation.h"
#include "tests/sim/hand_loop.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/hostile.h"
#include "tests/support/rounds.h"

namespace cordis::sim {
namespace {

using test::Hostile;

constexpr std::uint64_t kEpochOfKey = 5;
constexpr double kTravel = 0.04;  // [m]
constexpr double kForce = 20.0;   // [N]

/// A key on a spring, of role mass, or a mass that a key pushes against one, of role liaison.
std::string key_scene(const std::string& role) {
  const std::string port = role == "mass" ? "coupling: direct" : "mass_kg: 0.1";
  return R"(cordis: 1
name: key
space: 1
step: {rate_hz: 4000, gesture_rate_hz: 1000}
liaisons: {spring: {kind: spring_damper, stiffness_n_per_m: 100, viscosity_n_s_per_m: 4}}
matter:
  wall: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 0.1, at_m: 0}
ports:
  key: {device: keyboard, axes: [0], role: )" +
         role + ", " + port +
         R"(, at_m: 0}
links:
  - {liaison: spring, between: [key, wall], rest_m: 0}
  - {liaison: spring, between: [key, bob], rest_m: 0}
)";
}

DeviceReach described_reach() {
  msg::DeviceDescription description;
  description.travel_m().fill(kTravel);
  description.force_n().fill(kForce);
  return reach_of(description);
}

/// The device as it is, whoever else writes in its name.
template <class Sample>
Sample true_sample(std::uint64_t number, const DeviceExchange& device);

template <>
msg::GesturePositions true_sample(std::uint64_t number, const DeviceExchange&) {
  msg::GesturePositions sample = key_sample(number, -0.01);
  sample.time_nsec(static_cast<std::int64_t>(number * 1'000'000));
  return sample;
}

template <>
msg::GestureForces true_sample(std::uint64_t number, const DeviceExchange&) {
  msg::GestureForces sample;
  sample.device_id(config::name_hash("keyboard"));
  sample.epoch(kEpochOfKey);
  sample.sample(number);
  sample.time_nsec(static_cast<std::int64_t>(number * 1'000'000));
  sample.axis_count(1);
  sample.force_n().fill(0.0);
  sample.force_n()[0] = -1.0;
  return sample;
}

void spoil_values(msg::GesturePositions& sample, Hostile& hostile) {
  for (double& value : sample.position_m())
    value = hostile.or_true(value, [&] { return hostile.real(); });
}
void spoil_values(msg::GestureForces& sample, Hostile& hostile) {
  for (double& value : sample.force_n())
    value = hostile.or_true(value, [&] { return hostile.real(); });
  sample.work_j(hostile.or_true(sample.work_j(), [&] { return hostile.real(); }));
}

/// Every field of a sample but the device's name may be anything.
template <class Sample>
Sample spoilt(Sample sample, Hostile& hostile) {
  const auto whole = [&] { return hostile.whole(); };
  const auto time = [&] { return hostile.time(); };
  sample.epoch(hostile.or_true(sample.epoch(), whole));
  sample.sample(hostile.or_true(sample.sample(), whole));
  sample.answered_epoch(hostile.or_true(kEpochOfSim, whole));
  sample.answered_sample(hostile.or_true(sample.sample(), whole));
  sample.answered_time_nsec(hostile.or_true(sample.time_nsec(), time));
  sample.time_nsec(hostile.or_true(sample.time_nsec(), time));
  sample.axis_count(hostile.or_true(sample.axis_count(), [&] { return hostile.word(); }));
  spoil_values(sample, hostile);
  return sample;
}

/// A scene and its key, in turns of one gesture period.
template <class Sample>
class Rig {
 public:
  explicit Rig(const std::string& role) : simulation_(scene_of(key_scene(role)), kEpochOfSim) {}

  DeviceExchange& key() { return simulation_.devices().front(); }
  DeviceExchange::Reception send(const Sample& sample) {
    return key().receive(sample, /*is_supported=*/true, described_reach());
  }
  DeviceExchange::Reception send_true() { return send(true_sample<Sample>(++number_, key())); }
  Sample next_true() { return true_sample<Sample>(++number_, key()); }

  void tick() {
    while (!simulation_.advance(1, events_) && !simulation_.failed()) {
    }
    ASSERT_FALSE(simulation_.failed()) << simulation_.failure();
    const engine::World& world = simulation_.world();
    for (const double force : key().answer_forces(world, true, 0).force_n())
      ASSERT_TRUE(std::isfinite(force));
    for (const double place : key().answer_positions(world, true, 0).position_m())
      ASSERT_TRUE(std::isfinite(place));
  }

  double place() { return simulation_.world().position(port_mat()).x(); }
  const engine::World& world() { return simulation_.world(); }
  std::uint32_t port_mat() { return simulation_.scene().ports.front().mat; }
  std::uint64_t number() const { return number_; }

 private:
  Simulation simulation_;
  EventRoom events_{0};
  std::uint64_t number_ = 0;
};

/// How many true samples it takes until one is taken again.
template <class Sample>
int samples_until_taken(Rig<Sample>& rig) {
  for (int count = 1; count <= 1001; ++count) {
    if (rig.send_true() == DeviceExchange::Reception::kNew) return count;
    rig.tick();
  }
  return -1;
}

template <class Sample>
class HostileSample : public ::testing::Test {
 protected:
  static std::string role() {
    return std::is_same_v<Sample, msg::GesturePositions> ? "mass" : "liaison";
  }
};
using Samples = ::testing::Types<msg::GesturePositions, msg::GestureForces>;
TYPED_TEST_SUITE(HostileSample, Samples);

TYPED_TEST(HostileSample, OfTheHighestNumberDoesNotSilenceTheDevice) {
  for (const std::uint64_t number :
       {~std::uint64_t{0}, std::uint64_t{1} << 63, std::uint64_t{5000}, std::uint64_t{400}}) {
    Rig<TypeParam> rig(this->role());
    for (int tick = 0; tick < 300; ++tick) {
      ASSERT_EQ(rig.send_true(), DeviceExchange::Reception::kNew);
      rig.tick();
    }
    ASSERT_EQ(rig.send(true_sample<TypeParam>(number, rig.key())), DeviceExchange::Reception::kNew);
    rig.tick();

    const int count = samples_until_taken(rig);

    EXPECT_GE(count, 1) << "after the number " << number << " the device is never taken again";
    EXPECT_LE(count, 20) << "after the number " << number;
    EXPECT_LE(rig.key().lost_sample_count(), 1000u) << "of a jump one second counts";
  }
}

TYPED_TEST(HostileSample, NeverEndsTheSceneNorSilencesTheDevice) {
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(test::rounds(60)); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Hostile hostile(seed);
    Rig<TypeParam> rig(this->role());
    for (int tick = 0; tick < 400; ++tick) {
      const TypeParam sample = rig.next_true();
      for (int more = 0; more < 3; ++more) {
        if (hostile.chance(0.3)) rig.send(spoilt(sample, hostile));
      }
      rig.send(sample);
      ASSERT_NO_FATAL_FAILURE(rig.tick());
    }

    const int count = samples_until_taken(rig);

    EXPECT_GE(count, 1) << "the device is never taken again";
    EXPECT_LE(count, 20);
  }
}

TYPED_TEST(HostileSample, FarBeyondTheTravelIsTakenForItsEnd) {
  Rig<TypeParam> rig(this->role());
  for (int tick = 0; tick < 300; ++tick) {
    rig.send_true();
    ASSERT_NO_FATAL_FAILURE(rig.tick());
  }
  for (int tick = 0; tick < 300; ++tick) {
    TypeParam sample = rig.next_true();
    if constexpr (std::is_same_v<TypeParam, msg::GesturePositions>) {
      sample.position_m()[0] = 1e300;
    } else {
      sample.force_n()[0] = 1e300;
    }
    rig.send(sample);
    ASSERT_NO_FATAL_FAILURE(rig.tick());
  }
  // A force of the bound against 100 N/m presses the mass against the end of the travel.
  const double farthest = this->role() == "mass" ? DeviceReach::kTravelShare * kTravel : kTravel;
  EXPECT_LE(std::abs(rig.place()), 1.5 * farthest);
  EXPECT_GT(std::abs(rig.place()), 0.5 * farthest) << "it is taken all the same";
}

TEST(HostileSampleOfWork, DoesNotDampAnHonestHandForEver) {
  for (const double lie : {1e300, -1e300, 1e6, -1e6, std::nan("")}) {
    Hold hold;
    hold.stiffness = 100.0;
    Loop loop(hold);
    for (int tick = 0; tick < 2000; ++tick) loop.tick(0.001 * std::sin(0.01 * tick));
    const std::uint64_t before = loop.passivity_ticks();
    loop.lie_about_work(lie);
    loop.tick(0.0);
    for (int tick = 0; tick < 4000; ++tick) loop.tick(0.001 * std::sin(0.01 * tick));

    EXPECT_EQ(loop.passivity_ticks(), before) << "after a work of " << lie << " J";
  }
}

TEST(DeviceReach, OfAHostileDescriptionIsThatOfAnUnknownDevice) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Hostile hostile(seed);
    msg::DeviceDescription description;
    for (double& travel : description.travel_m()) travel = hostile.real();
    for (double& force : description.force_n()) force = hostile.real();
    const DeviceReach reach = reach_of(description);
    for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
      EXPECT_TRUE(reach.travel_m[c] > 0.0 && reach.travel_m[c] <= DeviceReach::kFarthest) << seed;
      EXPECT_TRUE(reach.force_n[c] > 0.0 && reach.force_n[c] <= DeviceReach::kStrongest) << seed;
    }
  }
}

TEST(ReachTable, BelievesWhatIsReportedFirstOfAnEpochAndKeepsTheLast) {
  ReachTable table;
  const DeviceReach description = described_reach();
  EXPECT_EQ(table.find(1, 1).travel_m[0], DeviceReach::kFarthest);
  table.put(1, 1, description);
  table.put(1, 1, DeviceReach());
  table.put(2, 1, DeviceReach());
  EXPECT_EQ(table.find(1, 1).travel_m[0], description.travel_m[0]);
  EXPECT_EQ(table.find(2, 1).travel_m[0], DeviceReach::kFarthest);

  for (std::uint64_t epoch = 2; epoch < 100; ++epoch) table.put(1, epoch, description);
  EXPECT_EQ(table.find(1, 1).travel_m[0], DeviceReach::kFarthest) << "forgotten";
  EXPECT_EQ(table.find(1, 99).travel_m[0], description.travel_m[0]);
}

TEST(ReachTable, KeepsADeviceThatPlaysHoweverOftenOthersRestart) {
  ReachTable table;
  const DeviceReach description = described_reach();
  table.put(1, 1, description);
  for (std::uint64_t epoch = 2; epoch < 500; ++epoch) {
    table.put(static_cast<std::uint32_t>(1 + epoch % 3), epoch, DeviceReach());
    EXPECT_EQ(table.find(1, 1).travel_m[0], description.travel_m[0]) << epoch;
  }
}

TEST(ReachTable, KeepsAStandbyThatIsThereHoweverOftenOthersRestart) {
  ReachTable table;
  table.put(1, 1, described_reach());
  for (std::uint64_t epoch = 2; epoch < 500; ++epoch) {
    table.put(1, epoch, DeviceReach());
    table.keep(1);
    EXPECT_TRUE(table.knows(1, 1)) << epoch;
  }
  for (std::uint64_t epoch = 500; epoch < 600; ++epoch) table.put(1, epoch, DeviceReach());
  EXPECT_FALSE(table.knows(1, 1)) << "it has ended";
}

}  // namespace
}  // namespace cordis::sim
