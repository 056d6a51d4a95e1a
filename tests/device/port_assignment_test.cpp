// tests/device/port_assignment_test.cpp
#include "device_node/port_assignment.h"

#include <gtest/gtest.h>

#include "device_node/drivers/script.h"

namespace cordis::device {
namespace {

constexpr std::uint32_t kId = 4711;

DeviceConfig keyboard_of(int axes) {
  DeviceConfig config;
  config.name = "keyboard";
  config.device_id = kId;
  config.driver = "script";
  config.layout.count = axes;
  config.end_effector_map = EndEffectorMap(axes);
  return config;
}

msg::PortDescription port(const std::string& name, std::uint32_t device_id, std::uint32_t role,
                          std::vector<std::uint32_t> axes) {
  msg::PortDescription description;
  description.name(name);
  description.device_id(device_id);
  description.role(static_cast<msg::PortRole>(role));
  description.axes(std::move(axes));
  return description;
}

msg::SceneDescription scene_with(std::vector<msg::PortDescription> ports) {
  msg::SceneDescription scene;
  scene.name("strings");
  scene.gesture_rate_hz(1000.0);
  scene.ports(std::move(ports));
  return scene;
}

PortAssignment part_in(const msg::SceneDescription& scene, int axes = 2) {
  const Trajectory rest;
  const Script driver({rest}, {rest}, 1000.0);
  return part_of(scene, keyboard_of(axes), driver);
}

TEST(PortAssignment, IsTheRoleOfThePortsWithItsId) {
  const PortAssignment mass =
      part_in(scene_with({port("left", 1, 1, {9}), port("right", kId, 0, {0, 1})}));
  EXPECT_TRUE(mass.wanted);
  EXPECT_EQ(mass.role, Role::kMass);
  EXPECT_EQ(mass.impossible, "");
  EXPECT_EQ(mass.questionable, "");

  EXPECT_EQ(part_in(scene_with({port("a", kId, 1, {0}), port("b", kId, 1, {1})})).role,
            Role::kLiaison);
}

TEST(PortAssignment, IsNotWantedInAScenesOfOthers) {
  EXPECT_FALSE(part_in(scene_with({port("left", 1, 0, {0})})).wanted);
  EXPECT_FALSE(part_in(scene_with({})).wanted);
}

TEST(PortAssignment, IsImpossibleWithAnAxisTheDeviceDoesNotHave) {
  EXPECT_EQ(
      part_in(scene_with({port("hand", kId, 0, {0, 2})})).impossible,
      "scene 'strings': port 'hand' wants axis 2 of device 'keyboard', which has 2 (axes 0 to "
      "1)");
  EXPECT_EQ(part_in(scene_with({port("hand", kId, 0, {4294967295u})})).impossible.empty(), false);
}

TEST(PortAssignment, IsImpossibleWithTwoRolesOrAnUnknownOne) {
  EXPECT_EQ(
      part_in(scene_with({port("a", kId, 0, {0}), port("b", kId, 1, {1})})).impossible,
      "scene 'strings': port 'b' gives device 'keyboard' role liaison, another port role mass");
  EXPECT_EQ(part_in(scene_with({port("a", kId, 7, {0})})).impossible,
            "scene 'strings': port 'a' gives device 'keyboard' the unknown role 7");
}

TEST(PortAssignment, IsImpossibleWhenTheDriverHasNothingToGive) {
  const Script positions_only({Trajectory()}, {}, 1000.0);
  EXPECT_EQ(
      part_of(scene_with({port("a", kId, 1, {0})}), keyboard_of(1), positions_only).impossible,
      "scene 'strings': device 'keyboard' cannot play role liaison: its driver 'script' has "
      "nothing "
      "to give in it");
}

TEST(PortAssignment, IsQuestionableAtAnotherRate) {
  msg::SceneDescription scene = scene_with({port("a", kId, 0, {0})});
  scene.gesture_rate_hz(500.0);

  const PortAssignment part = part_in(scene);

  EXPECT_EQ(part.impossible, "");
  EXPECT_EQ(part.questionable,
            "scene 'strings' counts on 500 gestures per second, device 'keyboard' gives 1000");
}

}  // namespace
}  // namespace cordis::device
