// tests/scene/port_test.cpp
#include <memory>

#include <gtest/gtest.h>

#include "node/config/name_hash.h"
#include "sim_node/engine/world.h"
#include "tests/scene/scene_text.h"
#include "tests/support/filled.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

TEST(Port, OfRoleMassIsAMatWhosePositionIsImposed) {
  const Scene scene = scene_with_bob(2, "",
                                     R"(ports:
  key: {device: keyboard, axes: [3], role: mass, coupling: direct, at_m: [1, 2], along: y, drawn_radius_m: 0.5}
)");

  ASSERT_EQ(scene.ports.size(), 1u);
  const Port& port = scene.ports[0];
  EXPECT_EQ(port.name, "key");
  EXPECT_EQ(port.device, "keyboard");
  EXPECT_EQ(port.device_id, config::name_hash("keyboard"));
  EXPECT_EQ(port.role, Role::kMass);
  EXPECT_EQ(port.mat, 1u);
  EXPECT_EQ(port.rest, Vec3(1, 2, 0));
  EXPECT_EQ(port.axes, (std::vector<std::uint32_t>{3}));
  EXPECT_EQ(port.directions, (std::vector<Vec3>{Vec3::UnitY()}));
  EXPECT_EQ(port.place.line, 7);
  EXPECT_EQ(scene.network.mats[1].kind, engine::MatKind::kPort);
  EXPECT_EQ(scene.network.mats[1].position, Vec3(1, 2, 0));
  EXPECT_EQ(scene.radius_m[1], 0.5);
  EXPECT_EQ(scene.matter[1].name, "key");
  EXPECT_EQ(scene.matter[1].first, 1u);
}

TEST(Port, MayBeAllThatMovesInAScene) {
  const Scene scene = sound_scene(1,
                                  R"(matter:
  wall: {kind: fixed, at_m: 0}
liaisons:
  spring: {kind: spring, stiffness_n_per_m: 200}
ports:
  key: {device: keyboard, axes: [0], role: mass, at_m: 0, coupling: direct}
links:
  - {liaison: spring, between: [wall, key]}
)");
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  world.impose_position(scene.ports[0].mat, Vec3(-0.01, 0, 0));
  for (int n = 0; n < 2; ++n) world.step();

  EXPECT_DOUBLE_EQ(world.link_force(scene.ports[0].mat).x(), 2.0);
}

TEST(Port, OfRoleLiaisonIsAMassThatTheDevicePushes) {
  const Scene scene = sound_scene(3,
                                  R"(matter:
  a: {kind: fixed, at_m: [0, 0, 0]}
ports:
  thimble: {device: left, axes: [0, 1, 2], role: liaison, at_m: [1, 2, 3], mass_kg: 0.1}
)");
  EXPECT_EQ(scene.ports[0].role, Role::kLiaison);
  EXPECT_EQ(scene.network.mats[1].kind, engine::MatKind::kMass);
  EXPECT_EQ(scene.network.mats[1].mass, 0.1);
  EXPECT_EQ(scene.ports[0].directions,
            (std::vector<Vec3>{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}));
}

TEST(Port, DirectionsAreUnitVectorsHoweverTheyAreWritten) {
  const auto directions = [](int space, const std::string& along) {
    const std::string place = space == 1 ? "" : space == 2 ? ", at_m: [0, 0]" : ", at_m: [0, 0, 0]";
    const std::size_t axes = space == 1 || along.find("[[") == std::string::npos ? 1 : 2;
    return scene_with_bob(
               space, "",
               "ports:\n  p: {device: d, axes: " + std::string(axes == 1 ? "[0]" : "[0, 1]") +
                   ", role: mass, coupling: direct" + place + ", along: " + along + "}\n")
        .ports.at(0)
        .directions;
  };
  EXPECT_EQ(directions(2, "-y")[0], Vec3(0, -1, 0));
  EXPECT_EQ(directions(2, "[3, 4]")[0], Vec3(0.6, 0.8, 0));
  EXPECT_EQ(directions(3, "[z]")[0], Vec3(0, 0, 1));
  EXPECT_EQ(directions(2, "[[0, 2], [-5, 0]]"), (std::vector<Vec3>{Vec3(0, 1, 0), Vec3(-1, 0, 0)}));
  EXPECT_EQ(directions(1, "-2")[0], Vec3(-1, 0, 0));
  EXPECT_EQ(directions(1, "[-2]")[0], Vec3(-1, 0, 0));
}

