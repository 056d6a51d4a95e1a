// tests/device/kfb1_board.h -- a keyboard on the table: the reference firmware behind a wire.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>

#include "device_node/firmware/kfb1.h"
#include "node/time.h"
#include "tests/device/plug.h"

namespace cordis::test {

/// A board on which the reference firmware runs, and a wire that may harm what it says. Travel
/// 0.04 m, largest force 10 N. One at a time.
class Kfb1Board {
 public:
  explicit Kfb1Board(int keys = 2)
      : plug([this](std::uint8_t byte) { kfb1_byte(&firmware_, byte); },
             [this] { kfb1_tick(&firmware_); }) {
    board_ = this;
    kfb1_board what{};
    what.keys = static_cast<std::uint8_t>(keys);
    what.travel_um = 40000;
    what.force_mn = 10000;
    what.rate_hz = 1000;
    what.position = [](std::uint8_t key) { return board_->positions[key].load(); };
    what.force = [](std::uint8_t key, std::int16_t force) {
      board_->forces[key] = force;
      if (board_->on_force) board_->on_force(key, force);
    };
    what.touched = [] { return std::uint16_t{1}; };
    what.time_us = [] { return static_cast<std::uint32_t>(node::monotonic_nsec() / 1000); };
    what.send = [](const std::uint8_t* bytes, std::uint8_t count) {
      board_->plug.say({bytes, count});
    };
    kfb1_start(&firmware_, &what);
  }

  std::array<std::atomic<std::int16_t>, KFB1_MAX_KEYS> positions{};
  std::array<std::atomic<std::int16_t>, KFB1_MAX_KEYS> forces{};
  /// Called on the thread of the plug; to be set before it is plugged in.
  std::function<void(int key, int force)> on_force;

 private:
  static inline Kfb1Board* board_ = nullptr;  // the firmware's functions know no other
  kfb1 firmware_{};

 public:
  Plug plug;  // last: its thread uses the rest
};

}  // namespace cordis::test
