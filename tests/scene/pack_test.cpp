// tests/scene/pack_test.cpp
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/scene/matter/packing.h"
#include "tests/scene/scene_text.h"
#include "tests/support/rounds.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

Scene pack(int space, const std::string& keys) {
  return sound_scene(space, "matter:\n  a: {kind: pack, " + keys + "}\n");
}

/// FNV-1a of the bits of all positions.
std::uint64_t hash_of(const Scene& scene) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const engine::Mat& mat : scene.network.mats) {
    for (int axis = 0; axis < 3; ++axis) {
      std::uint64_t bits = 0;
      const double value = mat.position[axis];
      std::memcpy(&bits, &value, sizeof bits);
      for (int byte = 0; byte < 8; ++byte) {
        hash = (hash ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100000001b3U;
      }
    }
  }
  return hash;
}

TEST(Pack, HasTheCountThatIsWrittenAndNoTwoBallsOverlap) {
  const Scene scene = pack(2,
                           "count: 300, ball: {mass_kg: 0.001, radius_m: 0.01}, region: {from_m: "
                           "[0, 0], to_m: [0.4, 0.3]}");
  ASSERT_EQ(scene.network.mats.size(), 300u);
  EXPECT_GE(smallest_distance(scene), 0.02 * (1.0 - 1e-15));
  EXPECT_EQ(scene.network.radius, std::vector<double>(300, 0.01));
  for (const engine::Mat& mat : scene.network.mats) {
    EXPECT_EQ(mat.mass, 0.001);
    EXPECT_GE(mat.position.head<2>().minCoeff(), 0.01 - 1e-15);
    EXPECT_LE(mat.position.x(), 0.39 + 1e-15);
    EXPECT_LE(mat.position.y(), 0.29 + 1e-15);
    EXPECT_EQ(mat.position.z(), 0.0);
  }
}

TEST(Pack, FillsTheShareOfTheRegionThatIsWritten) {
  const Scene flat = pack(2,
                          "fill: 0.72, ball: {mass_kg: 1, radius_m: 0.02}, region: {center_m: [0, "
                          "0], radius_m: 0.5}");
  EXPECT_EQ(flat.network.mats.size(), 450u);  // 0.72 * 0.5^2 / 0.02^2
  EXPECT_GE(smallest_distance(flat), 0.04 * (1.0 - 1e-15));
  for (const engine::Mat& mat : flat.network.mats) EXPECT_LE(mat.position.norm(), 0.48 + 1e-15);

  const Scene solid = pack(3,
                           "fill: 0.5, ball: {mass_kg: 1, radius_m: 0.05}, region: {from_m: [0, 0, "
                           "0], to_m: [1, 1, 1]}");
  EXPECT_EQ(solid.network.mats.size(), 955u);  // 0.5 / (4/3 pi 0.05^3) = 954.9
  EXPECT_GE(smallest_distance(solid), 0.1 * (1.0 - 1e-15));
}

TEST(Pack, IsTheSameOnEveryMachineAndOtherForAnotherSeed) {
  const std::string keys =
      "count: 400, ball: {mass_kg: 1, radius_m: 0.01}, region: {from_m: [0, 0, 0], to_m: [0.2, "
      "0.2, 0.1]}";
  EXPECT_EQ(hash_of(pack(3, keys)),
            2042320731252247319u);  // computed once; + - * / and sqrt round alike everywhere
  EXPECT_EQ(hash_of(pack(3, keys + ", seed: 1")), hash_of(pack(3, keys)));
  EXPECT_NE(hash_of(pack(3, keys + ", seed: 2")), hash_of(pack(3, keys)));
}

