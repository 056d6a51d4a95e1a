// tests/sim/hollow_description_test.cpp -- hollow bodies as views get them.
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/run/describe.h"
#include "tests/sim/loaded_scenes.h"

namespace cordis::sim {
namespace {

TEST(HollowDescription, NamesTheOutsideAndEachInnerFace) {
  const auto scene = scene_of(R"(
cordis: 1
name: cans
space: 3
step: {rate_hz: 1000}
liaisons:
  touch: {stiffness_n_per_m: 100, pulls: false, range: rest}
matter:
  ball: {kind: mass, at_m: [0, 0, 0], ball: {mass_kg: 0.1, radius_m: 0.01}}
  can:  {kind: box, center_m: [0, 0, 0], size_m: [0.4, 0, 0.2], sides: both}
  tube: {kind: cylinder, center_m: [1, 0, 0], axis: y, radius_m: 0.3, sides: both}
  post: {kind: cylinder, center_m: [1, 0, 0], axis: y, radius_m: 0.1}
links:
  - {liaison: touch, between_sets: [ball, [can, tube, post]], rest: radii}
)");
  const msg::SceneDescription description = describe(*scene, 1, 1);

  std::vector<msg::SurfaceKind> kinds;
  for (const msg::SurfaceDescription& surface : description.surfaces())
    kinds.push_back(surface.kind());
  EXPECT_EQ(kinds, (std::vector{msg::SURFACE_HOLLOW_BOX, msg::SURFACE_INNER_FACE,
                                msg::SURFACE_INNER_FACE, msg::SURFACE_INNER_FACE,
                                msg::SURFACE_INNER_FACE, msg::SURFACE_HOLLOW_CYLINDER,
                                msg::SURFACE_INNER_FACE, msg::SURFACE_CYLINDER}));
  EXPECT_EQ(description.surface_mat(), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(description.surfaces()[0].size_m(), (std::vector<double>{0.4, 0.0, 0.2}));
  EXPECT_EQ(description.surfaces()[5].size_m(), (std::vector<double>{0.3, 0.0}));
  EXPECT_TRUE(description.surfaces()[6].size_m().empty());
}

TEST(HollowDescription, NamesTheOtherSideOfAPlaneThatHasTwo) {
  const auto scene = scene_of(R"(
cordis: 1
name: walls
space: 2
step: {rate_hz: 1000}
liaisons:
  touch: {stiffness_n_per_m: 100, pulls: false, range: rest}
matter:
  ball: {kind: mass, at_m: [0, 0], ball: {mass_kg: 0.1, radius_m: 0.01}}
  floor: {kind: plane, at_m: [0, -1], normal: y}
  wall: {kind: plane, at_m: [1, 0], normal: x, sides: both}
links:
  - {liaison: touch, between_sets: [ball, [floor, wall]], rest: radii}
)");
  const msg::SceneDescription description = describe(*scene, 1, 1);

  ASSERT_EQ(description.surfaces().size(), 3u);
  EXPECT_EQ(description.surfaces()[0].kind(), msg::SURFACE_PLANE);
  EXPECT_EQ(description.surfaces()[1].kind(), msg::SURFACE_PLANE);
  EXPECT_EQ(description.surfaces()[2].kind(), msg::SURFACE_INNER_FACE);
  EXPECT_EQ(description.surfaces()[2].name(), "wall");
  EXPECT_EQ(description.surface_mat(), (std::vector<std::uint32_t>{1, 2, 2}));
}

}  // namespace
}  // namespace cordis::sim
