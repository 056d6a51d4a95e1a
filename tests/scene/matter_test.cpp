// tests/scene/matter_test.cpp
#include "sim_node/scene/matter/matter.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"
#include "tests/support/filled.h"

namespace cordis::scene {
namespace {

using engine::Mat;
using engine::MatKind;
using engine::Vec3;

/// The MATs of the first matter of a scene.
std::vector<Mat> mats_of_first(const Scene& scene) {
  const auto first = scene.network.mats.begin() + scene.matter[0].first;
  return {first, first + scene.matter[0].count};
}

int fixed_count(const std::vector<Mat>& mats) {
  int count = 0;
  for (const Mat& mat : mats) count += mat.kind == MatKind::kFixed ? 1 : 0;
  return count;
}

TEST(Matter, MassStandsWhereItIsPutAndMovesAsItsVelocitySays) {
  const Scene scene = sound_scene(2,
                                  R"(matter:
  a: {kind: mass, mass_kg: 0.5, at_m: [[1, 2], [3, 4]], velocity_m_per_s: [5, 6], drawn_radius_m: 0.1}
)");

  ASSERT_EQ(scene.network.mats.size(), 2u);
  const Mat& second = scene.network.mats[1];
  EXPECT_EQ(second.kind, MatKind::kMass);
  EXPECT_EQ(second.mass, 0.5);
  EXPECT_EQ(second.position, Vec3(3, 4, 0));
  EXPECT_EQ(second.velocity, Vec3(5, 6, 0));
  EXPECT_EQ(scene.radius_m, (std::vector<double>{0.1, 0.1}));
  EXPECT_TRUE(scene.layout.empty());
}

TEST(Matter, OnePointNeedsNoListInAnySpace) {
  EXPECT_EQ(
      sound_scene(1, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: 3}\n").network.mats[0].position,
      Vec3(3, 0, 0));
  EXPECT_EQ(sound_scene(2, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [3, 4]}\n")
                .network.mats[0]
                .position,
            Vec3(3, 4, 0));
  EXPECT_EQ(sound_scene(3, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [3, 4, 5]}\n")
                .network.mats[0]
                .position,
            Vec3(3, 4, 5));
}

TEST(Matter, InOneDimensionASequenceIsSeveralPoints) {
  const Scene scene = sound_scene(1, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [3, 4]}\n");
  ASSERT_EQ(scene.network.mats.size(), 2u);
  EXPECT_EQ(scene.network.mats[1].position, Vec3(4, 0, 0));
}

TEST(Matter, FixedNeverMoves) {
  const Scene scene = scene_with_bob(3, "  a: {kind: fixed, at_m: [[1, 2, 3], [4, 5, 6]]}\n");
  const std::vector<Mat> mats = mats_of_first(scene);
  ASSERT_EQ(mats.size(), 2u);
  EXPECT_EQ(fixed_count(mats), 2);
  EXPECT_EQ(mats[1].position, Vec3(4, 5, 6));
}

TEST(Matter, PointsHaveEachItsOwnPlaceMassAndVelocity) {
  const Scene scene = sound_scene(1,
                                  R"(matter:
  a: {kind: points, at_m: [0.1, 0.2, 0.3], mass_kg: [1, 0, 3], fixed: [1],
      velocity_m_per_s: [4, 5, 6], radius_m: 0.01, layout_at_m: [[0, 1], [2, 3], [4, 5]]}
)");
  const auto& mats = scene.network.mats;

  ASSERT_EQ(mats.size(), 3u);
  EXPECT_EQ(mats[0].mass, 1.0);
  EXPECT_EQ(mats[2].mass, 3.0);
  EXPECT_EQ(mats[1].kind, engine::MatKind::kFixed);
  EXPECT_EQ(mats[1].velocity, Vec3(0, 0, 0));
  EXPECT_EQ(mats[2].velocity, Vec3(6, 0, 0));
  EXPECT_EQ(mats[2].position, Vec3(0.3, 0, 0));
  EXPECT_EQ(scene.network.radius, (std::vector<double>{0.01, 0.01, 0.01}));
  EXPECT_EQ(scene.layout[2].x, 4.0);
  EXPECT_EQ(scene.layout[2].z, 5.0);
}

TEST(Matter, NamesTheRangesInTheOrderOfTheFile) {
  const Scene scene = sound_scene(2,
                                  R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
  b: {kind: string, count: 3, mass_kg: 1, from_m: [0, 1], to_m: [2, 1], stiffness_n_per_m: 1}
)");
  ASSERT_EQ(scene.matter.size(), 2u);
  EXPECT_EQ(scene.matter[1].name, "b");
  EXPECT_EQ(scene.matter[1].first, 2u);
  EXPECT_EQ(scene.matter[1].count, 3u);
  ASSERT_EQ(scene.links.size(), 1u);
  EXPECT_EQ(scene.links[0].name, "b.links");
  EXPECT_EQ(scene.links[0].count, 2u);
  EXPECT_EQ(scene.network.links[0].mat_a, 2u);
  EXPECT_EQ(scene.network.links[1].mat_b, 4u);
}

TEST(Matter, ChainStandsEvenlyBetweenItsEnds) {
  const Scene scene = sound_scene(3,
                                  R"(matter:
  a: {kind: string, count: 5, mass_kg: 0.1, from_m: [0, 1, 2], to_m: [4, 1, 5],
      stiffness_n_per_m: 7, viscosity_n_s_per_m: 0.5}
)");

  ASSERT_EQ(scene.network.mats.size(), 5u);
  ASSERT_EQ(scene.network.links.size(), 4u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(scene.network.mats[i].position.isApprox(Vec3(i, 1, 2 + 0.75 * i), 1e-15));
    EXPECT_EQ(scene.network.mats[i].mass, 0.1);
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    const engine::Link& link = scene.network.links[i];
    EXPECT_EQ(link.mat_a, i);
    EXPECT_EQ(link.mat_b, i + 1);
    EXPECT_EQ(link.stiffness, 7.0);
    EXPECT_EQ(link.viscosity, 0.5);
    EXPECT_DOUBLE_EQ(link.rest_length, 1.25);  // 3-4-5: the distance at the start
  }
}

TEST(Matter, ChainIsFixedAtTheEndsItNames) {
  const auto ends_of = [](const std::string& ends) {
    const Scene scene = scene_with_bob(2,
                                       "  a: {kind: string, count: 4, mass_kg: 1, from_m: [0, 0], "
                                       "to_m: [3, 0], stiffness_n_per_m: 1" +
                                           ends + "}\n");
    const std::vector<Mat> mats = mats_of_first(scene);
    std::string kinds;
    for (const Mat& mat : mats) kinds += mat.kind == MatKind::kFixed ? 'F' : 'm';
    return kinds;
  };
  EXPECT_EQ(ends_of(""), "mmmm");
  EXPECT_EQ(ends_of(", ends: free"), "mmmm");
  EXPECT_EQ(ends_of(", ends: fixed"), "FmmF");
  EXPECT_EQ(ends_of(", ends: first_fixed"), "Fmmm");
  EXPECT_EQ(ends_of(", ends: last_fixed"), "mmmF");
}

TEST(Matter, TensionStretchesTheLinks) {
  const Scene scene = sound_scene(2,
                                  R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [2, 0], stiffness_n_per_m: 100, tension_n: 20}
)");
  // 100 N/m times (1 m - rest) = 20 N
  EXPECT_DOUBLE_EQ(scene.network.links[0].rest_length, 0.8);
}

TEST(Matter, RestLengthCanBeWritten) {
  const Scene scene = sound_scene(2,
                                  R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [2, 0], stiffness_n_per_m: 100, rest_m: 0.3}
)");
  EXPECT_EQ(scene.network.links[1].rest_length, 0.3);
}

