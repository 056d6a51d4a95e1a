// tests/engine/vector_width_test.cpp
#include "sim_node/engine/core/vector_width.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

TEST(VectorWidth, AlwaysIncludesTheNarrowest) {
  EXPECT_EQ(engine::supported_vector_widths().front(), VectorWidth::kSse2);
}

TEST(VectorWidth, IsTheOneAWorldIsMadeWith) {
  for (const VectorWidth width : engine::supported_vector_widths()) {
    EXPECT_EQ(make_world(free_cluster(3, 4, 0.1), width).vector_width(), width);
  }
  EXPECT_EQ(make_world(free_cluster(3, 4, 0.1)).vector_width(), engine::best_vector_width());
}

TEST(VectorWidth, HasANameOfItsOwn) {
  EXPECT_EQ(engine::to_string(VectorWidth::kSse2), std::string("sse2"));
  EXPECT_EQ(engine::to_string(VectorWidth::kAvx2), std::string("avx2"));
  EXPECT_EQ(engine::to_string(VectorWidth::kAvx512), std::string("avx512"));
}

TEST(VectorWidth, ThatTheProcessorLacksIsRefused) {
  const std::vector<VectorWidth> supported = engine::supported_vector_widths();
  for (const VectorWidth width : {VectorWidth::kAvx2, VectorWidth::kAvx512}) {
    const bool lacking = std::find(supported.begin(), supported.end(), width) == supported.end();
    if (lacking) {
      EXPECT_THROW(make_world(free_cluster(3, 4, 0.1), width), std::invalid_argument);
    } else {
      EXPECT_NO_THROW(make_world(free_cluster(3, 4, 0.1), width));
    }
  }
}

class VectorWidths : public testing::TestWithParam<int> {};

TEST_P(VectorWidths, StepToTheSameBits) {
  NetworkDescription scene = free_cluster(40, 157, 0.2, GetParam());
  scene.gravity.x() = 1.5;
  scene.medium_viscosity = 0.01;
  World narrow = make_world(scene, VectorWidth::kSse2);
  run(narrow, 500);

  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(scene, width);
    run(world, 500);
    EXPECT_EQ(world.state_hash(), narrow.state_hash()) << engine::to_string(width);
    EXPECT_EQ(world.energy().dissipated, narrow.energy().dissipated) << engine::to_string(width);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, VectorWidths, testing::Values(1, 2, 3));

}  // namespace
}  // namespace cordis::test
