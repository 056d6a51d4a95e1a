// tests/device/faders.h -- an emulated FireFader.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>

#include "tests/device/force_log.h"
#include "tests/device/plug.h"

namespace cordis::test {

/// Answers each request as the firmware of the faders does, and keeps its last force for good.
class Faders {
 public:
  Faders() : plug([this](std::uint8_t byte) { receive(byte); }, [] {}) {}

  std::array<std::atomic<int>, 2> forces{};              // -126..126
  std::array<std::atomic<std::uint8_t>, 2> positions{};  // 0..254
  ForceLog log;

 private:
  void receive(std::uint8_t byte) {
    if (byte == 127) {
      count_ = 0;
      return;
    }
    if (count_ >= 2) return;
    forces[count_++] = static_cast<std::int8_t>(byte);
    if (count_ < 2) return;
    log.note(std::max(std::abs(forces[0]), std::abs(forces[1])));
    const std::uint8_t answer[] = {255, positions[0], positions[1], 0, 0, 1, 1};
    plug.say(answer);
  }
  std::size_t count_ = 2;

 public:
  Plug plug;  // last: its thread uses the rest
};

}  // namespace cordis::test