TEST(Matter, RingIsARegularPolygonThatCloses) {
  const Scene scene = sound_scene(2,
                                  R"(matter:
  a: {kind: ring, count: 6, mass_kg: 1, center_m: [1, 2], radius_m: 3, stiffness_n_per_m: 4}
)");

  ASSERT_EQ(scene.network.mats.size(), 6u);
  ASSERT_EQ(scene.network.links.size(), 6u);
  EXPECT_TRUE(scene.network.mats[0].position.isApprox(Vec3(4, 2, 0)));
  EXPECT_TRUE(scene.network.mats[1].position.isApprox(Vec3(2.5, 2 + 1.5 * std::sqrt(3.0), 0)));
  for (const engine::Link& link : scene.network.links)
    EXPECT_NEAR(link.rest_length, 3.0, 1e-14);  // of a hexagon
  EXPECT_EQ(scene.network.links[5].mat_a, 5u);
  EXPECT_EQ(scene.network.links[5].mat_b, 0u);
}

TEST(Matter, RingAndGridLieInThePlaneTheyName) {
  const auto second_of_ring = [](const std::string& plane) {
    return sound_scene(3, test::filled(R"(matter:
  a: {kind: ring, count: 4, mass_kg: 1, center_m: [0, 0, 0], radius_m: 1,
      stiffness_n_per_m: 4<plane>}
)",
                                       {{"plane", plane}}))
        .network.mats[1]
        .position;
  };
  EXPECT_TRUE(second_of_ring("").isApprox(Vec3(0, 1, 0)));
  EXPECT_TRUE(second_of_ring(", plane: xy").isApprox(Vec3(0, 1, 0)));
  EXPECT_TRUE(second_of_ring(", plane: xz").isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(second_of_ring(", plane: yz").isApprox(Vec3(0, 0, 1)));
  const Scene grid = sound_scene(3,
                                 R"(matter:
  a: {kind: grid, rows: 2, columns: 2, mass_kg: 1, corner_m: [1, 1, 1], spacing_m: 2, stiffness_n_per_m: 4, plane: yz}
)");
  EXPECT_EQ(grid.network.mats[1].position, Vec3(1, 3, 1));
  EXPECT_EQ(grid.network.mats[2].position, Vec3(1, 1, 3));
}

