// viz_node/web/flow_credit.cpp
#include "viz_node/web/flow_credit.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::viz {

FlowCredit::FlowCredit(std::uint32_t every) noexcept : every_(every) {
  CORDIS_ASSERT(every > 0);
}

bool FlowCredit::may_send(std::uint32_t newest, std::int64_t now_nsec) const noexcept {
  if (newest <= last_sent_) return false;
  if (last_sent_ != 0 && newest - last_sent_ < every_) return false;
  return count_ < kMaxUnacknowledged || now_nsec - last_sent_nsec_ >= kAckTimeoutNsec;
}

void FlowCredit::sent(std::uint32_t sequence, std::int64_t taken_nsec,
                      std::int64_t now_nsec) noexcept {
  CORDIS_ASSERT(may_send(sequence, now_nsec));
  if (count_ == kMaxUnacknowledged) forget_oldest(1);
  if (last_sent_ != 0) dropped_ += sequence - last_sent_ - every_;
  last_sent_ = sequence;
  last_sent_nsec_ = now_nsec;
  flights_[count_++] = {sequence, taken_nsec};
}

std::optional<std::int64_t> FlowCredit::acknowledge(std::uint32_t sequence) noexcept {
  std::optional<std::int64_t> taken;
  std::size_t done = 0;
  for (; done < count_ && flights_[done].sequence <= sequence; ++done) {
    if (flights_[done].sequence == sequence) taken = flights_[done].taken_nsec;
  }
  forget_oldest(done);
  return taken;
}

void FlowCredit::forget_oldest(std::size_t flights) noexcept {
  std::shift_left(flights_.begin(), flights_.end(), static_cast<std::ptrdiff_t>(flights));
  count_ -= flights;
}

}  // namespace cordis::viz
