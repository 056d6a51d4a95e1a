// tests/reduction/dimension_test.cpp
#include <cmath>

#include "tests/reduction/scenes.h"

namespace cordis::plan {
namespace {

/// A net in the plane y = 0.3 m, with balls and a port in it.
std::string in_a_plane(const std::string& gravity, const std::string& more = {}) {
  return R"(cordis: 1
space: 3
step: {rate_hz: 1000}
reduce: [dimension]
world: {gravity_m_per_s2: )" +
         gravity +
         R"(}
liaisons:
  push: {states: {on: {stiffness_n_per_m: 200, pulls: false, final: true}}}
  s: {kind: spring_damper, stiffness_n_per_m: 60, viscosity_n_s_per_m: 0.01}
  thread: {states: {taut: {stiffness_n_per_m: 50, pushes: false, final: true}}}
matter:
  net: {kind: grid, rows: 4, columns: 5, corner_m: [0, 0.3, 0], spacing_m: 0.1, plane: xz,
        border: corners, mass_kg: 0.01, stiffness_n_per_m: 50, rest_m: 0.09}
  balls: {kind: mass, ball: {mass_kg: 0.01, radius_m: 0.02},
          at_m: [[0.1, 0.3, 0.55], [0.21, 0.3, 0.62], [0.2, 0.3, 0.7]]}
ports:
  key: {device: k, axes: [0], role: mass, at_m: [0, 0.3, 1], along: z}
links:
  - {liaison: push, within: balls, range: rest}
  - {liaison: s, between: [key, "balls[2]"]}
  - {liaison: thread, between: ["net[7]", "balls[0]"], rest_m: 0.2}
)" + more +
         R"(signals:
  height: {of: "net[7]", quantity: position, axis: z}
  aside: {of: "net[7]", quantity: position, axis: y}
  moved: {of: key, quantity: position}
)";
}

TEST(Dimension, APlaneOf3DIsComputedIn2DToTheBit) {
  std::string text = in_a_plane("[0, 0, -9.81]");
  text.replace(text.find("range: rest"), 11, "range_m: 0.04");
  const scene::Scene whole = loaded(text);
  const scene::Scene scene = reduced(text);

  ASSERT_EQ(scene.space(), 2);
  ASSERT_TRUE(scene.subspace.has_value());
  EXPECT_EQ(scene.subspace->space, 3);
  EXPECT_EQ(scene.subspace->origin, engine::Vec3(0, 0.3, 0));
  for (const char* name : {"net", "balls"}) {
    const auto before = motion(whole, name, 1000);
    const auto after = motion(scene, name, 1000);
    EXPECT_GT(largest_distance(before), 0.1);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_EQ(before[i], engine::Vec3(after[i].x(), 0.3, after[i].y())) << name << " " << i;
    }
  }
  EXPECT_EQ(signals_after(whole, 500), signals_after(scene, 500));
  EXPECT_EQ(signals_after(scene, 500)[1], 0.3);
}

TEST(Dimension, AConditionSeesWhatNeverChangesToo) {
  std::string text = with_latch(
      in_a_plane("[0, 0, -9.81]", "  - {liaison: latch, between: [\"net[7]\", \"balls[0]\"]}\n"),
      "net[7].position_y_m > 0.29 and net[7].position_z_m < 0.07");
  text.replace(text.find("range: rest"), 11, "range_m: 0.04");
  const scene::Scene whole = loaded(text);
  const scene::Scene scene = reduced(text);
  ASSERT_EQ(scene.space(), 2);
  const auto opens_after = [](const scene::Scene& played) {
    engine::World world(std::make_shared<const engine::Network>(played.network));
    int steps = 0;
    for (; steps < 500 && world.state_of(1) == 0; ++steps) world.step();
    return steps;
  };
  EXPECT_EQ(opens_after(scene), opens_after(whole));
  EXPECT_LT(opens_after(scene), 500);
  EXPECT_GT(opens_after(scene), 1);
}

TEST(Dimension, ASceneThatMayLeaveItsPlaneStays) {
  std::string text = in_a_plane("[0, 0, -9.81]");
  text.replace(text.find("range: rest"), 11, "range_m: 0.04");
  EXPECT_EQ(reduced(text).space(), 2);
  const auto with = [&](const std::string& old_text, const std::string& new_text) {
    std::string changed = text;
    changed.replace(changed.find(old_text), old_text.size(), new_text);
    return reduced(changed).space();
  };
  EXPECT_EQ(with("[0, 0, -9.81]", "[0, 1e-9, -9.81]"), 3);
  EXPECT_EQ(with("[0.1, 0.3, 0.55]", "[0.1, 0.300001, 0.55]"), 3);
  EXPECT_EQ(with("along: z", "along: [0, 0.1, 1]"), 3);
  EXPECT_EQ(with("ball: {mass_kg: 0.01, radius_m: 0.02},",
                 "ball: {mass_kg: 0.01, radius_m: 0.02}, velocity_m_per_s: [0, 0.1, 0],"),
            3);
  EXPECT_EQ(with("{taut: {stiffness_n_per_m: 50, pushes: false, final: true}}",
                 "{taut: {stiffness_n_per_m: 50, exits: [{to: off, when: speed_y_m_per_s > 1}]}, "
                 "off: {final: true}}"),
            3);
}

