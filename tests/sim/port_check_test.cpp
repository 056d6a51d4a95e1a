// tests/sim/port_check_test.cpp -- devices that cannot bear a scene, in the launch and joining
// late.
#include "sim_node/port_check.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "node/config/mapping_reader.h"
#include "node/config/name_hash.h"
#include "sim_node/refused_devices.h"

namespace cordis::sim {
namespace {

/// Two walls at one key.
scene::Scene walls_of(const std::string& stiffness) {
  config::Problems problems;
  scene::Scene scene = scene::load_scene_text(
      "cordis: 1\nspace: 1\nstep: {rate_hz: 1000}\n"
      "matter:\n  ground: {kind: fixed, at_m: 0}\n  bob: {kind: mass, mass_kg: 1, at_m: 0}\n"
      "liaisons:\n  wall: {kind: spring, stiffness_n_per_m: " +
          stiffness +
          "}\nports:\n  key: {device: keyboard, axes: 0, role: mass, at_m: 0, coupling: direct}\n"
          "links:\n  - {liaison: wall, between: [key, ground]}\n"
          "  - {liaison: wall, between: [key, bob]}\n",
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

PortVerdict verdict(const scene::Scene& scene, const config::DeviceLimits& limits, int delay) {
  return verdict_on(demands_of(scene).at(0), limits, delay);
}

TEST(PortCheck, RefusesASceneStifferThanItsPortWithTheNumberItMayHave) {
  const scene::Scene soft = walls_of("500");  // two of them: 1000 N/m; the limit is 1001 N/m
  const scene::Scene stiff = walls_of("501");

  EXPECT_EQ(verdict(soft, key_limits(), 1).refusal, "");
  const std::string refusal = verdict(stiff, key_limits(), 1).refusal;
  EXPECT_NE(refusal.find("as stiff as 1002 N/m"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("can bear 1001 N/m"), std::string::npos) << refusal;
  EXPECT_EQ(verdict(stiff, key_limits(), 0).refusal, "") << "3003 N/m without delay";
}

TEST(PortCheck, AHandleIsAsLightAsItsLeversMakeIt) {
  config::Problems problems;
  const config::Value file = config::load_text(
      "{axes: 2, moving_mass_kg: 2.4, viscosity_n_s_per_m: 12, end_piece: {map: [[2, -2], [0.5, "
      "0.5]]}}",
      "d", problems);
  config::MappingReader reader(file, "device", problems);
  const config::DeviceLimits limits = config::read_device_limits(reader);

  // q = 2 (x0 - x1): a mass of 2.4 kg behind a ratio of 2 at either end weighs 1/8 of it.
  EXPECT_EQ(limits.leverage, 8.0);
  EXPECT_DOUBLE_EQ(limits.coordinate_mass_kg(), 0.3);
  const std::string refusal = verdict(walls_of("501"), limits, 1).refusal;
  EXPECT_NE(refusal.find("can bear 1001 N/m"), std::string::npos) << refusal;
}

TEST(PortCheck, KnowsNothingOfADeviceThatDeclaresNothing) {
  EXPECT_EQ(verdict(walls_of("1e6"), config::DeviceLimits{}, 1).refusal, "");
}

TEST(PortCheck, TakesADeclaredLimitAtItsWord) {
  config::DeviceLimits limits = key_limits();
  limits.stiffness_limit_n_per_m = 150.0;

  EXPECT_NE(verdict(walls_of("100"), limits, 0).refusal.find("can bear 150 N/m"),
            std::string::npos);
}

TEST(PortCheck, DoubtsASetThatMayMeetTheDeviceManyTimesAtOnce) {
  PortDemand demand;
  demand.port = "finger";
  demand.device = "thimble";
  demand.least = {300.0, 0.0};
  demand.most = {1800.0, 0.0};

  const PortVerdict verdict = verdict_on(demand, key_limits(), 1);

  EXPECT_EQ(verdict.refusal, "");
  EXPECT_NE(verdict.doubt.find("may become as stiff as 1800 N/m"), std::string::npos)
      << verdict.doubt;
}

TEST(PortCheck, DoubtsAPortOfRoleLiaisonWhoseViscosityIsLittleForAFingertip) {
  PortDemand demand;
  demand.port = "bow";
  demand.device = "keyboard";
  demand.role = scene::Role::kLiaison;
  demand.mass = 0.1;
  demand.least = {0.0, 1.5};  // 1.5 N s/m over 1 ms: 1500 N/m

  EXPECT_NE(verdict_on(demand, key_limits(), 1).doubt.find("is stiffer than 1500 N/m"),
            std::string::npos);
  EXPECT_EQ(verdict_on(demand, key_limits(), 1).refusal, "");
  demand.least.viscosity = 2.0;
  EXPECT_EQ(verdict_on(demand, key_limits(), 1).doubt, "");
  demand.least.viscosity = 0.0;
  EXPECT_EQ(verdict_on(demand, key_limits(), 0).doubt, "") << "4 m / T^2 without delay";
}

msg::DeviceDescription description(std::uint64_t run, double viscosity) {
  msg::DeviceDescription told;
  told.device_id(config::name_hash("keyboard"));
  told.device("keyboard");
  told.driver("kfb1");
  told.run(run);
  told.rate_hz(1000.0);
  told.moving_mass_kg(0.3);
  told.viscosity_n_s_per_m(viscosity);
  told.stiffness_limit_n_per_m(0.0);
  told.damping_limit_n_s_per_m(0.0);
  told.delay_periods(0);
  return told;
}

TEST(RefusedDevices, AreThoseThatCannotBearTheSceneWhicheverComesFirst) {
  RefusedDevices devices(1);
  devices.hear(description(1, 1.5));
  devices.play(walls_of("501"));
  devices.hear(description(2, 3.0));  // bears 2001 N/m

  EXPECT_TRUE(devices.refuses(1));
  EXPECT_FALSE(devices.refuses(2));
  EXPECT_NE(devices.text().find("can bear 1001 N/m"), std::string::npos) << devices.text();

  devices.hear(description(3, 1.0));
  EXPECT_TRUE(devices.refuses(3));

  devices.play(walls_of("100"));
  EXPECT_FALSE(devices.refuses(1));
  EXPECT_FALSE(devices.refuses(3));
  EXPECT_EQ(devices.text(), "");
}

TEST(RefusedDevices, DoNotBelieveNumbersThatMakeNoSense) {
  RefusedDevices devices(1);
  devices.play(walls_of("501"));
  for (const double bad : {std::nan(""), -1.0, HUGE_VAL}) {
    devices.hear(description(1, bad));
    msg::DeviceDescription told = description(1, 1.0);
    told.rate_hz(bad);
    devices.hear(told);
    told = description(1, 1.0);
    told.moving_mass_kg(bad);
    devices.hear(told);
  }
  EXPECT_FALSE(devices.refuses(1));
}

}  // namespace
}  // namespace cordis::sim