TEST(Matter, GridJoinsNeighboursInRowsAndColumns) {
  const Scene scene = sound_scene(2,
                                  R"(matter:
  a: {kind: grid, rows: 3, columns: 4, mass_kg: 1, corner_m: [1, 2], spacing_m: [0.5, 0.25], stiffness_n_per_m: 4}
)");

  ASSERT_EQ(scene.network.mats.size(), 12u);
  EXPECT_EQ(scene.network.mats[2 * 4 + 3].position, Vec3(1 + 3 * 0.5, 2 + 2 * 0.25, 0));
  ASSERT_EQ(scene.network.links.size(), 3u * 3u + 2u * 4u);
  for (const engine::Link& link : scene.network.links) {
    const bool in_row = link.mat_b == link.mat_a + 1 && link.mat_a % 4 != 3;
    const bool in_column = link.mat_b == link.mat_a + 4;
    EXPECT_TRUE(in_row || in_column);
    EXPECT_EQ(link.rest_length, in_row ? 0.5 : 0.25);
  }
}

TEST(Matter, GridJoinsTheDiagonalsByShear) {
  const Scene scene = sound_scene(2,
                                  R"(matter:
  a: {kind: grid, rows: 3, columns: 4, mass_kg: 1, corner_m: [0, 0], spacing_m: [3, 4],
      stiffness_n_per_m: 4, shear_stiffness_n_per_m: 9}
)");
  ASSERT_EQ(scene.network.links.size(), 17u + 2u * 2u * 3u);
  for (std::size_t l = 17; l < scene.network.links.size(); ++l) {
    EXPECT_EQ(scene.network.links[l].stiffness, 9.0);
    EXPECT_EQ(scene.network.links[l].rest_length, 5.0);  // 3-4-5
  }
}

TEST(Matter, GridIsFixedAtTheBorderItNames) {
  const auto fixed_of = [](const std::string& border) {
    return fixed_count(
        mats_of_first(scene_with_bob(2,
                                     "  a: {kind: grid, rows: 3, columns: 4, mass_kg: 1, corner_m: "
                                     "[0, 0], spacing_m: 1, stiffness_n_per_m: 4" +
                                         border + "}\n")));
  };
  EXPECT_EQ(fixed_of(""), 0);
  EXPECT_EQ(fixed_of(", border: free"), 0);
  EXPECT_EQ(fixed_of(", border: corners"), 4);
  EXPECT_EQ(fixed_of(", border: fixed"), 10);
}

