// tests/device/device_config_test.cpp
#include "device_node/device_config.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "device_node/drivers/driver_table.h"
#include "node/config/name_hash.h"
#include "node/config/yaml_reader.h"

namespace cordis::device {
namespace {

LoadedDevice device_of(const std::string& text) {
  config::Problems problems;
  return read_device(config::load_text(text, "device.yaml", problems), "keyboard", problems);
}

std::string problems_of(const std::string& text) {
  try {
    device_of(text);
  } catch (const config::ConfigError& error) {
    return error.what();
  }
  return {};
}

/// The device of a launch file in launch_configs/, with words of the command line laid on it.
LoadedDevice launched(const std::string& device_file, const std::vector<std::string>& words) {
  config::Problems problems;
  const config::Launch launch = config::load_launch_text(
      "cordis: 1\nnodes: {keyboard: {node: device_node, device: devices/" + device_file + "}}\n",
      CORDIS_SOURCE_DIR "/launch_configs/some.yaml", words, problems);
  problems.throw_if_any();
  return load_device(launch, *launch.find("keyboard"), problems);
}

TEST(DeviceConfig, NeedsNothingButItsAxes) {
  const LoadedDevice device = device_of("axes: 3");

  EXPECT_EQ(device.config.name, "keyboard");
  EXPECT_EQ(device.config.device_id, config::name_hash("keyboard"));
  EXPECT_EQ(device.config.layout.count, 3);
  EXPECT_EQ(device.config.layout.lowest_m, -0.04);
  EXPECT_EQ(device.config.layout.highest_m, 0.0);
  EXPECT_EQ(device.config.layout.rate_hz, 1000.0);
  EXPECT_EQ(device.config.force_guard.watchdog_s, 0.02);
  EXPECT_EQ(device.config.driver, "mock");
  EXPECT_NE(device.driver, nullptr);
}

TEST(DeviceConfig, ASceneInItsPlaceIsOneProblem) {
  try {
    launched("../scenes/membrane.yaml", {});
    FAIL() << "a scene was taken for a device";
  } catch (const config::ConfigError& error) {
    ASSERT_EQ(error.problems().size(), 1u) << error.what();
    EXPECT_EQ(error.problems()[0].message, "this is a scene, and a device file is wanted");
  }
}

TEST(DeviceConfig, IsRefusedWhereTimeIsNotThatOfAHand) {
  EXPECT_NO_THROW(launched("keyboard.yaml", {"clock=lockstep"}));
  try {
    launched("keyboard.yaml", {"clock=asap"});
    ADD_FAILURE() << "it is let in";
  } catch (const config::ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'keyboard' has no place in a session with clock: asap"), text.npos)
        << text;
    EXPECT_NE(text.find("clock: lockstep for simulated hands"), text.npos) << text;
  }
}

TEST(DeviceConfig, MayPlayTheDeviceOfAnotherNode) {
  const DeviceConfig own = launched("keyboard.yaml", {}).config;
  EXPECT_EQ(own.strength, 10);
  const DeviceConfig standby = launched("keyboard.yaml", {"keyboard.standby_for=organ"}).config;
  EXPECT_EQ(standby.name, "organ");
  EXPECT_EQ(standby.device_id, config::name_hash("organ"));
  EXPECT_EQ(standby.strength, 5);
  EXPECT_EQ(launched("keyboard.yaml", {"keyboard.standby_for=organ", "keyboard.strength=7"})
                .config.strength,
            7);
  EXPECT_THROW(launched("keyboard.yaml", {"keyboard.standby_for=organ", "clock=lockstep"}),
               config::ConfigError);
  EXPECT_THROW(launched("keyboard.yaml", {"keyboard.standby_for=organ", "keyboard.rate_hz=50"}),
               config::ConfigError);
}

TEST(DeviceConfig, GivesItsLimitsToBothGuards) {
  const DeviceConfig config = device_of(
                                  "{axes: 1, travel_m: 0.03, rest: middle, rate_hz: 500, "
                                  "force_limit_n: 8, slew_limit_n_per_s: 900, "
                                  "speed_limit_m_per_s: 0.7, watchdog_s: 0.04, start_ramp_s: 0.3}")
                                  .config;

  EXPECT_EQ(config.layout.lowest_m, -0.015);
  EXPECT_EQ(config.layout.highest_m, 0.015);
  EXPECT_EQ(config.layout.force_limit_n, 8.0);
  EXPECT_EQ(config.force_guard.limit_n, 8.0);
  EXPECT_EQ(config.force_guard.slew_n_per_s, 900.0);
  EXPECT_EQ(config.force_guard.ramp_s, 0.3);
  EXPECT_EQ(config.force_guard.watchdog_s, 0.04);
  EXPECT_EQ(config.force_guard.period_s, 0.002);
  EXPECT_EQ(config.layout.slew_n_per_s, 900.0);
  EXPECT_EQ(config.layout.start_ramp_s, 0.3);
  EXPECT_EQ(config.layout.watchdog_s, 0.04);
  EXPECT_EQ(config.layout.power_w, 8.0 * 0.7);
  EXPECT_EQ(config.position_guard.lowest_m, -0.015);
  EXPECT_EQ(config.position_guard.highest_m, 0.015);
  EXPECT_EQ(config.position_guard.speed_m_per_s, 0.7);
  EXPECT_EQ(config.position_guard.ramp_s, 0.3);
  EXPECT_EQ(config.position_guard.watchdog_s, 0.04);
  EXPECT_EQ(config.position_guard.period_s, 0.002);
}

TEST(DeviceConfig, KnowsHowWideItsKeysAre) {
  const DeviceConfig one = launched("keyboard.yaml", {}).config;
  EXPECT_EQ(one.limits.key_pitch_m, 0.01375);
  EXPECT_EQ(what_it_is(one), "1 key, 13.75 mm wide, driver mock");
  // One number adds keys.
  const DeviceConfig more = launched("keyboard.yaml", {"keyboard.axes=12"}).config;
  EXPECT_EQ(what_it_is(more), "12 keys of 13.75 mm, 165 mm side by side, driver mock");
  const DeviceConfig plane = device_of("{axes: 2, driver: mock}").config;
  EXPECT_EQ(plane.limits.key_pitch_m, 0.0);
  EXPECT_EQ(what_it_is(plane), "2 axes, driver mock");
}

TEST(DeviceConfig, DampsOnlyADeviceWhoseViscosityIsKnown) {
  EXPECT_FALSE(device_of("axes: 1").config.force_guard.passivity.active);
  EXPECT_EQ(device_of("axes: 1").config.force_guard.power_w, 40.0);
  const ForceGuardSettings guard =
      device_of(
          "{axes: 2, force_limit_n: 10, viscosity_n_s_per_m: 0.8, moving_mass_kg: 0.2, "
          "power_limit_w: 5, passivity: {budget_j: 0.05}}")
          .config.force_guard;
  EXPECT_TRUE(guard.passivity.active);
  EXPECT_EQ(guard.passivity.viscosity_n_s_per_m, 0.8);
  EXPECT_EQ(guard.passivity.mass_kg, 0.2);
  EXPECT_EQ(guard.passivity.budget_j, 0.05);
  EXPECT_DOUBLE_EQ(guard.passivity.tank_j, 2 * 10 * 0.04);
  EXPECT_EQ(guard.power_w, 5.0);
  EXPECT_NE(problems_of("{axes: 1, passivity: {active: true}}").find("needs viscosity_n_s_per_m"),
            std::string::npos);
}

TEST(DeviceConfig, WatchdogOfASlowDeviceSpansItsPeriods) {
  EXPECT_DOUBLE_EQ(device_of("{axes: 1, rate_hz: 25}").config.force_guard.watchdog_s, 6.0 / 25.0);
}

TEST(DeviceConfig, ShippedDevicesAreRightWithEveryDriverTheyKnow) {
  EXPECT_EQ(launched("keyboard.yaml", {}).config.layout.count, 1);
  EXPECT_EQ(launched("keyboard_16.yaml", {}).config.layout.count, 16);
  EXPECT_EQ(launched("handle.yaml", {}).config.end_effector_map.coordinate_count(), 2);
  int devices = 0;
  const std::filesystem::path folder = CORDIS_SOURCE_DIR "/launch_configs/devices";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    config::Problems problems;
    const config::Value file = config::load_file(entry.path().string(), problems);
    for (const DriverEntry& driver : driver_table()) {
      if (!file.find(driver.name).exists()) continue;
      const LoadedDevice device = launched(entry.path().filename().string(),
                                           {"keyboard.driver=" + std::string(driver.name)});
      EXPECT_EQ(device.config.driver, driver.name);
      EXPECT_TRUE(device.driver->can_play(Role::kMass)) << entry.path();
      ++devices;
    }
  }
  EXPECT_GE(devices, 9);
}

TEST(DeviceConfig, PointersOfTheGalleryHaveTheAxesThatTheyTakeOver) {
  int pointers = 0;
  const std::filesystem::path folder = CORDIS_SOURCE_DIR "/launch_configs";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    config::Problems problems;
    const config::Launch launch = config::load_launch(entry.path().string(), {}, problems);
    problems.throw_if_any();
    if (launch.find("pointer") == nullptr) continue;
    const LoadedDevice pointer = load_device(launch, *launch.find("pointer"), problems);
    const LoadedDevice hand = load_device(launch, *launch.find(pointer.config.name), problems);
    problems.throw_if_any();
    EXPECT_EQ(pointer.config.device_id, hand.config.device_id) << entry.path();
    EXPECT_EQ(pointer.config.layout.count, hand.config.layout.count) << entry.path();
    EXPECT_EQ(pointer.config.layout.lowest_m, hand.config.layout.lowest_m) << entry.path();
    EXPECT_EQ(pointer.config.layout.highest_m, hand.config.layout.highest_m) << entry.path();
    EXPECT_EQ(pointer.config.layout.rate_hz, hand.config.layout.rate_hz) << entry.path();
    EXPECT_GT(pointer.config.strength, hand.config.strength) << entry.path();
    EXPECT_FALSE(launch.find("pointer")->required) << entry.path();
    ++pointers;
  }
  EXPECT_GE(pointers, 20);
}

