// viz_node/web/client_credit.cpp
#include "viz_node/web/client_credit.h"

#include <algorithm>

namespace cordis::viz {

bool ClientCredit::may_send(std::uint32_t newest) const noexcept {
  return newest > last_sent_ && count_ < kMostUnacknowledged;
}

void ClientCredit::sent(std::uint32_t sequence, std::int64_t taken_nsec) noexcept {
  if (last_sent_ != 0) dropped_ += sequence - last_sent_ - 1;
  last_sent_ = sequence;
  flights_[count_++] = {sequence, taken_nsec};
}

std::optional<std::int64_t> ClientCredit::acknowledge(std::uint32_t sequence) noexcept {
  std::optional<std::int64_t> taken;
  std::size_t done = 0;
  for (; done < count_ && flights_[done].sequence <= sequence; ++done) {
    if (flights_[done].sequence == sequence) taken = flights_[done].taken_nsec;
  }
  std::shift_left(flights_.begin(), flights_.end(), static_cast<std::ptrdiff_t>(done));
  count_ -= done;
  return taken;
}

}  // namespace cordis::viz
