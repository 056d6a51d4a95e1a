// tests/sim/port_check_test.cpp -- devices that do not support a scene, in the launch and joining
// late.
#include "sim_node/checks/port_check.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "node/config/mapping_reader.h"
#include "node/config/name_hash.h"
#include "node/config/yaml_reader.h"
#include "node/time.h"
#include "sim_node/checks/device_check.h"
#include "sim_node/devices/refused_devices.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "tests/support/filled.h"
#include "tests/support/rounds.h"

namespace cordis::sim {
namespace {

/// Two walls at one key.
/// @param needs  further keys of the port
scene::Scene walls_of(const std::string& stiffness, const std::string& needs = {}) {
  config::Problems problems;
  scene::Scene scene =
      scene::load_scene_text(test::filled(R"(cordis: 1
space: 1
step: {rate_hz: 1000}
matter:
  ground: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 1, at_m: 0}
liaisons:
  wall: {kind: spring, stiffness_n_per_m: <stiffness>}
ports:
  key: {device: keyboard, axes: 0, role: mass, at_m: 0, coupling: direct<needs>}
links:
  - {liaison: wall, between: [key, ground]}
  - {liaison: wall, between: [key, bob]}
)",
                                          {{"stiffness", stiffness}, {"needs", needs}}),
                             "t", problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

config::DeviceLimits key_limits() {
  config::DeviceLimits limits;
  limits.moving_mass_kg = 0.3;
  limits.viscosity_n_s_per_m = 1.5;
  return limits;
}

PortVerdict verdict(const scene::Scene& scene, const config::DeviceLimits& limits, double delay) {
  return verdict_on(demands_of(scene).at(0), limits, delay);
}

TEST(PortCheck, RefusesASceneStifferThanItsPortWithTheNumberItMayHave) {
  const scene::Scene soft = walls_of("500");  // two of them: 1000 N/m; the limit is 1001 N/m
  const scene::Scene stiff = walls_of("501");

  EXPECT_EQ(verdict(soft, key_limits(), 1).refusal, "");
  const std::string refusal = verdict(stiff, key_limits(), 1).refusal;
  EXPECT_NE(refusal.find("as stiff as 1002 N/m"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("supports 1001 N/m"), std::string::npos) << refusal;
  EXPECT_EQ(verdict(stiff, key_limits(), 0).refusal, "") << "3003 N/m without delay";
}

TEST(PortCheck, SaysOnceWhatIsWrongWithTheCopiesOfAPort) {
  config::Problems problems;
  const scene::Scene scene = scene::load_scene_text(
      R"(cordis: 1
space: 1
step: {rate_hz: 1000}
parts:
  key: {ports: {finger: {device: keyboard, axes: [0], role: mass}}}
matter:
  bob: {kind: mass, mass_kg: 1, at_m: 0}
  keys: {part: key, repeat: {count: 16}}
ports:
  pedal: {device: pedal, axes: [0], role: mass}
)",
      "t", problems);
  ASSERT_EQ(problems.text(), "");
  config::Launch launch;
  launch.file = "l";

  check_devices(launch, scene, problems);

  ASSERT_EQ(problems.all().size(), 2u) << problems.text();
  EXPECT_EQ(problems.all()[0].message,
            "port 'keys[0].finger' wants the device 'keyboard', and l has no device_node of that "
            "name: it stays at rest until one joins the session; so do 15 ports more of this line");
  EXPECT_EQ(problems.all()[1].message.find("port 'pedal' wants"), 0u);
}

TEST(PortCheck, SaysWhatASessionOfEachClockDoesWithoutTheDeviceOfAPort) {
  const scene::Scene scene = walls_of("500");
  using config::Clock;
  const std::vector<std::pair<Clock, std::string>> results{
      {Clock::kRealtime, "it stays at rest until one joins the session"},
      {Clock::kLockstep,
       "in lockstep `cordis run` waits, and nothing moves until one joins the session"},
      {Clock::kAsap, "it stays at rest, as an asap session has no devices"}};
  for (const auto& [clock, result] : results) {
    config::Problems problems;
    config::Launch launch;
    launch.file = "l";
    launch.clock = clock;

    check_devices(launch, scene, problems);

    ASSERT_EQ(problems.all().size(), 1u) << problems.text();
    EXPECT_EQ(
        problems.all()[0].message,
        "port 'key' wants the device 'keyboard', and l has no device_node of that name: " + result);
  }
}

/// A device_node of a launch file, and further keys of it.
std::string device_node(const std::string& name, const std::string& keys = {}) {
  return test::filled("<name>: {node: device_node, device: <file><keys>}",
                      {{"name", name},
                       {"file", testing::TempDir() + "names." + std::to_string(getpid())},
                       {"keys", keys}});
}

/// Problems of a session that begins with a scene whose port wants the keyboard.
std::string problems_with(const std::vector<std::string>& nodes, SceneUse use = SceneUse::kFirst) {
  const scene::Scene scene = walls_of("500");
  const std::string device = testing::TempDir() + "names." + std::to_string(getpid());
  std::ofstream(device) << "{cordis: 1, axes: 1}";
  std::string text;
  for (const std::string& node : nodes) text += (text.empty() ? "" : ", ") + node;
  config::Problems problems;
  const config::Launch launch =
      config::load_launch_text("{cordis: 1, nodes: {" + text + "}}", "l", {}, problems);
  EXPECT_EQ(problems.text(), "");
  check_devices(launch, scene, problems, use);
  std::filesystem::remove(device);
  return problems.text();
}

TEST(PortCheck, RefusesAWrongNameWhereASessionBegins) {
  const std::string error = problems_with({device_node("keybord")});
  EXPECT_NE(error.find("t:10:3: error: port 'key' wants the device 'keyboard', and l has no "
                       "device_node of that name; no port wants its 'keybord'"),
            std::string::npos)
      << error;
  EXPECT_NE(error.find("did you mean 'keybord'?"), std::string::npos) << error;

  const std::string other = problems_with({device_node("pedal")});
  EXPECT_NE(other.find("error: port 'key' wants"), std::string::npos) << other;
  EXPECT_NE(other.find("'required: false' of a device for another scene"), std::string::npos);

  const std::string standby = problems_with(
      {device_node("keybord"), device_node("hand", ", standby_for: keyboard, required: false")});
  EXPECT_NE(standby.find("no port wants its 'keybord'"), std::string::npos) << standby;
}

TEST(PortCheck, RefusesAStandbyOfAMisspeltNode) {
  const std::string error = problems_with(
      {device_node("keyboard"), device_node("hand", ", standby_for: keybord, required: false")});
  EXPECT_NE(error.find("error: 'standby_for' names no device_node: 'keybord'"), std::string::npos)
      << error;
  EXPECT_NE(error.find("did you mean 'keyboard'?"), std::string::npos) << error;
}

TEST(PortCheck, LeavesNamesAloneThatAreForAnotherProgramOrScene) {
  const std::string optional = problems_with({device_node("pedal", ", required: false")});
  EXPECT_EQ(optional.find("error"), std::string::npos) << optional;
  EXPECT_NE(optional.find("warning: port 'key' wants"), std::string::npos) << optional;

  const std::string alone = problems_with({"view: {node: viz_node}"});
  EXPECT_EQ(alone.find("error"), std::string::npos) << alone;

  EXPECT_EQ(problems_with({device_node("keyboard"), device_node("pedal")}), "");

  const std::string later = problems_with({device_node("keybord")}, SceneUse::kLater);
  EXPECT_EQ(later.find("error"), std::string::npos) << later;
}

/// The device file `{axes: 1, ...}` with these keys.
config::DeviceLimits limits_of(const std::string& keys) {
  config::Problems problems;
  const config::Value file = config::load_text("{" + keys + "}", "d", problems);
  config::MappingReader reader(file, "device", problems);
  const config::DeviceLimits limits = config::read_device_limits(reader);
  EXPECT_EQ(problems.text(), "");
  return limits;
}

TEST(PortCheck, RefusesADeviceWithoutTheTravelOrTheForceThatAPortNeeds) {
  const scene::Scene scene = walls_of("1", ", needs: {travel_m: 0.05, force_n: 5}");
  const auto lacks = [&](const std::string& keys) {
    return verdict(scene, limits_of(keys), 1).lacks;
  };
  using Sentences = std::vector<std::string>;

  EXPECT_EQ(lacks("axes: 1, travel_m: 0.05, force_limit_n: 5, rest: middle"), Sentences{});
  EXPECT_EQ(lacks("axes: 1, travel_m: 0.04, force_limit_n: 4"),
            (Sentences{"port 'key' needs a travel of 0.05 m, and axis 0 of the device 'keyboard' "
                       "has 0.04 m",
                       "port 'key' needs a force of 5 N, and axis 0 of the device 'keyboard' has "
                       "4 N"}));
  EXPECT_EQ(verdict(walls_of("1"), limits_of("axes: 1, travel_m: 0.001"), 1).lacks, Sentences{});
  EXPECT_EQ(verdict(scene, config::DeviceLimits{}, 1).lacks, Sentences{}) << "nothing is known";
}

TEST(PortCheck, OnlyTheTravelOnTheNeededSideOfTheRestCounts) {
  const scene::Scene presses = walls_of("1", ", needs: {down_m: 0.03}");
  const scene::Scene pulls = walls_of("1", ", needs: {up_m: 0.03}");
  const auto lacks = [&](const scene::Scene& scene, const std::string& keys) {
    return verdict(scene, limits_of("travel_m: 0.04, " + keys), 1).lacks;
  };

  EXPECT_TRUE(lacks(presses, "axes: 1, rest: top").empty());
  EXPECT_TRUE(lacks(pulls, "axes: 1, rest: bottom").empty());
  EXPECT_EQ(lacks(presses, "axes: 1, rest: middle"),
            std::vector<std::string>{"port 'key' needs a travel of 0.03 m below its rest, and axis "
                                     "0 of the device 'keyboard' has 0.02 m below its rest"});
  EXPECT_EQ(lacks(pulls, "axes: 1, rest: top"),
            std::vector<std::string>{"port 'key' needs a travel of 0.03 m above its rest, and axis "
                                     "0 of the device 'keyboard' has 0 m above its rest"});
  EXPECT_TRUE(lacks(pulls, "axes: 1, rest: top, end_piece: {map: [[-1]]}").empty()) << "turned";
  EXPECT_EQ(lacks(presses, "axes: 1, rest: top, end_piece: {map: [[-1]]}").size(), 1u);
  EXPECT_EQ(verdict(presses, config::DeviceLimits{}, 1).lacks.size(), 0u) << "nothing is known";
}

TEST(PortCheck, ALeverTradesTravelForForce) {
  const scene::Scene scene = walls_of("1", ", needs: {travel_m: 0.05, force_n: 5}");
  const auto lacks = [&](const std::string& map) {
    return verdict(scene,
                   limits_of("axes: 2, travel_m: 0.04, force_limit_n: 10, end_piece: {map: [" +
                             map + ", [1, 1]]}"),
                   1)
        .lacks;
  };
  EXPECT_TRUE(lacks("[2, 0]").empty()) << "8 cm and 5 N";
  EXPECT_TRUE(lacks("[1, -1]").empty()) << "8 cm by their difference, and 10 N";
  ASSERT_EQ(lacks("[4, 0]").size(), 1u) << "16 cm and 2.5 N";
  EXPECT_NE(lacks("[4, 0]")[0].find("has 2.5 N"), std::string::npos);
  ASSERT_EQ(lacks("[0.5, 0.5]").size(), 1u) << "4 cm and 20 N";
  EXPECT_NE(lacks("[0.5, 0.5]")[0].find("has 0.04 m"), std::string::npos);
}

TEST(PortCheck, RefusesASceneMoreViscousThanItsPortWithTheNumberItMayHave) {
  PortDemand demand;
  demand.port = "key";
  demand.device = "keyboard";
  demand.least = demand.most = {0.0, 251.0};
  // A mass alone, a period of delay: z^2 (z - 1) + c (z + 1) has a root on the unit circle at
  // c = B T / 2 m = sqrt(2) - 1: B = 248.5 N s/m, and 1.5 N s/m of its own add about as much.
  const std::string refusal = verdict_on(demand, key_limits(), 1).refusal;
  EXPECT_NE(refusal.find("as viscous as 251 N s/m"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("supports 249 N s/m (with 0.3 kg"), std::string::npos) << refusal;
  demand.least.viscosity = 248.0;
  EXPECT_EQ(verdict_on(demand, key_limits(), 1).refusal, "");

  config::DeviceLimits declared = key_limits();
  declared.damping_limit_n_s_per_m = 2.0;
  declared.stiffness_limit_n_per_m = 1e6;
  EXPECT_NE(verdict_on(demand, declared, 1).refusal.find("supports 2 N s/m (declares it)"),
            std::string::npos);
}

TEST(PortCheck, AHandleIsAsLightAsItsLeversMakeIt) {
  const config::DeviceLimits limits = limits_of(
      "axes: 2, moving_mass_kg: 2.4, viscosity_n_s_per_m: 12, end_piece: {map: [[2, -2], [0.5, "
      "0.5]]}");

  // q = 2 (x0 - x1): a mass of 2.4 kg behind a ratio of 2 at either end weighs 1/8 of it.
  EXPECT_EQ(limits.inertia_ratio, 8.0);
  EXPECT_DOUBLE_EQ(limits.coordinate_mass_kg(), 0.3);
  const std::string refusal = verdict(walls_of("501"), limits, 1).refusal;
  EXPECT_NE(refusal.find("supports 1001 N/m"), std::string::npos) << refusal;
}

TEST(PortCheck, KnowsNothingOfADeviceThatDeclaresNothing) {
  EXPECT_EQ(verdict(walls_of("1e6"), config::DeviceLimits{}, 1).refusal, "");
}

TEST(PortCheck, TakesADeclaredLimitAtItsWord) {
  config::DeviceLimits limits = key_limits();
  limits.stiffness_limit_n_per_m = 150.0;

  EXPECT_NE(verdict(walls_of("100"), limits, 0).refusal.find("supports 150 N/m"),
            std::string::npos);
}

TEST(PortCheck, UncertaintysASetThatMayMeetTheDeviceManyTimesAtOnce) {
  PortDemand demand;
  demand.port = "finger";
  demand.device = "thimble";
  demand.least = {300.0, 0.0};
  demand.most = {1800.0, 0.0};

  const PortVerdict verdict = verdict_on(demand, key_limits(), 1);

  EXPECT_EQ(verdict.refusal, "");
  EXPECT_NE(verdict.uncertainty.find("may become as stiff as 1800 N/m"), std::string::npos)
      << verdict.uncertainty;
}

TEST(PortCheck, UncertaintysAPortOfRoleLiaisonWhoseViscosityIsLittleForAFingertip) {
  PortDemand demand;
  demand.port = "bow";
  demand.device = "keyboard";
  demand.role = scene::Role::kLiaison;
  demand.mass = 0.1;
  demand.least = {0.0, 1.5};  // 1.5 N s/m over 1 ms: 1500 N/m

  EXPECT_NE(verdict_on(demand, key_limits(), 1).uncertainty.find("is stiffer than 1500 N/m"),
            std::string::npos);
  EXPECT_EQ(verdict_on(demand, key_limits(), 1).refusal, "");
  demand.least.viscosity = 2.0;
  EXPECT_EQ(verdict_on(demand, key_limits(), 1).uncertainty, "");
  demand.least.viscosity = 0.0;
  EXPECT_EQ(verdict_on(demand, key_limits(), 0).uncertainty, "") << "4 m / T^2 without delay";
}

msg::DeviceDescription description_of(std::uint64_t epoch, double viscosity) {
  msg::DeviceDescription description;
  description.device_id(config::name_hash("keyboard"));
  description.device("keyboard");
  description.driver("kfb1");
  description.epoch(epoch);
  description.rate_hz(1000.0);
  description.moving_mass_kg(0.3);
  description.viscosity_n_s_per_m(viscosity);
  description.stiffness_limit_n_per_m(0.0);
  description.damping_limit_n_s_per_m(0.0);
  description.delay_periods(0);
  return description;
}

TEST(RefusedDevices, AreThoseThatCannotBearTheSceneWhicheverComesFirst) {
  RefusedDevices devices(1);
  devices.receive(description_of(1, 1.5));
  devices.play(walls_of("501"));
  devices.receive(description_of(2, 3.0));  // supports 2001 N/m

  EXPECT_TRUE(devices.refuses(1));
  EXPECT_FALSE(devices.refuses(2));
  EXPECT_NE(devices.text().find("supports 1001 N/m"), std::string::npos) << devices.text();

  devices.receive(description_of(3, 1.0));
  EXPECT_TRUE(devices.refuses(3));

  devices.play(walls_of("100"));
  EXPECT_FALSE(devices.refuses(1));
  EXPECT_FALSE(devices.refuses(3));
  EXPECT_EQ(devices.text(), "");
}

TEST(RefusedDevices, ObjectToASceneInWhichTheyWouldLoseTheirForce) {
  RefusedDevices devices(1);
  devices.play(walls_of("100"));
  devices.receive(description_of(1, 1.5));  // supports 1001 N/m
  devices.receive(description_of(2, 3.0));  // supports 2001 N/m

  EXPECT_EQ(devices.objection_to(walls_of("500")), "");
  const std::string why = devices.objection_to(walls_of("501"));
  EXPECT_NE(why.find("supports 1001 N/m"), std::string::npos) << why;
  EXPECT_EQ(why.find("supports 2001 N/m"), std::string::npos) << why;
  EXPECT_FALSE(devices.refuses(1)) << "the scene was not played";

  devices.play(walls_of("501"));
  EXPECT_EQ(devices.objection_to(walls_of("502")), "") << "it has no force already";
}

constexpr std::int64_t kSecondOfWall = 1'000'000'000;

/// Devices of a session in real time, and what they measure.
struct MeasuredDevices {
  std::unique_ptr<AnswerDelays> delays = std::make_unique<AnswerDelays>();
  RefusedDevices devices{1.0, delays.get()};
  std::uint64_t answers = 0;
  std::int64_t now_nsec = node::monotonic_nsec();

  /// So many seconds of answers to a process that take so long.
  void play(int seconds, double delay_s, std::uint64_t epoch = 1) {
    for (int i = 0; i < 4 * seconds; ++i) {
      for (int n = 0; n < 250; ++n) {
        ++answers;
        delays->record(epoch, {answers, answers, delay_s}, now_nsec);
      }
      static_cast<void>(refuses(epoch));
      devices.measure(now_nsec += kSecondOfWall / 4);
    }
  }
  void join(std::uint64_t epoch, double viscosity = 1.5) {
    EXPECT_TRUE(devices.receive(description_of(epoch, viscosity), now_nsec));
  }
  bool refuses(std::uint64_t epoch) { return devices.refuses(epoch, now_nsec); }
};

TEST(RefusedDevices, AreSupportedOnceTheirAnswersAreMeasuredFastEnough) {
  MeasuredDevices session;
  RefusedDevices& devices = session.devices;
  devices.receive(description_of(1, 1.5));  // 1.5 / (T/2 + d T)
  devices.play(walls_of("800"));            // two of them: d < 0.44

  EXPECT_TRUE(session.refuses(1));
  EXPECT_NE(devices.text().find("supports 1001 N/m"), std::string::npos) << devices.text();
  EXPECT_NE(devices.text().find("needs an answer within 438 us; one period is assumed until 1000 "
                                "answers are measured"),
            std::string::npos)
      << devices.text();
  session.play(1, 0.2e-3);
  EXPECT_FALSE(session.refuses(1));
  EXPECT_EQ(devices.text(), "");
  ASSERT_EQ(devices.loops().size(), 1u);
  EXPECT_EQ(devices.loops()[0].device, "keyboard");
  EXPECT_NEAR(devices.loops()[0].answer_delay_s.value(), 0.22e-3, 0.01e-3)
      << "what is measured, and the room that the limits have";
  // b / (T/2 + 1.1 d T), d as the upper end of its bin
  EXPECT_NEAR(devices.loops()[0].supported_stiffness.value(), 2070.0, 50.0);
}

/// In slow motion nothing is measured, for longer than a measurement counts.
TEST(RefusedDevices, KeepTheirDelayWhileNothingIsMeasured) {
  MeasuredDevices session;
  session.devices.receive(description_of(1, 1.5));
  session.devices.play(walls_of("800"));
  session.play(1, 0.2e-3);
  ASSERT_FALSE(session.refuses(1));

  for (int i = 0; i < 120; ++i) {
    session.devices.measure(session.now_nsec += kSecondOfWall / 4, false);
    ASSERT_FALSE(session.refuses(1)) << i;
  }
  session.devices.measure(session.now_nsec += kSecondOfWall / 4);
  EXPECT_FALSE(session.refuses(1)) << "nor at the end of slow motion";

  for (int i = 0; i < 60; ++i) session.devices.measure(session.now_nsec += kSecondOfWall / 4);
  EXPECT_TRUE(session.refuses(1)) << "what is measured still ages";
}

TEST(RefusedDevices, OfAnotherHostAreThoseWhoseLinkIsNotMeasuredYet) {
  MeasuredDevices session;
  RefusedDevices& devices = session.devices;
  devices.play(walls_of("100"));  // two of them: d < 7
  EXPECT_TRUE(devices.receive(description_of(1, 1.5), session.now_nsec));
  EXPECT_TRUE(devices.receive(description_of(2, 1.5), session.now_nsec, true));
  EXPECT_TRUE(devices.receive(description_of(3, 1.5), session.now_nsec, true));

  EXPECT_FALSE(session.refuses(1)) << "of this host one period is assumed";
  EXPECT_TRUE(session.refuses(2));
  EXPECT_NE(devices.text().find("needs an answer within 70"), std::string::npos) << devices.text();
  EXPECT_NE(devices.text().find("the device 'keyboard' runs on another host: no force until 1000 "
                                "answers are measured"),
            std::string::npos)
      << devices.text();

  session.play(1, 5e-3, 2);
  EXPECT_FALSE(session.refuses(2));
  session.play(1, 8e-3, 3);
  EXPECT_TRUE(session.refuses(3));
  EXPECT_NE(devices.text().find("its answers take 8"), std::string::npos) << devices.text();

  session.play(20, 5e-3, 1);  // nothing of the others: beyond all windows
  EXPECT_FALSE(session.refuses(2)) << "it counts what was measured last";
}

TEST(RefusedDevices, OfAnotherHostPlayAtOnceWhatAnyLinkPermits) {
  MeasuredDevices session;
  session.devices.play(walls_of("3"));  // 6 N/m: 1.5 / 200.5 ms is more
  EXPECT_TRUE(session.devices.receive(description_of(1, 1.5), session.now_nsec, true));

  EXPECT_FALSE(session.refuses(1));
  EXPECT_EQ(session.devices.text(), "");
}

TEST(RefusedDevices, AreThoseWhoseAnswersTakeLongerNowUntilTheyAreCalmAgain) {
  MeasuredDevices session;
  RefusedDevices& devices = session.devices;
  devices.play(walls_of("800"));
  devices.receive(description_of(1, 1.5));
  session.play(20, 0.2e-3);
  ASSERT_FALSE(session.refuses(1));

  session.play(1, 0.6e-3);
  EXPECT_TRUE(session.refuses(1));
  EXPECT_NE(devices.text().find("needs an answer within 437 us; its answers take 6"),
            std::string::npos)
      << devices.text();
  int changes = 0;
  bool before = true;
  for (int i = 0; i < 30; ++i) {  // in the middle of its limit
    session.play(1, i % 2 == 0 ? 0.5e-3 : 0.35e-3);
    changes += session.refuses(1) != before;
    before = session.refuses(1);
  }
  EXPECT_EQ(changes, 0);
  session.play(21, 0.2e-3);
  EXPECT_FALSE(session.refuses(1));
}

TEST(RefusedDevices, SayWhichAnswersTakeLongerThanAPeriod) {
  MeasuredDevices session;
  session.devices.play(walls_of("100"));
  session.devices.receive(description_of(1, 1.5));
  session.play(1, 2e-3);

  EXPECT_FALSE(session.refuses(1)) << "1.5 / 2.7 ms = 556 N/m";
  EXPECT_NE(session.devices.text().find("the answers to the device 'keyboard' take 2."),
            std::string::npos)
      << session.devices.text();
  EXPECT_NE(session.devices.text().find("periods, and it supports 5"), std::string::npos)
      << session.devices.text();
}

TEST(RefusedDevices, AreNotThoseThatAnswerWithinThePeriodThatWasAssumed) {
  MeasuredDevices session;
  session.devices.play(walls_of("480"));  // 960 N/m; the limit of one period is 1001 N/m
  session.join(1);
  ASSERT_FALSE(session.refuses(1));
  session.play(3, 1.01e-3);
  EXPECT_FALSE(session.refuses(1));
  EXPECT_EQ(session.devices.text(), "");
}

TEST(RefusedDevices, ANewProcessOfADeviceIsMeasuredAnew) {
  MeasuredDevices session;
  session.devices.play(walls_of("800"));
  session.devices.receive(description_of(1, 1.5));
  session.play(2, 0.1e-3);
  ASSERT_FALSE(session.refuses(1));

  session.join(2);
  session.play(20, 0.1e-3);  // beyond all windows
  EXPECT_TRUE(session.refuses(2));
  EXPECT_FALSE(session.refuses(1));

  session.play(2, 0.1e-3, 2);
  EXPECT_FALSE(session.refuses(2));
}

TEST(RefusedDevices, AreNotReportedWhenTheyHaveEndedOrStandBy) {
  MeasuredDevices session;
  session.devices.play(walls_of("800"));
  session.join(1);
  session.play(2, 0.1e-3);
  session.join(2);  // a standby: nothing of it comes
  EXPECT_NE(session.devices.text(), "") << "it may play at once";
  session.play(3, 0.1e-3);
  EXPECT_EQ(session.devices.text(), "");
  EXPECT_NE(session.devices.loops_text().find("is answered within 1"), std::string::npos)
      << session.devices.loops_text();
  EXPECT_TRUE(session.refuses(2)) << "it is not measured";

  session.play(2, 0.1e-3, 2);  // it takes over, and the first one has ended
  session.play(1, 0.1e-3, 2);
  EXPECT_EQ(session.devices.text(), "");
  ASSERT_EQ(session.devices.loops().size(), 1u);
  EXPECT_EQ(session.devices.loops()[0].epoch, 2u);
}

TEST(RefusedDevices, ARefusalOutlivesAnyNumberOfOtherDescriptions) {
  MeasuredDevices session;
  session.devices.play(walls_of("501"));  // the limit is 1001 N/m
  session.join(1, 1.5);
  for (std::uint64_t epoch = 100; epoch < 180; ++epoch) {
    session.join(epoch, epoch % 2 == 0 ? 3.0 : 1.5);
    session.now_nsec += 1000;
    ASSERT_TRUE(session.refuses(1)) << epoch;
    ASSERT_EQ(session.refuses(epoch), epoch % 2 != 0) << "every one of them";
  }
  EXPECT_TRUE(session.refuses(100)) << "forgotten: it has not described itself";
  EXPECT_TRUE(session.refuses(9999)) << "never described";
}

TEST(RefusedDevices, AStandbyThatIsThereIsKeptHoweverOftenOthersRestart) {
  MeasuredDevices session;
  session.devices.play(walls_of("501"));  // the limit is 1001 N/m
  session.join(1, 3.0);
  const auto restarts =
      static_cast<std::uint64_t>(std::max(test::rounds(200), 70));  // more than are known at once
  const auto restart_others = [&](std::uint64_t first, bool is_kept) {
    for (std::uint64_t epoch = first; epoch < first + restarts; ++epoch) {
      session.join(epoch, 1.5);
      session.now_nsec += 1000;
      if (is_kept) session.devices.keep(1, session.now_nsec);
    }
  };
  restart_others(100, true);
  EXPECT_FALSE(session.refuses(1)) << "it takes over";

  session.now_nsec += 1000;
  restart_others(300, false);
  EXPECT_TRUE(session.refuses(1)) << "it has ended, and is forgotten";
}

TEST(RefusedDevices, ARefusedOneIsNeverLetThroughWhileOthersAreChecked) {
  RefusedDevices devices(1);
  devices.play(walls_of("501"));
  for (std::uint64_t epoch = 1; epoch <= 8; ++epoch) devices.receive(description_of(epoch, 1.0));
  std::atomic<bool> ending{false};
  std::atomic<std::uint64_t> asked{0};
  std::uint64_t let_through = 0;
  std::thread loop([&] {
    while (!ending) {
      for (std::uint64_t epoch = 1; epoch <= 8; ++epoch) let_through += !devices.refuses(epoch);
      ++asked;
    }
  });
  // Every second description is of one that is supported, and every second scene is another one.
  for (std::uint64_t epoch = 10; epoch < 20; ++epoch) {
    const std::uint64_t before = asked;
    devices.receive(description_of(epoch, epoch % 2 == 0 ? 3.0 : 1.0));
    devices.play(walls_of(epoch % 2 == 0 ? "600" : "501"));
    while (asked < before + 2) std::this_thread::yield();
  }
  ending = true;
  loop.join();
  EXPECT_EQ(let_through, 0u);
}

TEST(PortCheck, SaysHowFastAnAnswerMustBe) {
  const PortDemand demand = demands_of(walls_of("800")).at(0);
  const double most = largest_supported_delay(demand, key_limits(), 1.0).value();

  EXPECT_EQ(verdict_on(demand, key_limits(), most).refusal, "");
  EXPECT_NE(verdict_on(demand, key_limits(), 1.01 * most).refusal, "");
  EXPECT_EQ(largest_supported_delay(demand, key_limits(), 0.3), 0.3);
  EXPECT_FALSE(largest_supported_delay(demands_of(walls_of("1600")).at(0), key_limits(), 1.0))
      << "3003 N/m without delay";
}

TEST(RefusedDevices, AreThoseWithoutWhatAPortNeeds) {
  RefusedDevices devices(1);
  devices.play(walls_of("1", ", needs: {travel_m: 0.05, force_n: 5}"));
  msg::DeviceDescription description = description_of(1, 1.5);
  description.travel_m()[0] = 0.05;
  description.force_n()[0] = 5.0;
  devices.receive(description);
  EXPECT_EQ(devices.text(), "");

  description.epoch(2);
  description.travel_m()[0] = 0.04;
  description.force_n()[0] = 4.0;
  devices.receive(description);
  EXPECT_FALSE(devices.refuses(1));
  EXPECT_TRUE(devices.refuses(2));
  EXPECT_EQ(devices.text(),
            "port 'key' needs a travel of 0.05 m, and axis 0 of the device 'keyboard' has 0.04 m; "
            "port 'key' needs a force of 5 N, and axis 0 of the device 'keyboard' has 4 N: driver "
            "kfb1 is given no force");

  description.travel_m()[0] = 0.03;
  description.travel_m()[1] = std::nan("");
  description.epoch(3);
  devices.receive(description);
  EXPECT_EQ(devices.text().find("0.03"), std::string::npos) << "a number that makes no sense";
  EXPECT_TRUE(devices.refuses(3)) << "it has not described itself";
}

TEST(RefusedDevices, DoNotBelieveNumbersThatMakeNoSense) {
  RefusedDevices devices(1);
  devices.play(walls_of("501"));
  for (const double bad : {std::nan(""), -1.0, HUGE_VAL}) {
    devices.receive(description_of(1, bad));
    msg::DeviceDescription description = description_of(1, 1.0);
    description.rate_hz(bad);
    devices.receive(description);
    description = description_of(1, 1.0);
    description.moving_mass_kg(bad);
    devices.receive(description);
  }
  EXPECT_EQ(devices.text(), "");
  EXPECT_TRUE(devices.loops().empty());
  EXPECT_TRUE(devices.refuses(1)) << "it has not described itself";
}

}  // namespace
}  // namespace cordis::sim