TEST(DeviceConfig, LaysTheLaunchFileAndTheCommandLineOnTheDeviceFile) {
  // A hand ten times stiffer presses the key deeper against the same force.
  const auto depth_with = [](const std::vector<std::string>& words) {
    const LoadedDevice device = launched("keyboard.yaml", words);
    device.driver->start(Role::kMass);
    AxisValues values{};
    for (int n = 0; n < 1700; ++n) {
      values.fill(2.0);
      static_cast<void>(device.driver->write(values));
      static_cast<void>(device.driver->read(values));
    }
    return values[0];
  };

  EXPECT_LT(depth_with({"keyboard.mock.hand.stiffness_n_per_m=4000"}), depth_with({}) - 0.002);
  EXPECT_EQ(launched("keyboard.yaml", {"keyboard.travel_m=0.05"}).config.layout.lowest_m, -0.05);
}

TEST(DeviceConfig, SaysOneThingOfAGestureThatIsNone) {
  const std::string problems =
      problems_of("axes: 1\nmock: {hand: {gesture: {kind: pluk, depth_m: -0.01}}}");
  EXPECT_NE(problems.find("device.yaml:2:31: error: 'kind' in gesture"), std::string::npos);
  EXPECT_NE(problems.find("did you mean 'pluck'?"), std::string::npos) << problems;
  EXPECT_EQ(problems.find("error: "), problems.rfind("error: ")) << problems;
}

