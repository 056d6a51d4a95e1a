// tests/device/pantograph_board.h -- an emulated board of a Haply 2DIY.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "device_node/drivers/pantograph.h"
#include "tests/device/force_log.h"
#include "tests/device/plug.h"

namespace cordis::test {

/// Takes its configuration, answers torques with angles, and keeps its last torques for good. As in
/// the published firmware, type 0 makes it forget its motors, but not the torques they have.
class PantographBoard {
 public:
  PantographBoard() : plug([this](std::uint8_t byte) { receive(byte); }, [] {}) {}

  /// In the order of the ports: the right motor first.
  std::array<std::atomic<float>, 2> degrees{};
  std::array<std::atomic<float>, 2> torques{};
  std::atomic<int> configurations{0};
  std::atomic<bool> says_nonsense_before{false};
  ForceLog log;

  /// Angles of a place of the pen.
  void put_pen(const device::Pantograph::Pair& pen) {
    device::Pantograph::Pair angle{};
    ASSERT_TRUE(device::Pantograph().inverse(pen, angle));
    degrees[0] = static_cast<float>(angle[1] * 180.0 / std::numbers::pi);
    degrees[1] = static_cast<float>(angle[0] * 180.0 / std::numbers::pi);
  }

 private:
  static constexpr std::size_t kConfiguration = 2 + 3 + 3 + 2 + 16;
  static constexpr std::size_t kTorques = 2 + 8;

  void receive(std::uint8_t byte) {
    bytes_.push_back(byte);
    if (bytes_[0] == 1 && bytes_.size() == kConfiguration) {
      EXPECT_EQ(bytes_[1], 5);
      EXPECT_EQ(bytes_[2], 3) << "ports 1 and 2";
      EXPECT_EQ(float_at(10), -61.0f) << "offset of port 1, the right arm";
      ++configurations;
      configured_ = true;
      bytes_.clear();
    } else if (bytes_[0] == 0 && bytes_.size() == 2) {
      configured_ = false;
      bytes_.clear();
    } else if (bytes_[0] == 2 && bytes_.size() == 2 && !configured_) {
      bytes_.clear();
    } else if (bytes_[0] == 2 && bytes_.size() == kTorques) {
      torques[0] = float_at(2);
      torques[1] = float_at(6);
      constexpr double kNone = 1e-6;  // [N m]
      const double largest = std::max(std::abs(torques[0]), std::abs(torques[1]));
      log.note(largest > kNone ? largest : 0.0);
      bytes_.clear();
      std::vector<std::uint8_t> answer{5};
      for (const auto& angle : degrees) {
        const auto bits = std::bit_cast<std::uint32_t>(angle.load());
        for (int i = 0; i < 4; ++i) answer.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
      }
      if (says_nonsense_before) {  // as a damaged answer that comes together with the next
        std::vector<std::uint8_t> nonsense(answer.size(), 0xff);
        nonsense[0] = answer[0];
        nonsense.insert(nonsense.end(), answer.begin(), answer.end());
        answer = std::move(nonsense);
      }
      plug.say(answer);
    } else if (bytes_[0] > 2) {
      bytes_.clear();
    }
  }
  float float_at(std::size_t offset) const {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i)
      bits |= static_cast<std::uint32_t>(bytes_[offset + i]) << (8 * i);
    return std::bit_cast<float>(bits);
  }
  std::vector<std::uint8_t> bytes_;
  bool configured_ = false;

 public:
  Plug plug;  // last: its thread uses the rest
};

}  // namespace cordis::test
