// tests/viz/frame_size_test.cpp
#include "viz_node/frame_size.h"

#include <random>

#include <gtest/gtest.h>

#include "node/dds/payload.h"
#include "tests/viz/scenes_for_tests.h"

namespace cordis::viz {
namespace {

TEST(FrameSize, IsThatOfTheLargestFrameOnTheWire) {
  std::mt19937 random(20261127);
  for (int i = 0; i < 200; ++i) {
    msg::SceneDescription description = i % 2 == 0 ? row_of_three() : bonding_row();
    const std::size_t mats = random() % 20'000;
    const std::size_t links = i % 4 < 2 ? 0 : random() % 20'000;
    description.mat_kind(std::vector<std::uint8_t>(mats));
    description.link_state_machine(std::vector<std::uint32_t>(links));
    msg::SceneFrame frame = frame_of_three(1);
    frame.position_m(std::vector<float>(3 * mats));
    frame.link_state(std::vector<std::uint8_t>(links));
    frame.port_force_n(std::vector<float>(3 * description.ports().size()));
    if (!description.sets().empty()) {
      frame.bond_ends(std::vector<std::uint32_t>(std::size_t{2} * msg::MAX_BONDS));
      frame.bond_state(std::vector<std::uint8_t>(msg::MAX_BONDS));
      frame.bond_count(std::vector<std::uint32_t>(description.sets().size()));
    }
    const std::size_t bytes = dds::encode(frame).size();

    EXPECT_GE(largest_frame_bytes(description), bytes);
    EXPECT_LE(largest_frame_bytes(description), bytes + 128);
  }
}

TEST(FrameSize, TwoFramesMustFitASocket) {
  EXPECT_TRUE(arrives_whole(120'000, 240'000));
  EXPECT_FALSE(arrives_whole(120'001, 240'000));
  EXPECT_FALSE(arrives_whole(1, 0)) << "the kernel does not say";
}

}  // namespace
}  // namespace cordis::viz