TEST(DeviceConfig, ItsTraceReplacesNoYamlFileAndNoTake) {
  for (const char* ending : {".yaml", ".mcap"}) {
    const std::string file =
        testing::TempDir() + "device_trace." + std::to_string(getpid()) + ending;
    std::ofstream(file) << "kept";
    EXPECT_NE(problems_of("axes: 1\ntrace: {file: " + file + "}").find("and is never overwritten"),
              std::string::npos);
    std::filesystem::remove(file);
  }
}

struct BadDevice {
  const char* text;
  const char* problem;
};

class DeviceProblem : public testing::TestWithParam<BadDevice> {};

TEST_P(DeviceProblem, IsReportedWithItsPlace) {
  const std::string problems = problems_of(GetParam().text);
  EXPECT_NE(problems.find(GetParam().problem), std::string::npos) << problems;
}

INSTANTIATE_TEST_SUITE_P(
    All, DeviceProblem,
    testing::Values(
        BadDevice{"travel_m: 0.03", "device.yaml:1:1: error: "},
        BadDevice{"axes: 17", "device.yaml:1:7: error: 'axes' in device 'keyboard'"},
        BadDevice{"{axes: 1, key_pitch_m: 13.75}",
                  "device.yaml:1:24: error: 'key_pitch_m' in device 'keyboard' must be "},
        BadDevice{"{axes: 1, slice_width_m: 0.01}", "'slice_width_m' is called 'key_pitch_m' now"},
        BadDevice{"{axes: 1, travel: 0.03}", "device.yaml:1:11: error: unknown key 'travel'"},
        BadDevice{"{axes: 1, driver: moc}", "did you mean 'mock'?"},
        BadDevice{"{axes: 1, driver: script}", "error: script needs positions or forces"},
        BadDevice{"axes: 1\ndriver: kfb1", "device.yaml:2:9: error: kfb1 needs either 'port'"},
        BadDevice{"axes: 1\nkfb1: {port: /dev/ttyACM0, udp: '127.0.0.1:5005'}",
                  "hint: port: '' takes back a port that another file gives"},
        BadDevice{"axes: 1\nkfb1: {udp: '127.0.0.1:50x'}", "device.yaml:2:13: error: udp must be"},
        BadDevice{"axes: 1\nkfb1: {udp: 'localhost'}", "device.yaml:2:13: error: udp must be"},
        BadDevice{"axes: 1\nkfb1: {port: /dev/ttyACM0, baud: 12345}",
                  "device.yaml:2:34: error: baud must be 9600, "},
        BadDevice{"axes: 3\nfirefader: {port: /dev/ttyUSB0}", "it has at most two axes"},
        BadDevice{"axes: 2\nhaply: {port: /dev/ttyACM0, counts_per_turn: [10752, 0]}",
                  "device.yaml:2:46: error: counts_per_turn must be > 0"},
        BadDevice{"axes: 2\nhaply: {port: /dev/ttyACM0, rest_m: [0, 0.4]}",
                  "rest_m is out of the reach of its arms"},
        BadDevice{"axes: 1\ntrace: {file: /nowhere/at_all.csv}",
                  "device.yaml:2:15: error: there is no folder '/nowhere' for the trace"},
        BadDevice{"{axes: 1, watchdog_s: 0.003}",
                  "device.yaml:1:23: error: watchdog_s must be more than three periods of rate_hz"},
        BadDevice{"{axes: 1, watchdog_s: 20}",
                  "device.yaml:1:23: error: watchdog_s must be at most 0.2, got 20"},
        BadDevice{"{axes: 1, slew_limit_n_per_s: 100}",
                  "device.yaml:1:31: error: slew_limit_n_per_s must be at least 1177 so that "
                  "force_limit_n falls to zero within watchdog_s, got 100"},
        BadDevice{"axes: 1\nmock: {key: {stop_viscosity_n_s_per_m: 0.1}}",
                  "device.yaml:2:40: error: stop_viscosity_n_s_per_m must be at least 0.63"},
        BadDevice{R"(axes: 1
mock: {hand: {moves: [{at_s: 0, in_s: 1, to_m: 0}, {at_s: 0.5, in_s: 1, to_m: 0}]}})",
                  "device.yaml:2:59: error: a move must not begin before the one before it has "
                  "ended"},
        BadDevice{"axes: 1\nmock: {hand: {repeat_s: 1, moves: [{at_s: 0, in_s: 2, to_m: 0}]}}",
                  "device.yaml:2:25: error: repeat_s must not be less than the end of the last "
                  "move"},
        BadDevice{"axes: 2\nmock: {hand: {axes: [0, 2]}}", "device.yaml:2:25: error: "},
        BadDevice{"axes: 2\nmock: {hand: {axes: [1, 1]}}", "axis 1 stands here twice"},
        BadDevice{R"(axes: 1
mock: {key: {mass_kg: 0.0001, stop_n_per_m: 1e9, stop_viscosity_n_s_per_m: 10}})",
                  "device.yaml:2:7: error: mock: its mechanics are too fast"},
        // the driver that is not in use is checked too
        BadDevice{"axes: 1\nscript: {positions: 3}", "device.yaml:2:21: error: "}));

}  // namespace
}  // namespace cordis::device
