// sim_node/devices/sample_sequence.cpp
#include "sim_node/devices/sample_sequence.h"

#include <algorithm>
#include <cmath>

#include "node/assert.h"

namespace cordis::sim {

SampleSequence::SampleSequence(double rate_hz, int patience_ticks)
    : max_jump_(static_cast<std::uint64_t>(std::max(1L, std::lround(kMaxJump * rate_hz)))),
      patience_ticks_(patience_ticks),
      patience_nsec_(std::llround(patience_ticks * 1e9 / rate_hz)) {
  CORDIS_ASSERT(rate_hz > 0.0);
  CORDIS_ASSERT(patience_ticks > 0);
}

SampleSequence::Position SampleSequence::receive(std::uint64_t epoch, std::uint64_t number,
                                                 std::int64_t time_nsec) noexcept {
  Position position;
  if (epoch != epoch_) {
    position.restarts = true;
  } else if (number == number_) {
    return {.order = Order::kRepeated};
  } else {
    const bool is_later = number > number_;
    const std::uint64_t jump = is_later ? number - number_ : number_ - number;
    if (!is_later && jump <= max_jump_ && ++older_in_a_row_ < patience_ticks_)
      return {.order = Order::kOlder};
    position.restarts = !is_later || jump > max_jump_;
    if (is_later && jump > 1) {
      lost_count_ += std::min(jump - 1, max_jump_);
      std::int64_t gap_nsec = 0;  // times are as hostile as numbers
      const bool is_far = __builtin_sub_overflow(time_nsec, time_nsec_, &gap_nsec);
      position.after_gap = is_far || gap_nsec > patience_nsec_;
    }
  }
  older_in_a_row_ = 0;
  epoch_ = epoch;
  number_ = number;
  time_nsec_ = time_nsec;
  return position;
}

void SampleSequence::continue_from(const SampleSequence& before) noexcept {
  epoch_ = before.epoch_;
  number_ = before.number_;
  time_nsec_ = before.time_nsec_;
  lost_count_ = before.lost_count_;
}

}  // namespace cordis::sim
