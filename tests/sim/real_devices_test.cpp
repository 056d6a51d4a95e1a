// tests/sim/real_devices_test.cpp
#include "sim_node/devices/real_devices.h"

#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "sim_node/device_link.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::sim {
namespace {

scene::Scene scene_that_plays(std::uint32_t device_id) {
  scene::Scene scene;
  scene::Port port;
  port.device_id = device_id;
  scene.ports.push_back(port);
  return scene;
}

TEST(RealDevices, AreThoseOfTheSceneThatMoveSomething) {
  RealDevices devices;
  devices.play(scene_that_plays(7));
  devices.update({{7, "keys", "mock"}, {8, "faders", "firefader"}});
  EXPECT_FALSE(devices.are_played());
  EXPECT_EQ(devices.text(), "");

  devices.update({{7, "keys", "mock"}, {7, "keys", "kfb1"}});
  EXPECT_TRUE(devices.are_played()) << "one on standby counts";
  EXPECT_EQ(devices.text(), "'keys' (driver kfb1)");

  devices.play(scene_that_plays(9));
  EXPECT_FALSE(devices.are_played());
  devices.play(scene_that_plays(7));
  devices.update({});
  EXPECT_FALSE(devices.are_played()) << "its process is gone";
}

TEST(RealDevices, AnUnknownDriverCountsAsReal) {
  RealDevices devices;
  devices.play(scene_that_plays(7));
  for (const char* driver : {"mock", "script", "replay", "pointer"}) {
    devices.update({{7, "keys", driver}});
    EXPECT_FALSE(devices.are_played()) << driver;
  }
  for (const char* driver : {"", "haply", "own driver"}) {
    devices.update({{7, "keys", driver}});
    EXPECT_TRUE(devices.are_played()) << driver;
  }
}

/// A process of a device that describes it.
struct Process {
  explicit Process(std::uint32_t device_id)
      : participant({test::own_domain(), "real", "keys"}),
        writer(participant, dds::Topic::kDevice) {
    msg::DeviceDescription description;
    description.device_id(device_id);
    description.device("keys");
    description.driver("kfb1");
    description.epoch(77);
    description.coordinate_count(1);
    description.rate_hz(1000.0);
    description.moving_mass_kg(0.05);
    EXPECT_TRUE(writer.write(description));
  }
  dds::Participant participant;
  dds::Writer<msg::DeviceDescription> writer;
};

scene::Scene scene_with_a_key() {
  config::Problems problems;
  scene::Scene scene = scene::load_scene_text(R"(cordis: 1
space: 1
step: {rate_hz: 1000}
matter:
  bob: {kind: mass, mass_kg: 1, at_m: 0}
liaisons:
  wall: {kind: spring, stiffness_n_per_m: 100}
ports:
  key: {device: keys, axes: 0, role: mass, at_m: 0, coupling: direct}
links:
  - {liaison: wall, between: [key, bob]}
)",
                                              "t", problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

/// As after a network that was away: the process is another peer of DDS, with the same epoch.
TEST(RealDevices, CountAgainWhenTheirProcessHasJoinedAgain) {
  dds::Participant participant({test::own_domain(), "real", "sim"});
  dds::Participant for_loop({test::own_domain(), "real", "sim-loop"});
  const auto link =
      std::make_unique<DeviceLink>(participant, for_loop, 5, config::Clock::kRealtime, 0.95);
  const scene::Scene scene = scene_with_a_key();
  const std::uint32_t device_id = scene.ports.at(0).device_id;
  link->play(scene);
  link->start();
  std::optional<Process> process(device_id);
  EXPECT_TRUE(test::eventually([&] { return link->real_devices().are_played(); }));
  process.reset();
  EXPECT_TRUE(test::eventually([&] { return !link->real_devices().are_played(); }));
  process.emplace(device_id);
  EXPECT_TRUE(test::eventually([&] { return link->real_devices().are_played(); }));
}

}  // namespace
}  // namespace cordis::sim
