// tests/viz/frame_encoder_test.cpp
#include "viz_node/frame_encoder.h"

#include <cstring>

#include <gtest/gtest.h>

#include "tests/viz/scenes_for_tests.h"

namespace cordis::viz {
namespace {

template <class Value, class Bytes>
Value value_at(const Bytes& bytes, std::size_t offset) {
  Value value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

template <class Bytes>
void expect_prefix(const Bytes& bytes, MessageType type, std::size_t header_bytes) {
  EXPECT_EQ(std::memcmp(bytes.data(), "CDS1", 4), 0);
  EXPECT_EQ(value_at<std::uint8_t>(bytes, 4), 4);
  EXPECT_EQ(value_at<std::uint8_t>(bytes, 5), static_cast<std::uint8_t>(type));
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 6), header_bytes);
}

TEST(FrameEncoder, PutsTheFieldsOfAFrameWhereTheProtocolSays) {
  const auto bytes = encode({.sequence = 1,
                             .scene = 2,
                             .frame = 3,
                             .step = 4,
                             .taken_nsec = -5,
                             .sent_nsec = 6,
                             .simulated_s = 7.5,
                             .mat_count = 8,
                             .link_state_count = 9,
                             .dropped = 10,
                             .bond_count = 11,
                             .bonds_left_out = 12,
                             .set_count = 13,
                             .port_count = 14});

  expect_prefix(bytes, MessageType::kFrame, 88);
  ASSERT_EQ(bytes.size(), 88u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 8), 1u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 12), 2u);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 16), 3u);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 24), 4u);
  EXPECT_EQ(value_at<std::int64_t>(bytes, 32), -5);
  EXPECT_EQ(value_at<std::int64_t>(bytes, 40), 6);
  EXPECT_EQ(value_at<double>(bytes, 48), 7.5);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 56), 8u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 60), 9u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 64), 10u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(value_at<std::uint32_t>(bytes, 68 + 4 * k), 11 + k);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 84), 0u);
}

TEST(FrameEncoder, PutsSignalsRowAfterRowWithTheTimeOfTheFirst) {
  const std::string bytes =
      encode_signals(signals_of_three(/*first_step=*/500, /*rows=*/3), 7, 2000.0);

  expect_prefix(bytes, MessageType::kSignals, 48);
  ASSERT_EQ(bytes.size(), 48u + 3 * 2 * 4);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 8), 7u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 12), 2u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 16), 3u);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 24), 500u);
  EXPECT_EQ(value_at<double>(bytes, 32), 0.25);   // 500 steps at 2000 Hz
  EXPECT_EQ(value_at<double>(bytes, 40), 0.001);  // 2 steps at 2000 Hz
  EXPECT_EQ(value_at<float>(bytes, 48 + 2 * 8), 2.0F);
  EXPECT_EQ(value_at<float>(bytes, 48 + 2 * 8 + 4), -2.0F);
}

TEST(FrameEncoder, PutsTheMeanStrideOfRowsThatAreNotEvenlyApart) {
  msg::SceneSignals signals = signals_of_three(/*first_step=*/44, /*rows=*/11);
  signals.stride_steps(44);
  signals.row_step({0, 44, 88, 132, 176, 220, 264, 308, 352, 397, 441});
  EXPECT_EQ(value_at<double>(encode_signals(signals, 7, 44'100.0), 40), 0.001);
}

TEST(FrameEncoder, PutsRadiiMassesEndsAndKindsIntoTheTopology) {
  const std::string bytes = encode_topology(row_of_three(), 9);

  expect_prefix(bytes, MessageType::kTopology, 24);
  ASSERT_EQ(bytes.size(), 24u + 3 * 4 + 3 * 4 + 4 * 4 + 3);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 8), 9u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 12), 3u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 16), 2u);
  EXPECT_EQ(value_at<float>(bytes, 24 + 4), 0.25F);
  EXPECT_EQ(value_at<float>(bytes, 36), 0.0F);
  EXPECT_EQ(value_at<float>(bytes, 36 + 4), 0.5F);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 48 + 12), 2u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 20), 0u);
  EXPECT_EQ(value_at<std::uint8_t>(bytes, 64 + 2), 2);
}

TEST(FrameEncoder, PutsTheStateMachineOfEachLinkIntoTheTopology) {
  msg::SceneDescription description = row_of_three();
  description.link_state_machine({1, msg::NO_INDEX});
  const std::string bytes = encode_topology(description, 9);

  ASSERT_EQ(bytes.size(), 24u + 3 * 4 + 3 * 4 + 4 * 4 + 2 * 2 + 3);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 20), 2u);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 64), 1u);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 66), kNoStateMachine);
  EXPECT_EQ(value_at<std::uint8_t>(bytes, 68 + 2), 2);
}

TEST(FrameEncoder, PutsSoundStepAfterStepWithItsRate) {
  msg::SceneSound sound = sound_of_row(/*first_step=*/500, /*steps=*/4);
  sound.sound_count(2);  // two steps of two sounds
  const std::string bytes = encode_sound(sound, 7);

  expect_prefix(bytes, MessageType::kSound, 48);
  ASSERT_EQ(bytes.size(), 48u + 4 * 4);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 8), 7u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 12), 2u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 16), 2u);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 20), 3u);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 24), 500u);
  EXPECT_EQ(value_at<double>(bytes, 32), 2000.0);
  EXPECT_EQ(value_at<std::int64_t>(bytes, 40), -7);
  EXPECT_EQ(value_at<float>(bytes, 48 + 3 * 4), 3.0F);
}

}  // namespace
}  // namespace cordis::viz
