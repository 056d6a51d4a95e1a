// tests/scene/body_test.cpp -- discs, balls, skins and beams.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

Scene body(int space, const std::string& keys) {
  return sound_scene(space, "matter:\n  a: {" + keys + "}\n");
}

const std::string kMassAndLaw = ", mass_kg: 0.01, stiffness_n_per_m: 100";

std::size_t mat_count(const Scene& scene) {
  return scene.network.mats.size();
}
std::size_t link_count(const Scene& scene) {
  return scene.network.links.size();
}

/// True if no two MATs are joined twice and all MATs are connected.
bool is_one_simple_piece(const Scene& scene) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::vector<std::uint32_t> root(mat_count(scene));
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto root_of = [&](std::uint32_t mat) {
    while (root[mat] != mat) mat = root[mat];
    return mat;
  };
  for (const engine::Link& link : scene.network.links) {
    pairs.insert(std::minmax(link.mat_a, link.mat_b));
    root[root_of(link.mat_a)] = root_of(link.mat_b);
  }
  bool one = pairs.size() == link_count(scene);
  for (std::uint32_t i = 1; i < root.size(); ++i) one = one && root_of(i) == root_of(0);
  return one;
}

/// The largest force on a MAT in the first step, and the sum of all [N].
struct FirstForces {
  double largest = 0.0;
  Vec3 sum = Vec3::Zero();
};
FirstForces first_forces(const Scene& scene) {
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  world.step();
  FirstForces forces;
  for (std::uint32_t i = 0; i < mat_count(scene); ++i) {
    const Vec3 force = world.link_force(i);
    forces.largest = std::max(forces.largest, force.norm());
    forces.sum += force;
  }
  return forces;
}

TEST(Disc, OfRingsHasSixMoreMatsInEachAndOnlyTriangles) {
  const Scene scene = body(2,
                           "kind: disc, structure: rings, center_m: [1, 2], radius_m: 0.5, "
                           "spacing_m: 0.1" +
                               kMassAndLaw);
  ASSERT_EQ(mat_count(scene), 91u);  // 1 + 6 (1 + 2 + 3 + 4 + 5)
  EXPECT_EQ(scene.network.mats[0].position, Vec3(1, 2, 0));
  EXPECT_TRUE(scene.network.mats[1].position.isApprox(Vec3(1.1, 2, 0)));
  EXPECT_EQ(link_count(scene), 240u);  // of 91 MATs with 30 at the border: 3 * 91 - 3 - 30
  EXPECT_TRUE(is_one_simple_piece(scene));
  for (const engine::Link& link : scene.network.links) {
    EXPECT_GT(link.rest_length, 0.095);
    EXPECT_LT(link.rest_length, 0.145);  // sqrt(1 + (pi / 3)^2) where a mesh is most skew
  }
}

TEST(Disc, IsATriangularLatticeUnlessSetOtherwise) {
  const Scene scene =
      body(2, "kind: disc, center_m: [0, 0], radius_m: 0.2, spacing_m: 0.1" + kMassAndLaw);
  EXPECT_EQ(mat_count(scene), 19u);
  EXPECT_EQ(link_count(scene), 42u);  // a hexagon with 3 MATs along a side
  EXPECT_TRUE(is_one_simple_piece(scene));
}

TEST(Disc, OfBallsLiesWhollyInItsRadius) {
  for (const std::string structure : {"rings", "triangular"}) {
    const Scene scene = body(2, "kind: disc, structure: " + structure +
                                    ", center_m: [0, 0], radius_m: 0.25, ball: {mass_kg: 1, "
                                    "radius_m: 0.05}");
    EXPECT_EQ(mat_count(scene), 19u);
    EXPECT_EQ(link_count(scene), 0u);
    for (const engine::Mat& mat : scene.network.mats)
      EXPECT_LE(mat.position.norm() + 0.05, 0.25 + 1e-9);
  }
}

TEST(Disc, LiesInThePlaneItNamesIn3D) {
  const Scene scene = body(3,
                           "kind: disc, center_m: [0, 1, 0], radius_m: 0.2, spacing_m: 0.1, plane: "
                           "xz" +
                               kMassAndLaw);
  EXPECT_EQ(mat_count(scene), 19u);
  for (const engine::Mat& mat : scene.network.mats) EXPECT_EQ(mat.position.y(), 1.0);
}