TEST(Pack, OfTenThousandBallsIsNoTrouble) {
  const int count = test::rounds(10'000);
  const std::string side = std::to_string(0.02 * std::cbrt(count));  // 52 % of the box
  const Scene scene = pack(3, "count: " + std::to_string(count) +
                                  ", ball: {mass_kg: 1, radius_m: 0.01}, region: {from_m: [0, 0, "
                                  "0], to_m: [" +
                                  side + ", " + side + ", " + side + "]}");
  ASSERT_EQ(scene.network.mats.size(), static_cast<std::size_t>(count));
  EXPECT_GE(smallest_distance(scene), 0.02 * (1.0 - 1e-15));
}

TEST(Pack, ThatJamsIsGivenUpEarly) {
  Region box;
  box.space = 3;
  box.lowest = Vec3::Zero();
  box.highest = Vec3::Constant(0.2);
  const double ball = 4.0 / 3.0 * std::numbers::pi * 1e-6;
  const auto count_of = [&](double fill) {
    return static_cast<std::size_t>(fill * box.measure() / ball);
  };
  const PackedBalls sparse = pack_balls(box, 0.01, count_of(0.55), 1);
  EXPECT_TRUE(sparse.centers.has_value());
  const PackedBalls jammed = pack_balls(box, 0.01, count_of(0.63), 1);
  EXPECT_FALSE(jammed.centers.has_value());
  EXPECT_LE(jammed.rounds, 500);
}

TEST(Pack, OfAlmostRandomCloseDensitySettles) {
  for (int seed = 1; seed <= test::rounds(3); ++seed) {
    const Scene solid = pack(3,
                             "fill: 0.58, ball: {mass_kg: 1, radius_m: 0.01}, region: {from_m: "
                             "[0, 0, 0], to_m: [0.3, 0.3, 0.3]}, seed: " +
                                 std::to_string(seed));
    ASSERT_EQ(solid.network.mats.size(), 3739u) << "seed " << seed;
    EXPECT_GE(smallest_distance(solid), 0.02 * (1.0 - 1e-15)) << "seed " << seed;
  }
  const Scene flat = pack(2,
                          "fill: 0.82, ball: {mass_kg: 1, radius_m: 0.01}, region: {from_m: "
                          "[0, 0], to_m: [0.5, 0.5]}");
  ASSERT_EQ(flat.network.mats.size(), 653u);
  EXPECT_GE(smallest_distance(flat), 0.02 * (1.0 - 1e-15));
}

TEST(Pack, ThatStillOverlapsSaysAfterHowManyRounds) {
  config::Problems problems;
  load_scene_text(scene_head(3) + R"(matter:
  a: {kind: pack, ball: {mass_kg: 1, radius_m: 0.01}, fill: 0.63, region: {from_m: [0, 0, 0], to_m: [0.3, 0.3, 0.3]}}
)",
                  "t", problems);
  ASSERT_EQ(problems.in_order().size(), 1u) << problems.text();
  EXPECT_EQ(problems.in_order()[0].message.find("4061 balls of matter 'a' still overlap after "),
            0u)
      << problems.text();
}

TEST(Pack, OfManyBallsThatAreSurelyTooManyIsRefusedUnseen) {
  config::Problems problems;
  load_scene_text(scene_head(3) + R"(matter:
  a: {kind: pack, ball: {mass_kg: 1, radius_m: 0.001}, fill: 0.66, region: {from_m: [0, 0, 0], to_m: [0.12, 0.12, 0.12]}}
)",
                  "t", problems);
  ASSERT_EQ(problems.in_order().size(), 1u) << problems.text();
  EXPECT_EQ(problems.in_order()[0].message,
            "272270 balls of matter 'a' do not fit into the region");
}

TEST(Pack, OfASingleBallInARegionOfItsSizeStandsInTheMiddle) {
  const Scene scene = pack(2,
                           "count: 1, ball: {mass_kg: 1, radius_m: 0.5}, region: {from_m: [0, 1], "
                           "to_m: [1, 2]}");
  EXPECT_EQ(scene.network.mats[0].position, Vec3(0.5, 1.5, 0));
}

}  // namespace
}  // namespace cordis::scene
