// tests/sim/real_devices_test.cpp
#include "sim_node/devices/real_devices.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cordis::sim
