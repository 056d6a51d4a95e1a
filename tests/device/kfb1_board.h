// tests/device/kfb1_board.h -- a keyboard on the table: the reference firmware behind a wire.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>

#include "device_node/firmware/kfb1.h"
#include "node/time.h"
#include "tests/device/force_log.h"
#include "tests/device/plug.h"

namespace cordis::test {

/// A board on which the reference firmware runs, and a wire that may harm what it says. Travel
/// 0.04 m, largest force 10 N. One at a time.
class Kfb1Board {
 public:
  explicit Kfb1Board(int keys = 2)
      : plug([this](std::uint8_t byte) { receive(byte); }, [this] { idle(); }) {
    board_ = this;
    kfb1_board& what = what_;
    what.keys = static_cast<std::uint8_t>(keys);
    what.travel_um = 40000;
    what.force_mn = 10000;
    what.rate_hz = 1000;
    what.position = [](std::uint8_t key) { return board_->positions[key].load(); };
    what.force = [](std::uint8_t key, std::int16_t force) {
      board_->forces[key] = force;
      double largest = 0.0;
      for (const auto& f : board_->forces) largest = std::max(largest, std::abs(1.0 * f));
      board_->log.note(largest);
      if (board_->on_force) board_->on_force(key, force);
    };
    what.touched = [] { return std::uint16_t{1}; };
    what.time_us = [] {
      return static_cast<std::uint32_t>((node::monotonic_nsec() - board_->started_nsec_) / 1000);
    };
    what.send = [](const std::uint8_t* bytes, std::uint8_t count) {
      if (board_->is_mute) return;
      if (board_->miscounts) return board_->say_with_wrong_check(bytes, count);
      board_->plug.say({bytes, count});
    };
    kfb1_start(&firmware_, &what);
  }

  std::array<std::atomic<std::int16_t>, KFB1_MAX_KEYS> positions{};
  std::array<std::atomic<std::int16_t>, KFB1_MAX_KEYS> forces{};
  std::atomic<bool> has_watchdog{true};
  std::atomic<bool> miscounts{
      false};                         ///< its frames are whole, and their checksums those of others
  std::atomic<int> event{0};          ///< code that it goes on to send; 0: none
  std::atomic<bool> is_deaf{false};   ///< it takes no byte in
  std::atomic<bool> is_mute{false};   ///< it says nothing
  std::atomic<bool> restarts{false};  ///< at once; it takes that back itself
  std::atomic<double> deaf_for_s{0.0};  ///< after the first byte that comes, as while it resets
  ForceLog log;
  /// Called on the thread of the plug; to be set before it is plugged in.
  std::function<void(int key, int force)> on_force;

 private:
  /// Only the checksum betrays the frame: its code is right, and a position in it is another one.
  void say_with_wrong_check(const std::uint8_t* bytes, std::uint8_t count) {
    std::uint8_t payload[KFB1_LARGEST_FRAME];
    std::uint8_t frame[KFB1_LARGEST_FRAME];
    const std::uint8_t length =
        kfb1_decode(bytes, static_cast<std::uint8_t>(count - 1), payload);  // without the 0
    constexpr std::uint8_t kPosition = 9;  // high byte of the first key in STATE
    payload[kPosition] ^= 0x20;
    plug.say({frame, kfb1_encode(payload, length, frame)});
  }

  void receive(std::uint8_t byte) {
    const std::int64_t now = node::monotonic_nsec();
    if (first_byte_nsec_ == 0) first_byte_nsec_ = now;
    if (is_deaf) return;
    if (static_cast<double>(now - first_byte_nsec_) * 1e-9 >= deaf_for_s) {
      kfb1_byte(&firmware_, byte);
    }
  }

  void idle() {
    if (restarts.exchange(false)) {
      started_nsec_ = node::monotonic_nsec();
      kfb1_start(&firmware_, &what_);
    }
    if (event != 0) kfb1_event(&firmware_, static_cast<std::uint8_t>(event.load()));
    if (has_watchdog) kfb1_tick(&firmware_);
  }

  static inline Kfb1Board* board_ = nullptr;  // the firmware's functions know no other
  kfb1_board what_{};
  kfb1 firmware_{};
  std::int64_t first_byte_nsec_ = 0;
  std::int64_t started_nsec_ = 0;

 public:
  Plug plug;  // last: its thread uses the rest
};

}  // namespace cordis::test
