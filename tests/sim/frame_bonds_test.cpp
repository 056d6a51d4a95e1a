// tests/sim/frame_bonds_test.cpp -- bonds of sets and forces on ports in a frame.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/run/describe.h"
#include "sim_node/run/frame_message.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::sim {
namespace {

/// Four balls in a row that overlap one after the other: they hook each other. A seal between the
/// first two is torn as soon as they touch. The last one lies on a floor.
std::string beads_text() {
  return R"(
cordis: 1
name: beads
space: 2
step: {rate_hz: 1000}
liaisons:
  seal:
    range: rest
    states:
      shut: {stiffness_n_per_m: 1, exits: [{to: torn, when: elongation_m < 0}]}
      torn: {}
  hook:
    range: rest
    states:
      open: {exits: [{to: held, when: elongation_m < 0}]}
      held: {stiffness_n_per_m: 10, final: true}
matter:
  first: {kind: mass, at_m: [0, 0], ball: {mass_kg: 0.1, radius_m: 0.01}}
  rest:  {kind: mass, at_m: [[0.018, 0], [0.036, 0], [0.054, 0]], ball: {mass_kg: 0.1, radius_m: 0.01}}
  floor: {kind: plane, at_m: [0.054, -0.009], normal: y}
links:
  - {liaison: seal, between_sets: [first, rest], rest: radii}
  - {liaison: hook, between_sets: [first, rest], rest: radii}
  - {liaison: hook, within: rest, rest: radii}
  - {liaison: hook, between_sets: [rest, floor], rest: radii}
)";
}

void step(LoadedScene& scene, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) {
    scene.simulation.advance(scene.simulation.steps_left_in_tick(), scene.frames.events());
  }
}

msg::SceneFrame frame_of(FrameStore& frames, const engine::World& world) {
  frames.turn(world, 0.0, 0);
  msg::SceneFrame frame;
  put_frame(frames.shape(), frames.published(), frame);
  return frame;
}

TEST(FrameBonds, AreThePairsInAnotherStateThanThatOfTheStartSetAfterSet) {
  const auto scene = loaded_scene_of(beads_text());
  const msg::SceneFrame before = frame_of(scene->frames, scene->simulation.world());
  EXPECT_TRUE(before.bond_ends().empty());
  EXPECT_EQ(before.bond_count(), (std::vector<std::uint32_t>{0, 0, 0}));

  step(*scene, 2);
  const msg::SceneFrame frame = frame_of(scene->frames, scene->simulation.world());
  constexpr std::uint8_t kTorn = 1 + kLinkIsIdle;
  EXPECT_EQ(frame.bond_ends(), (std::vector<std::uint32_t>{0, 1, 0, 1, 1, 2, 2, 3}));
  EXPECT_EQ(frame.bond_state(), (std::vector<std::uint8_t>{kTorn, 1, 1, 1}));
  EXPECT_EQ(frame.bond_count(), (std::vector<std::uint32_t>{1, 1, 2}));
  EXPECT_EQ(frame.bonds_left_out(), 0u);
}

TEST(FrameBonds, AreOfTheSetsThatTheDescriptionNames) {
  const msg::SceneDescription description = describe(*scene_of(beads_text()), 1, 1);
  ASSERT_EQ(description.sets().size(), 3u) << "the floor is no end of a bond";
  const msg::SetDescription& seal = description.sets()[0];
  EXPECT_EQ(description.state_machines()[seal.state_machine()].name(), "seal");
  EXPECT_EQ(description.state_machines()[description.sets()[2].state_machine()].states(),
            (std::vector<std::string>{"open", "held"}));
  EXPECT_EQ(seal.start_state(), 0u);
  EXPECT_EQ(seal.name(), "seal");
  EXPECT_TRUE(describe(*scene_of(swing_text()), 1, 1).sets().empty());
}

TEST(FrameBonds, BeyondTheRoomAreCounted) {
  const auto scene = loaded_scene_of(beads_text());
  EXPECT_EQ(scene->frames.shape().bond_capacity, 3u + 3u + 3u) << "there are no more pairs";
  step(*scene, 2);
  FrameShape shape = scene->frames.shape();
  shape.bond_capacity = 3;
  FrameStore frames(shape);
  for (int turn = 0; turn < 2; ++turn) {
    const msg::SceneFrame frame = frame_of(frames, scene->simulation.world());
    EXPECT_EQ(frame.bond_ends(), (std::vector<std::uint32_t>{0, 1, 0, 1, 1, 2}));
    EXPECT_EQ(frame.bond_state().size(), 3u);
    EXPECT_EQ(frame.bond_count(), (std::vector<std::uint32_t>{1, 1, 1}));
    EXPECT_EQ(frame.bonds_left_out(), 1u);
  }
}

TEST(FrameBonds, HaveRoomForSoManyAtMost) {
  const auto scene = loaded_scene_of(R"(
cordis: 1
name: heap
space: 2
step: {rate_hz: 1000}
liaisons:
  hook:
    range: rest
    states:
      open: {exits: [{to: held, when: elongation_m < 0}]}
      held: {stiffness_n_per_m: 10, final: true}
matter: {heap: {kind: lattice, structure: square, corner_m: [0, 0], counts: [20, 20], spacing_m: 0.1, ball: {mass_kg: 0.1, radius_m: 0.01}}}
links: [{liaison: hook, within: heap, rest: radii}]
)");
  EXPECT_EQ(scene->frames.shape().bond_capacity, kMaxBonds) << "of 79800 pairs";
}

TEST(FrameBonds, AreGatheredWithoutAllocating) {
  const auto scene = loaded_scene_of(beads_text());
  step(*scene, 2);
  const test::AllocationGuard guard;
  for (int turn = 0; turn < 4; ++turn) scene->frames.turn(scene->simulation.world(), 0.0, 0);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(scene->frames.published().bonds.shown, 4u);
}

TEST(PortForces, AreWhatTheLiaisonsDoToThePortInTheCoordinatesOfAFrame) {
  const auto scene = loaded_scene_of(swing_text());  // moves along y of a frame
  EXPECT_EQ(frame_of(scene->frames, scene->simulation.world()).port_force_n(),
            (std::vector<float>{0.0F, 0.0F, 0.0F}));
  step(*scene, 1);
  const std::uint32_t key = scene->simulation.scene().ports[0].mat;
  const double force = scene->simulation.world().link_force(key)[0];
  EXPECT_GT(force, 0.5) << "the bob is beyond the key, at 100 N/m";
  EXPECT_EQ(frame_of(scene->frames, scene->simulation.world()).port_force_n(),
            (std::vector<float>{0.0F, static_cast<float>(force), 0.0F}));
}

}  // namespace
}  // namespace cordis::sim