TEST(Ball, IsRoundAndFull) {
  const Scene scene =
      body(3, "kind: ball, center_m: [1, 0, 0], radius_m: 1, spacing_m: 0.1" + kMassAndLaw);
  // the density of fcc is sqrt(2) per cubed spacing
  const double expected = 4.0 / 3.0 * std::numbers::pi * std::sqrt(2.0) * 1000.0;
  EXPECT_NEAR(static_cast<double>(mat_count(scene)), expected, 0.02 * expected);
  EXPECT_TRUE(is_one_simple_piece(scene));
  const Scene cubic = body(3,
                           "kind: ball, structure: cubic, center_m: [0, 0, 0], radius_m: 0.1, "
                           "spacing_m: 0.1" +
                               kMassAndLaw);
  EXPECT_EQ(mat_count(cubic), 7u);
  EXPECT_EQ(link_count(cubic), 6u);
}

TEST(Skin, OfACircleCloses) {
  const Scene scene =
      body(2, "kind: skin, center_m: [1, 2], radius_m: 0.5, count: 12" + kMassAndLaw);
  ASSERT_EQ(mat_count(scene), 12u);
  EXPECT_EQ(link_count(scene), 12u);
  EXPECT_TRUE(is_one_simple_piece(scene));
  for (const engine::Mat& mat : scene.network.mats)
    EXPECT_NEAR((mat.position - Vec3(1, 2, 0)).norm(), 0.5, 1e-15);
}

TEST(Skin, OfAPolygonHasItsCornersAndEqualPiecesBetween) {
  const Scene scene = body(2,
                           "kind: skin, corners_m: [[0, 0], [3, 0], [3, 4]], spacing_m: 1, "
                           "shear_stiffness_n_per_m: 5" +
                               kMassAndLaw);
  ASSERT_EQ(mat_count(scene), 12u);  // 3 + 4 + 5
  EXPECT_EQ(link_count(scene), 24u);
  EXPECT_EQ(scene.network.mats[3].position, Vec3(3, 0, 0));
  EXPECT_EQ(scene.network.mats[7].position, Vec3(3, 4, 0));
  EXPECT_EQ(scene.network.links[23].mat_a, 11u);  // the second neighbours close, too
  EXPECT_EQ(scene.network.links[23].mat_b, 1u);
  for (std::size_t l = 0; l < 12; ++l) EXPECT_NEAR(scene.network.links[l].rest_length, 1.0, 1e-15);
}

TEST(Skin, OfASphereIsADividedIcosahedron) {
  for (int subdivisions = 0; subdivisions < 4; ++subdivisions) {
    const Scene scene = body(3, "kind: skin, center_m: [0, 0, 1], radius_m: 2, subdivisions: " +
                                    std::to_string(subdivisions) + kMassAndLaw);
    const std::size_t four = std::size_t{1} << (2 * subdivisions);
    EXPECT_EQ(mat_count(scene), 10 * four + 2);
    EXPECT_EQ(link_count(scene), 30 * four);  // Euler: V - E + F = 2 with 20 * 4^s triangles
    EXPECT_TRUE(is_one_simple_piece(scene));
    double shortest = 9.0;
    double longest = 0.0;
    for (const engine::Mat& mat : scene.network.mats)
      EXPECT_NEAR((mat.position - Vec3(0, 0, 1)).norm(), 2.0, 1e-14);
    for (const engine::Link& link : scene.network.links) {
      shortest = std::min(shortest, link.rest_length);
      longest = std::max(longest, link.rest_length);
    }
    EXPECT_LT(longest, 1.25 * shortest);
  }
}