TEST(Port, SeveralPortsShareADevice) {
  const Scene scene = scene_with_bob(2, "",
                                     R"(ports:
  left: {device: thimbles, axes: [0, 1], role: mass, coupling: direct, at_m: [0, 0]}
  right: {device: thimbles, axes: [2, 3], role: mass, coupling: direct, at_m: [1, 0]}
  key: {device: keyboard, axes: 0, role: liaison, at_m: [1, 0], mass_kg: 1}
)");
  EXPECT_EQ(scene.ports.size(), 3u);
  EXPECT_EQ(scene.ports[1].mat, 2u);
}

TEST(Port, IsShownBesideTheFirstMatItIsLinkedToInOneDimension) {
  const Scene scene = sound_scene(1,
                                  R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 1}
matter:
  a: {kind: string, count: 5, mass_kg: 1, stiffness_n_per_m: 1, layout_spacing_m: 1}
ports:
  p: {device: d, axes: [0], role: mass, coupling: direct}
  q: {device: d, axes: [1], role: mass, coupling: direct, layout_at_m: [7, 8]}
links:
  - {liaison: s, between: [p, "a[3]"]}
  - {liaison: s, between: [q, "a[3]"]}
)");
  EXPECT_EQ(scene.layout[5].x, 3.0);
  EXPECT_EQ(scene.layout[6].x, 7.0);
  EXPECT_EQ(scene.layout[6].z, 8.0);
}

TEST(Port, ACouplingPutsAToolBetweenTheDeviceAndTheScene) {
  const Scene scene = scene_with_bob(2, "  ground: {kind: fixed, at_m: [0, 0]}\n",
                                     R"(liaisons:
  wall: {kind: spring, stiffness_n_per_m: 9000}
ports:
  key: {device: keyboard, axes: 0, role: mass, at_m: [1, 2], along: y,
        coupling: {stiffness_n_per_m: 300, viscosity_n_s_per_m: 2, mass_kg: 0.2}}
links:
  - {liaison: wall, between: [key, ground]}
signals:
  hand: {of: key.handle, quantity: force}
  tool: {of: key, quantity: position}
)");

  const Port& port = scene.ports.at(0);
  EXPECT_EQ(scene.network.mats[port.mat].kind, engine::MatKind::kPort);
  EXPECT_EQ(scene.network.mats[port.tool].kind, engine::MatKind::kMass);
  EXPECT_EQ(scene.network.mats[port.tool].mass, 0.2);
  EXPECT_EQ(scene.network.mats[port.tool].position, Vec3(1, 2, 0));
  ASSERT_EQ(scene.network.links.size(), 2u);
  EXPECT_EQ(scene.network.links[0].stiffness, 300.0);
  EXPECT_EQ(scene.network.links[0].viscosity, 2.0);
  EXPECT_EQ(scene.network.links[0].rest_length, 0.0);
  EXPECT_TRUE(scene.network.links[0].isotropic) << "else the tool circles its handle";
  const engine::Link& wall = scene.network.links[1];
  EXPECT_EQ(wall.mat_a == port.tool || wall.mat_b == port.tool, true) << "the scene has the tool";
  EXPECT_EQ(scene.links[0].name, "key.coupling");
  EXPECT_EQ(scene.signals.signals()[0].index, port.mat);
  EXPECT_EQ(scene.signals.signals()[1].index, port.tool);
  EXPECT_EQ(scene.signals.signals()[1].direction, Vec3(Vec3::UnitY()));
}

