// tests/scene/lattice_test.cpp
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

Scene lattice(int space, const std::string& keys) {
  return sound_scene(space, "matter:\n  a: {kind: lattice, " + keys + "}\n");
}

/// Links per MAT, and how many MATs have so many.
std::map<int, int> degrees(const Scene& scene) {
  std::vector<int> degree(scene.network.mats.size());
  for (const engine::Link& link : scene.network.links) {
    ++degree[link.mat_a];
    ++degree[link.mat_b];
  }
  std::map<int, int> count;
  for (const int d : degree) ++count[d];
  return count;
}

/// Pairs at a distance, found without any knowledge of lattices.
int pairs_at(const Scene& scene, double distance) {
  int count = 0;
  const auto& mats = scene.network.mats;
  for (std::size_t a = 0; a < mats.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (std::abs((mats[a].position - mats[b].position).norm() - distance) < 1e-9) ++count;
    }
  }
  return count;
}

TEST(Lattice, BlockHasItsCountsAlongTheAxesAndIsNumberedAlongX) {
  const Scene scene = lattice(3,
                              "structure: cubic, corner_m: [1, 2, 3], counts: [2, 3, 4], "
                              "spacing_m: 0.5, mass_kg: 0.1");
  ASSERT_EQ(scene.network.mats.size(), 24u);
  EXPECT_TRUE(scene.network.links.empty());  // no law is written
  EXPECT_EQ(scene.network.mats[1].position, Vec3(1.5, 2, 3));
  EXPECT_EQ(scene.network.mats[2].position, Vec3(1, 2.5, 3));
  EXPECT_EQ(scene.network.mats[23].position, Vec3(1.5, 3, 4.5));
}

TEST(Lattice, JoinsAllNearestNeighboursAndNoOthers) {
  for (const auto& [space, structure, counts] : {std::tuple(2, "square", "[5, 4]"),
                                                 {2, "triangular", "[5, 4]"},
                                                 {3, "cubic", "[4, 3, 3]"},
                                                 {3, "fcc", "[4, 4, 3]"}}) {
    const std::string corner = space == 2 ? "[0, 0]" : "[0, 0, 0]";
    const Scene scene = lattice(space, std::string("structure: ") + structure +
                                           ", corner_m: " + corner + ", counts: " + counts +
                                           ", spacing_m: 0.25, mass_kg: 1, stiffness_n_per_m: 7");
    EXPECT_NEAR(smallest_distance(scene), 0.25, 1e-12) << structure;
    EXPECT_EQ(static_cast<int>(scene.network.links.size()), pairs_at(scene, 0.25)) << structure;
    for (const engine::Link& link : scene.network.links) {
      EXPECT_NEAR(link.rest_length, 0.25, 1e-12);
      EXPECT_EQ(link.stiffness, 7.0);
    }
  }
}

TEST(Lattice, InnerMatsHaveTheNeighboursOfTheirStructure) {
  const auto max_links = [](int space, const std::string& keys) {
    return degrees(lattice(space, keys + ", spacing_m: 1, mass_kg: 1, stiffness_n_per_m: 1"))
        .rbegin()
        ->first;
  };
  EXPECT_EQ(max_links(2, "structure: square, corner_m: [0, 0], counts: [5, 5]"), 4);
  EXPECT_EQ(max_links(2, "structure: triangular, corner_m: [0, 0], counts: [5, 5]"), 6);
  EXPECT_EQ(max_links(3, "structure: cubic, corner_m: [0, 0, 0], counts: [3, 3, 3]"), 6);
  EXPECT_EQ(max_links(3, "structure: fcc, corner_m: [0, 0, 0], counts: [4, 5, 5]"), 12);
}

TEST(Lattice, ShearJoinsAllSecondNeighbours) {
  for (const auto& [space, structure, counts, far] :
       {std::tuple(2, "square", "[5, 4]", std::sqrt(2.0)),
        {2, "triangular", "[6, 6]", std::sqrt(3.0)},
        {3, "cubic", "[4, 3, 3]", std::sqrt(2.0)},
        {3, "fcc", "[4, 4, 4]", std::sqrt(2.0)}}) {
    const std::string corner = space == 2 ? "[0, 0]" : "[0, 0, 0]";
    const Scene scene =
        lattice(space, std::string("structure: ") + structure + ", corner_m: " + corner +
                           ", counts: " + counts +
                           ", spacing_m: 0.5, mass_kg: 1, shear_stiffness_n_per_m: 3");
    EXPECT_EQ(static_cast<int>(scene.network.links.size()), pairs_at(scene, 0.5 * far))
        << structure;
    for (const engine::Link& link : scene.network.links) EXPECT_EQ(link.stiffness, 3.0);
  }
}

TEST(Lattice, FillsABoxUpToItsFarCorner) {
  const Scene scene = lattice(2,
                              "structure: square, region: {from_m: [1, 1], to_m: [0, 0.3]}, "
                              "spacing_m: 0.1, mass_kg: 1");
  // rounding must not cost the last row: 11 x 8 points
  ASSERT_EQ(scene.network.mats.size(), 88u);
  EXPECT_EQ(scene.network.mats[0].position, Vec3(0, 0.3, 0));
  EXPECT_TRUE(scene.network.mats[87].position.isApprox(Vec3(1, 1, 0)));
}

TEST(Lattice, OfBallsTouchesAndLiesWhollyInItsRegion) {
  const Scene scene = lattice(3,
                              "structure: fcc, region: {center_m: [1, 0, 0], radius_m: 0.5}, "
                              "ball: {mass_kg: 0.01, radius_m: 0.05}");
  ASSERT_GT(scene.network.mats.size(), 100u);
  EXPECT_EQ(scene.network.radius, std::vector<double>(scene.network.mats.size(), 0.05));
  EXPECT_EQ(scene.radius_m, scene.network.radius);
  EXPECT_NEAR(smallest_distance(scene), 0.1, 1e-12);
  double farthest = 0.0;
  Vec3 center = Vec3::Zero();
  for (const engine::Mat& mat : scene.network.mats) {
    farthest = std::max(farthest, (mat.position - Vec3(1, 0, 0)).norm() + 0.05);
    center += mat.position / static_cast<double>(scene.network.mats.size());
  }
  EXPECT_LE(farthest, 0.5 + 1e-9);
  EXPECT_TRUE(center.isApprox(Vec3(1, 0, 0), 1e-12));  // symmetric about its centre
}

}  // namespace
}  // namespace cordis::scene
