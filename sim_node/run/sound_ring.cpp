// sim_node/run/sound_ring.cpp
#include "sim_node/run/sound_ring.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cordis::sim {
namespace {

std::uint32_t steps_per_block(std::size_t sounds, double step_rate_hz) noexcept {
  const std::size_t most = SoundBlock::kMaxValues / sounds;
  return static_cast<std::uint32_t>(std::clamp(std::round(SoundRing::kBlockLength * step_rate_hz),
                                               1.0, static_cast<double>(most)));
}

}  // namespace

bool SoundRing::add(Range range, const StepRows& rows, const scene::SignalReader& signals,
                    std::uint64_t version, double step_rate_hz, std::int64_t now_nsec) noexcept {
  const std::vector<std::size_t>& sounds = signals.sounds();
  if (sounds.empty() && present_steps_ == 0) return false;
  bool any = false;
  if (present_steps_ > 0 && present().version != version) any = commit(now_nsec);
  if (sounds.empty()) return any;
  const std::uint32_t block_steps = steps_per_block(sounds.size(), step_rate_hz);
  for (std::size_t r = range.first; r < range.end; ++r) {
    if (present_steps_ == 0 && is_full()) {
      ++dropped_steps_;
      continue;
    }
    SoundBlock& block = present();
    if (present_steps_ == 0) {
      block.version = version;
      block.first_step = rows.first_step() + r;
      block.step_rate_hz = step_rate_hz;
      block.sound_count = static_cast<std::uint32_t>(sounds.size());
      block.dropped_steps = std::exchange(dropped_steps_, 0);
    }
    float* values = block.values.data() + present_steps_ * sounds.size();
    for (const std::size_t sound : sounds) *values++ = static_cast<float>(rows.row(r)[sound]);
    if (++present_steps_ == block_steps) any = commit(now_nsec) || any;
  }
  return any;
}

bool SoundRing::commit(std::int64_t now_nsec) noexcept {
  present().step_count = std::exchange(present_steps_, 0);
  present().time_nsec = now_nsec;
  filled_.fetch_add(1, std::memory_order_release);
  return true;
}

void SoundRing::wait_for_room() const noexcept {
  for (;;) {
    const std::uint64_t taken = taken_.load(std::memory_order_acquire);
    if (filled_.load(std::memory_order_relaxed) - taken < kRoom) return;
    taken_.wait(taken, std::memory_order_acquire);
  }
}

const SoundBlock* SoundRing::front() const noexcept {
  const std::uint64_t taken = taken_.load(std::memory_order_relaxed);
  return taken == filled_.load(std::memory_order_acquire) ? nullptr : &blocks_[taken % kBlocks];
}

void SoundRing::pop() noexcept {
  taken_.fetch_add(1, std::memory_order_release);
  taken_.notify_one();
}

}  // namespace cordis::sim