TEST(Skin, HasACoreThatHoldsAllOfIt) {
  const Scene scene = scene_with_bob(
      3,
      "  a: {kind: skin, center_m: [0, 0, 1], radius_m: 0.1, subdivisions: 1, mass_kg: 0.01, "
      "stiffness_n_per_m: 9, core: {mass_kg: 0.5, stiffness_n_per_m: 20, viscosity_n_s_per_m: "
      "0.1}}\n",
      R"(signals:
  core: {of: a.core, quantity: speed}
  first: {of: "a.skin[0]", quantity: speed}
)");
  ASSERT_EQ(mat_count(scene), 44u);
  EXPECT_EQ(scene.network.mats[42].mass, 0.5);
  EXPECT_TRUE(scene.network.mats[42].position.isApprox(Vec3(0, 0, 1)));
  EXPECT_EQ(link_count(scene), 120u + 42u);
  EXPECT_EQ(scene.network.links[161].stiffness, 20.0);
  EXPECT_EQ(scene.signals.signals()[0].index, 42u);
}

TEST(Beam, IsBracedInEveryCell) {
  const Scene flat =
      body(2, "kind: beam, from_m: [0, 0], to_m: [4, 0], cells: 4, height_m: 0.5" + kMassAndLaw);
  ASSERT_EQ(mat_count(flat), 10u);
  EXPECT_EQ(flat.network.mats[2].position, Vec3(1, -0.25, 0));
  EXPECT_EQ(flat.network.mats[3].position, Vec3(1, 0.25, 0));
  EXPECT_EQ(link_count(flat), 5u + 4u * 4u);
  EXPECT_TRUE(is_one_simple_piece(flat));

  const Scene solid = body(3,
                           "kind: beam, from_m: [0, 0, 0], to_m: [0, 3, 0], cells: 3, height_m: "
                           "0.5, width_m: 1, ends: first_fixed" +
                               kMassAndLaw);
  ASSERT_EQ(mat_count(solid), 16u);
  EXPECT_EQ(link_count(solid), 4u * 6u + 3u * 12u);
  EXPECT_TRUE(is_one_simple_piece(solid));
  EXPECT_EQ(solid.network.mats[3].kind, engine::MatKind::kFixed);
  EXPECT_EQ(solid.network.mats[4].kind, engine::MatKind::kMass);
  EXPECT_TRUE(solid.network.mats[4].position.isApprox(Vec3(-0.5, 1, -0.25)));
  EXPECT_TRUE(solid.network.mats[6].position.isApprox(Vec3(0.5, 1, 0.25)));
}

TEST(Beam, TurnsItsHeightToWhereUpIs) {
  const auto first = [](const std::string& keys) {
    return body(3,
                "kind: beam, from_m: [0, 0, 0], to_m: [1, 0, 0], cells: 1, height_m: 2, width_m: "
                "0.5" +
                    keys + kMassAndLaw)
        .network.mats[0]
        .position;
  };
  EXPECT_TRUE(first("").isApprox(Vec3(0, 0.25, -1)));
  EXPECT_TRUE(first(", up: y").isApprox(Vec3(0, -1, -0.25)));
  EXPECT_TRUE(first(", up: [7, 1, 0]").isApprox(Vec3(0, -1, -0.25)));
}

TEST(Bodies, RestWhereTheyAreGenerated) {
  for (const auto& [space, keys] : {
           std::pair<int, std::string>{2,
                                       "kind: disc, center_m: [0, 0], radius_m: 0.5, spacing_m: "
                                       "0.1, shear_stiffness_n_per_m: 3"},
           {2, "kind: disc, structure: rings, center_m: [0, 0], radius_m: 0.5, spacing_m: 0.1"},
           {3, "kind: ball, center_m: [0, 0, 0], radius_m: 0.3, spacing_m: 0.1"},
           {3,
            "kind: skin, center_m: [0, 0, 0], radius_m: 0.3, subdivisions: 2, "
            "shear_stiffness_n_per_m: 4, core: {mass_kg: 1, stiffness_n_per_m: 5}"},
           {3, "kind: beam, from_m: [0, 0, 0], to_m: [3, 2, 1], cells: 5, height_m: 0.4"},
           {3,
            "kind: lattice, structure: fcc, corner_m: [0, 0, 0], counts: [4, 4, 4], spacing_m: "
            "0.1"},
       }) {
    const FirstForces forces = first_forces(body(space, keys + kMassAndLaw));
    // the rest length is the distance itself, of which rounding leaves some 1e-16 m times 100 N/m
    EXPECT_LT(forces.largest, 1e-12) << keys;
    EXPECT_LT(forces.sum.norm(), 1e-12) << keys;
  }
}

}  // namespace
}  // namespace cordis::scene