TEST(Port, OfEitherRoleTakesTheSameKeys) {
  const auto port_with = [](const std::string& keys) {
    return scene_with_bob(1, "",
                          test::filled(R"(ports:
  p: {device: d, axes: 0, <keys>}
signals:
  f: {of: p.handle, quantity: force}
)",
                                       {{"keys", keys}}));
  };
  const auto tool_mass = [&](const std::string& keys) {
    const Scene scene = port_with(keys);
    return scene.network.mats[scene.ports.at(0).tool].mass;
  };
  for (const std::string role : {"role: mass", "role: liaison"}) {
    EXPECT_EQ(tool_mass(role), 0.05);
    EXPECT_EQ(tool_mass(role + ", mass_kg: 0.3"), 0.3);
    EXPECT_EQ(tool_mass(role + ", ball: {mass_kg: 0.2, radius_m: 0.01}"), 0.2);
    EXPECT_EQ(tool_mass(role + ", ball: {radius_m: 0.01}"), 0.05);
    EXPECT_EQ(tool_mass(role + ", coupling: {mass_kg: 0.1}"), 0.1);
    const Scene direct = port_with(role + ", coupling: direct, mass_kg: 0.3");
    EXPECT_EQ(direct.ports.at(0).mat, direct.ports.at(0).tool);
    EXPECT_EQ(direct.signals.signals()[0].index, direct.ports.at(0).mat);
  }
}

TEST(Port, ACouplingHasDefaultsAndMayBeRefusedInAWord) {
  const auto links_with = [](const std::string& coupling) {
    return scene_with_bob(1, "", "ports:\n  p: {device: d, axes: 0, role: mass" + coupling + "}\n")
        .network.links;
  };
  EXPECT_TRUE(links_with(", coupling: direct").empty());
  for (const char* said : {"", ", coupling: virtual"}) {
    ASSERT_EQ(links_with(said).size(), 1u) << said;
    EXPECT_EQ(links_with(said)[0].stiffness, 500.0);
  }
  EXPECT_EQ(links_with(", coupling: {stiffness_n_per_m: 80}")[0].viscosity, 1.5);
}

TEST(Port, SaysWhatItNeedsOfItsDevice) {
  const auto needs = [](const std::string& keys) {
    return scene_with_bob(1, "", "ports:\n  p: {device: d, axes: 0, role: mass" + keys + "}\n")
        .ports.at(0)
        .needs;
  };
  EXPECT_EQ(needs("").travel, 0.0);
  EXPECT_EQ(needs("").force, 0.0);
  EXPECT_EQ(needs(",\n needs: {travel_m: 0.05}").travel, 0.05);
  EXPECT_EQ(needs(",\n needs: {force_n: 5}").force, 5.0);
  EXPECT_EQ(needs(",\n needs: {force_n: 5}").place.line, 8);
}

TEST(Port, TheToolHasNoWeight) {
  for (const std::string role : {"role: mass", "role: liaison", "role: mass, coupling: direct"}) {
    const Scene scene = scene_with_bob(2, "",
                                       R"(world: {gravity_m_per_s2: [0, -9.81]}
ports:
  key: {device: d, axes: [0, 1], at_m: [1, 2], ball: {mass_kg: 0.3, radius_m: 0.1}, )" +
                                           role + "}\n");
    engine::World world(std::make_shared<const engine::Network>(scene.network));
    for (int n = 0; n < 500; ++n) world.step();
    const Port& port = scene.ports.at(0);
    EXPECT_EQ(world.position(port.tool), Vec3(1, 2, 0)) << role;
    EXPECT_EQ(world.link_force(port.mat), Vec3(0, 0, 0)) << role;
    EXPECT_LT(world.position(0).y(), 9.0 - 1.0) << "the bob falls";
  }
}

}  // namespace
}  // namespace cordis::scene
