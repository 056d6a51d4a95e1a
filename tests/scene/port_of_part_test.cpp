// tests/scene/port_of_part_test.cpp -- ports in parts, and one for each copy.
#include <cmath>

#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

constexpr const char* kKeys = R"(liaisons:
  hit: {kind: spring, stiffness_n_per_m: 100}
parts:
  key:
    matter: {bar: {kind: mass, mass_kg: 0.1, at_m: [0, 0]}}
    ports: {finger: {device: keyboard, axes: [0], role: mass, at_m: [0, 0.1], along: y, needs: {travel_m: 0.01}}}
    links: [{liaison: hit, between: [finger, bar], name: touch}]
)";

TEST(PortOfPart, IsOneOfEachCopyWithTheNextAxis) {
  const Scene scene = sound_scene(2, std::string(kKeys) + R"(matter:
  keys: {part: key, rotate_deg: 90, repeat: {count: 16, translate_m: [0.05, 0]}}
signals:
  third: {of: "keys[2].finger", quantity: force}
  touch: {of: "keys[2].touch", quantity: force}
)");

  ASSERT_EQ(scene.ports.size(), 16u);
  for (std::uint32_t i = 0; i < 16; ++i) {
    const Port& port = scene.ports[i];
    EXPECT_EQ(port.name, "keys[" + std::to_string(i) + "].finger");
    EXPECT_EQ(port.axes, std::vector<std::uint32_t>{i});
    // turned with all of the row
    EXPECT_LT((port.rest - Vec3(-0.1, 0.05 * i, 0)).norm(), 1e-15);
    EXPECT_LT((port.directions[0] - Vec3(-1, 0, 0)).norm(), 1e-15);
    EXPECT_EQ(scene.network.mats[port.mat].position, port.rest);
    EXPECT_EQ(scene.network.mats[port.mat].kind, engine::MatKind::kPort);
    EXPECT_EQ(scene.network.mats[port.tool].kind, engine::MatKind::kMass);
    EXPECT_EQ(port.needs.travel, 0.01);
  }
  EXPECT_EQ(scene.matter[1].name, "keys[0].finger");
  EXPECT_EQ(scene.matter[2].name, "keys[0].finger.handle");
}

TEST(PortOfPart, CountsTheAxesOfEachDeviceForItself) {
  const Scene scene = sound_scene(2, R"(parts:
  hand:
    ports:
      tip: {device: thimble, axes: [0, 1], role: mass, at_m: [0, 0]}
      foot: {device: pedal, axes: [3], role: liaison, at_m: [0, 1], along: y}
  both:
    matter: {pair: {part: hand, repeat: {count: 2, translate_m: [1, 0]}}}
matter:
  bob: {kind: mass, mass_kg: 1, at_m: [9, 9]}
  all: {part: both, repeat: {count: 2, translate_m: [0, 5]}}
)");

  ASSERT_EQ(scene.ports.size(), 8u);
  for (std::uint32_t copy = 0; copy < 4; ++copy) {
    const Port& tip = scene.ports[2 * copy];
    const Port& foot = scene.ports[2 * copy + 1];
    EXPECT_EQ(tip.axes, (std::vector<std::uint32_t>{2 * copy, 2 * copy + 1})) << copy;
    EXPECT_EQ(foot.axes, std::vector<std::uint32_t>{3 + copy}) << copy;
    EXPECT_EQ(tip.name,
              "all[" + std::to_string(copy / 2) + "].pair[" + std::to_string(copy % 2) + "].tip");
  }
}

TEST(PortOfPart, TakesItsAxisFromAParameter) {
  const Scene scene = sound_scene(1, R"(parts:
  key:
    parameters: {axis: null}
    ports: {finger: {device: keyboard, axes: [$axis], role: mass, layout_at_m: [0.1, 0]}}
matter:
  bob: {kind: mass, mass_kg: 1, at_m: 0}
  low: {part: key, parameters: {axis: 4}}
  high: {part: key, parameters: {axis: 2}, layout_translate_m: [1, 0]}
)");

  ASSERT_EQ(scene.ports.size(), 2u);
  EXPECT_EQ(scene.ports[0].axes, std::vector<std::uint32_t>{4});
  EXPECT_EQ(scene.ports[1].axes, std::vector<std::uint32_t>{2});
  EXPECT_DOUBLE_EQ(scene.layout[scene.ports[1].tool].x, 1.1);
}

class BadPortOfPart : public testing::TestWithParam<BadScene> {};

TEST_P(BadPortOfPart, HasOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Scene, BadPortOfPart,
    testing::Values(
        BadScene{kHead2,
                 R"(parts: {k: {ports: {f: ^{device: d, axes: [0], at_m: [0, 0]}}}}
matter:
  b: {kind: mass, mass_kg: 1, at_m: [9, 9]}
  keys: {part: k, repeat: {count: 16, translate_m: [1, 0]}}
)",
                 "missing key 'role' in port 'f' of part 'k'", "one of mass, liaison"},
        BadScene{
            kHead2,
            R"(parts: {k: {ports: {f: {device: d, axes: [0], role: mass, at_m: [0, 0]}}}}
matter:
  b: {kind: mass, mass_kg: 1, at_m: [9, 9]}
  ^keys: {part: k, repeat: {count: 20, translate_m: [1, 0]}}
)",
            "copy 16 of matter 'keys' takes axis 16 of the device 'd', and a device has axes 0 to "
            "15",
            ""},
        BadScene{
            kHead2,
            R"(parts: {k: {ports: {f: {device: d, axes: [0, 1], role: mass, at_m: [0, 0]}}}}
matter:
  b: {kind: mass, mass_kg: 1, at_m: [9, 9]}
  ^keys: {part: k, repeat: {count: 20, translate_m: [1, 0]}}
)",
            "copy 8 of matter 'keys' takes axis 16 of the device 'd', and a device has axes 0 to "
            "15",
            ""},
        BadScene{kHead2,
                 R"(parts: {k: {ports: {^f: {device: d, axes: [0], role: mass, at_m: [0, 0]}}}}
matter:
  b: {kind: mass, mass_kg: 1, at_m: [9, 9]}
  some: {part: k, repeat: {count: 4, translate_m: [1, 0]}}
  more: {part: k, repeat: {count: 4, translate_m: [1, 0]}}
)",
                 "axis 0 of device 'd' is taken by port 'some[0].f'", ""},
        BadScene{kHead2,
                 R"(parts: {k: ^{links: []}}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "missing key 'matter' in part 'k'", ""}));

}  // namespace
}  // namespace cordis::scene
