// tests/scene/links_in_runs_test.cpp -- the share of generated links that comes in runs.
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/engine/links/link_runs.h"
#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

const std::string kSpring = "mass_kg: 0.01, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.01";
const std::string kSheared = kSpring + ", shear_stiffness_n_per_m: 50";
const std::string kCubic = "lattice, structure: cubic, spacing_m: 0.1, ";

struct Generated {
  const char* name;
  int space;
  std::string keys;
  std::string law;
  double least;  ///< share of the links in runs
};

engine::NetworkDescription network_of(int space, const std::string& keys, const std::string& law) {
  return sound_scene(space, "matter:\n  m: {kind: " + keys + ", " + law + "}\n").network;
}

double share_in_runs(const engine::NetworkDescription& network) {
  return static_cast<double>(engine::order_in_runs(network.links).in_runs) /
         static_cast<double>(network.links.size());
}

const Generated kAll[] = {
    {"string", 3, "string, count: 200, from_m: [0, 0, 0], to_m: [1, 0, 0]", kSpring, 1.0},
    {"ring", 2, "ring, count: 100, center_m: [0, 0], radius_m: 1", kSpring, 0.99},
    {"grid", 3, "grid, rows: 30, columns: 20, corner_m: [0, 0, 0], spacing_m: 0.1", kSheared, 1.0},
    {"grid in 1-D", 1, "grid, rows: 30, columns: 20", kSpring, 1.0},
    {"square", 2, "lattice, structure: square, spacing_m: 0.1, corner_m: [0, 0], counts: [20, 30]",
     kSheared, 1.0},
    {"triangular", 2,
     "lattice, structure: triangular, spacing_m: 0.1, corner_m: [0, 0], counts: [20, 30]", kSheared,
     1.0},
    {"cubic", 3, kCubic + "corner_m: [0, 0, 0], counts: [10, 10, 10]", kSpring, 1.0},
    {"sheared cubic", 3, kCubic + "corner_m: [0, 0, 0], counts: [10, 10, 10]", kSheared, 1.0},
    {"narrow cubic", 3, kCubic + "corner_m: [0, 0, 0], counts: [4, 4, 40]", kSheared, 1.0},
    {"ball of cubic", 3, kCubic + "region: {center_m: [0, 0, 0], radius_m: 1}", kSheared, 0.95},
    {"fcc", 3, "lattice, structure: fcc, spacing_m: 0.1, corner_m: [0, 0, 0], counts: [10, 12, 12]",
     kSheared, 0.99},
    {"disc", 2, "disc, center_m: [0, 0], radius_m: 1, spacing_m: 0.05", kSpring, 0.99},
    {"disc of rings", 2, "disc, structure: rings, center_m: [0, 0], radius_m: 1, spacing_m: 0.05",
     kSpring, 0.96},
    {"beam in 2-D", 2, "beam, from_m: [0, 0], to_m: [1, 0], cells: 50, height_m: 0.02", kSpring,
     1.0},
    {"beam in 3-D", 3, "beam, from_m: [0, 0, 0], to_m: [1, 0, 0], cells: 50, height_m: 0.02",
     kSpring, 0.94},
    {"skin", 2, "skin, center_m: [0, 0], radius_m: 1, count: 60", kSheared, 0.97},
};

TEST(LinksInRuns, AreNearlyAllLinksOfGeneratedMatter) {
  for (const Generated& matter : kAll) {
    const engine::NetworkDescription network = network_of(matter.space, matter.keys, matter.law);
    EXPECT_GE(share_in_runs(network), matter.least) << matter.name;
    EXPECT_TRUE(engine::layout_of(network).is_by_axis()) << matter.name;
  }
}

/// A core has one index, and the points of a sphere are numbered by its triangles.
TEST(LinksInRuns, AreNotThoseOfACoreNorOfASphere) {
  const engine::NetworkDescription core =
      network_of(2, "skin, center_m: [0, 0], radius_m: 1, count: 60",
                 kSpring + ", core: {mass_kg: 1, stiffness_n_per_m: 10}");
  EXPECT_FALSE(engine::layout_of(core).is_by_axis());
  const engine::NetworkDescription sphere =
      network_of(3, "skin, center_m: [0, 0, 0], radius_m: 1, subdivisions: 3", kSpring);
  EXPECT_FALSE(engine::layout_of(sphere).is_by_axis());
}

}  // namespace
}  // namespace cordis::scene