/// Three masses on the line y = 1 m, springs of this rest length between them.
std::string on_a_line(const std::string& rest, const std::string& more = {}) {
  return R"(cordis: 1
space: 2
step: {rate_hz: 1000}
reduce: all
liaisons:
  s: {kind: spring_damper, stiffness_n_per_m: 20, viscosity_n_s_per_m: 0.01, rest_m: )" +
         rest +
         R"(}
  m: {kind: maxwell, stiffness_n_per_m: 20, viscosity_n_s_per_m: 0.1}
  push: {states: {on: {stiffness_n_per_m: 200, pulls: false, final: true}}}
matter:
  wall: {kind: fixed, at_m: [-0.3, 1]}
  bobs: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.05}, at_m: [[0, 1], [0.2, 1], [0.5, 1]]}
  fast: {kind: mass, mass_kg: 0.1, at_m: [0.6, 1], velocity_m_per_s: [-3, 0]}
links:
  - {liaison: s, between: [wall, "bobs[0]"]}
  - {liaison: s, between: ["bobs[2]", "bobs[1]"]}
  - {liaison: s, between: [fast, "bobs[1]"]}
  - {liaison: m, between: [wall, fast]}
  - {liaison: push, within: bobs, range_m: 0.1}
)" + more;
}

/// In space a bend has no sign, in a plane it has one.
TEST(Dimension, ASceneThatAsksForAnAngleStaysInSpace) {
  const auto scene_of = [](const std::string& liaison, const std::string& signal) {
    return R"(cordis: 1
space: 3
step: {rate_hz: 20000}
reduce: [dimension]
world: {gravity_m_per_s2: [0, 9.81, 0]}
matter:
  strip: {kind: string, count: 4, mass_kg: 0.02, from_m: [0, 1, 0], to_m: [0.15, 1, 0], ends: first_fixed, stiffness_n_per_m: 5000}
liaisons:
  tin: {kind: bending, )" +
           liaison +
           R"(}
links:
  - {liaison: tin, along: strip, name: s}
signals:
  shown: {)" +
           signal + "}\n";
  };
  const std::string of_place = "of: \"strip[3]\", quantity: position, axis: y";
  const std::string yields =
      "states: {whole: {stiffness_n_m_per_rad: 0.01, exits: [{to: limp, when: bend_rad > 0.1}]}, "
      "limp: {final: true}}";
  EXPECT_EQ(reduced(scene_of(yields, of_place)).space(), 3);
  EXPECT_EQ(reduced(scene_of("elasticity: bend_rad", "of: \"s[0]\", quantity: moment")).space(), 3);
  EXPECT_EQ(reduced(scene_of("elasticity: bend_rad", "of: \"s[0]\", quantity: speed")).space(), 3);
  // A law alone acts alike in both.
  const std::string stop = scene_of("elasticity: \"max(bend_rad - 0.05, 0)\"", of_place);
  ASSERT_EQ(reduced(stop).space(), 2);
  EXPECT_EQ(signals_after(loaded(stop), 2000), signals_after(reduced(stop), 2000));
}

TEST(Dimension, ALineIsComputedIn1DWhereTheSignOfItsLinksMakesNoDifference) {
  const scene::Scene whole = loaded(on_a_line("0"));
  const scene::Scene scene = reduced(on_a_line("0"));

  ASSERT_EQ(scene.space(), 1);
  EXPECT_EQ(scene.subspace->origin, engine::Vec3(0, 1, 0));
  for (const char* name : {"bobs", "fast"}) {
    const auto before = motion(whole, name, 2000);
    auto after = motion(scene, name, 2000);
    for (engine::Vec3& place : after) place.y() = 1.0;
    EXPECT_GT(largest_distance(before), 0.3) << name;  // it passes the others
    EXPECT_LT(largest_difference(before, after), 1e-9) << name;
  }
}

TEST(Dimension, ALineStaysWhereTheSignWouldMakeADifference) {
  EXPECT_EQ(reduced(on_a_line("0.1")).space(), 2);
  EXPECT_EQ(reduced(on_a_line("0", "  - {liaison: push, between: [fast, wall]}\n")).space(), 2);
  std::string together = on_a_line("0");  // there is no direction, and so no force, but in 1-D
  together.replace(together.find("[0.6, 1], velocity"), 8, "[0.2, 1]");
  EXPECT_EQ(reduced(together).space(), 2);
  std::string named = on_a_line("0");
  named.replace(named.find("[fast, \"bobs[1]\"]"), 17, "[fast, \"bobs[1]\"], name: it");
  EXPECT_EQ(reduced(named + "signals: {d: {of: it, quantity: distance}}\n").space(), 2);
}

}  // namespace
}  // namespace cordis::plan
