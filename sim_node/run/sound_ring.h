// sim_node/run/sound_ring.h -- blocks of sound on their way out of the loop.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/run/step_rows.h"
#include "sim_node/scene/signal.h"

namespace cordis::sim {

/// One block: the sounds of consecutive steps.
struct SoundBlock {
  static constexpr std::size_t kMaxValues = 2048;

  std::uint64_t version = 0;  ///< version of the description
  std::uint64_t first_step = 0;
  std::int64_t time_nsec = 0;  ///< CLOCK_MONOTONIC when the last sample was taken
  double step_rate_hz = 0.0;
  std::uint32_t sound_count = 0;
  std::uint32_t step_count = 0;
  std::uint32_t dropped_steps = 0;  ///< before the first one
  std::array<float, kMaxValues> values{};
};

/// A ring of blocks between the loop, which fills them, and one other thread, which publishes them.
/// Real time: add() takes no lock and allocates nothing; when the other thread has fallen behind by
/// kBlocks the steps are dropped and counted.
class SoundRing {
 public:
  static constexpr std::size_t kBlocks = 32;
  static constexpr double kBlockLength = 0.008;  ///< [s]

  SoundRing() : blocks_(kBlocks) {}

  /// Loop: the sounds among the rows of a turn. @param version  of the description of the scene
  /// @return whether a block has become full, and the other thread has something to do
  bool add(const StepRows& rows, const scene::SignalReader& signals, std::uint64_t version,
           double step_rate_hz, std::int64_t now_nsec) noexcept {
    return add({0, rows.count()}, rows, signals, version, step_rate_hz, now_nsec);
  }

  /// Loop: ends the block that is being filled. @return whether there was one
  bool flush(std::int64_t now_nsec) noexcept { return present_steps_ > 0 && commit(now_nsec); }

  /// Loop without real time: the same, but waits where there is no room, so that no step is dropped,
  /// however long the turn is. @param wake  wakes the other thread, for which a block is full
  template <class Wake>
  void add_all(const StepRows& rows, const scene::SignalReader& signals, std::uint64_t version,
               double step_rate_hz, std::int64_t now_nsec, Wake wake) noexcept {
    // Blocks have a step or more, so that as many rows as blocks always find room.
    for (std::size_t first = 0; first < rows.count(); first += kRoom) {
      wait_for_room();
      const Range range{first, std::min(first + kRoom, rows.count())};
      if (add(range, rows, signals, version, step_rate_hz, now_nsec)) wake();
    }
  }

  /// The other thread: the oldest full block, which it keeps until pop(); nullptr when there is none.
  const SoundBlock* front() const noexcept;
  void pop() noexcept;

 private:
  static constexpr std::size_t kRoom = kBlocks / 2;  // blocks that are free after a wait

  struct Range {
    std::size_t first = 0;
    std::size_t end = 0;
  };
  bool add(Range range, const StepRows& rows, const scene::SignalReader& signals,
           std::uint64_t version, double step_rate_hz, std::int64_t now_nsec) noexcept;
  void wait_for_room() const noexcept;
  bool commit(std::int64_t now_nsec) noexcept;
  bool is_full() const noexcept {
    return filled_.load(std::memory_order_relaxed) - taken_.load(std::memory_order_acquire) >=
           kBlocks;
  }
  SoundBlock& present() noexcept {
    return blocks_[filled_.load(std::memory_order_relaxed) % kBlocks];
  }

  std::vector<SoundBlock> blocks_;
  std::uint32_t present_steps_ = 0;  // in the block being filled
  std::uint32_t dropped_steps_ = 0;  // since a block had room
  std::atomic<std::uint64_t> filled_{0};
  std::atomic<std::uint64_t> taken_{0};
};

}  // namespace cordis::sim