TEST(Matter, TakesItsLinksFromALiaison) {
  const Scene scene = sound_scene(2,
                                  R"(liaisons:
  steel: {kind: spring_damper, stiffness_n_per_m: 5, viscosity_n_s_per_m: 6, rest_m: 0.7}
matter:
  a: {kind: string, count: 2, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], liaison: steel}
  b: {kind: string, count: 2, mass_kg: 1, from_m: [0, 1], to_m: [1, 1], liaison: steel,
      viscosity_n_s_per_m: 8, tension_n: 1}
)");
  EXPECT_EQ(scene.network.links[0].stiffness, 5.0);
  EXPECT_EQ(scene.network.links[0].viscosity, 6.0);
  EXPECT_EQ(scene.network.links[0].rest_length, 0.7);
  EXPECT_EQ(scene.network.links[1].viscosity, 8.0);
  EXPECT_DOUBLE_EQ(scene.network.links[1].rest_length, 0.8);
}

TEST(Matter, InOneDimensionGeneratorsRestAtOneDisplacementAndAreLaidOut) {
  const Scene scene = sound_scene(1,
                                  R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, stiffness_n_per_m: 1, layout_at_m: [1, 2], layout_spacing_m: 0.5}
  b: {kind: grid, rows: 2, columns: 2, mass_kg: 1, at_m: 3, stiffness_n_per_m: 1, layout_spacing_m: 0.1}
  c: {kind: ring, count: 4, mass_kg: 1, stiffness_n_per_m: 1, layout_at_m: [1, 0], layout_spacing_m: 0.5}
  d: {kind: mass, mass_kg: 1, at_m: [5, 6]}
)");

  ASSERT_EQ(scene.layout.size(), scene.network.mats.size());
  EXPECT_EQ(scene.network.mats[2].position, Vec3::Zero());
  EXPECT_EQ(scene.network.links[0].rest_length, 0.0);
  EXPECT_EQ(scene.layout[2].x, 2.0);
  EXPECT_EQ(scene.layout[2].z, 2.0);
  EXPECT_EQ(scene.network.mats[6].position, Vec3(3, 0, 0));
  EXPECT_EQ(scene.layout[6].x, 0.1);
  EXPECT_EQ(scene.layout[6].z, 0.1);
  const double radius = 4 * 0.5 / (2.0 * std::numbers::pi);  // a circle as long as the ring
  EXPECT_NEAR(scene.layout[8].x, 1.0, 1e-15);
  EXPECT_NEAR(scene.layout[8].z, radius, 1e-15);
  EXPECT_EQ(scene.layout[12].x, 0.02);  // beside the one before it
}

TEST(Matter, InOneDimensionAChainMayStretchAlongItsDisplacement) {
  const Scene scene = sound_scene(1,
                                  R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: 2, to_m: 0, stiffness_n_per_m: 1}
)");
  EXPECT_EQ(scene.network.mats[1].position.x(), 1.0);
  EXPECT_EQ(scene.network.links[0].rest_length, -1.0);  // signed
}

TEST(Scene, ReadsItsRatesAndItsWorld) {
  config::Problems problems;
  const Scene scene = load_scene_text(
      R"(cordis: 1
name: my scene
space: 3
step: {rate_hz: 6000, gesture_rate_hz: 2000, frame_rate_hz: 50, integrator: cordis}
world: {gravity_m_per_s2: [0, 1, -9.81], viscosity_n_s_per_m: 0.25}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0, 0]}
)",
      "dir/t.yaml", problems);
  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(scene.name, "my scene");
  EXPECT_EQ(scene.file, "dir/t.yaml");
  EXPECT_EQ(scene.space(), 3);
  EXPECT_EQ(scene.step_rate_hz, 6000.0);
  EXPECT_EQ(scene.gesture_rate_hz, 2000.0);
  EXPECT_EQ(scene.frame_rate_hz, 50.0);
  EXPECT_DOUBLE_EQ(scene.network.step, 1.0 / 6000.0);
  EXPECT_EQ(scene.network.gravity, Vec3(0, 1, -9.81));
  EXPECT_EQ(scene.network.medium_viscosity, 0.25);
}

TEST(Scene, HasDefaults) {
  config::Problems problems;
  const Scene scene = load_scene_text(
      R"(cordis: 1
space: 1
step: {rate_hz: 2000}
matter:
  a: {kind: mass, mass_kg: 1, at_m: 0}
)",
      "dir/my.yaml", problems);
  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(scene.name, "my");
  EXPECT_EQ(scene.gesture_rate_hz, 1000.0);
  EXPECT_EQ(scene.frame_rate_hz, 25.0);
  EXPECT_EQ(scene.network.gravity, Vec3::Zero());
  EXPECT_EQ(scene.signals.count(), 0u);
}

}  // namespace
}  // namespace cordis::scene
