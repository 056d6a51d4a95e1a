// node/tick_rate.cpp
#include "node/tick_rate.h"

namespace cordis::node {
namespace {

// Between two close looks a rate would be noise.
constexpr std::int64_t kMinNsec = 100'000'000;

}  // namespace

double TickRate::rate(const Reading& older, const Reading& newer) noexcept {
  return static_cast<double>(newer.ticks - older.ticks) /
         (static_cast<double>(newer.nsec - older.nsec) * 1e-9);
}

void TickRate::update(std::int64_t now_nsec, std::uint64_t ticks) noexcept {
  const Reading now{now_nsec, ticks};
  looked_ = now;
  if (first_.ticks == 0) {
    if (ticks > 0 && now.nsec > first_.nsec) mean_hz_ = rate(first_, now);
    first_ = now;
  } else if (now.nsec - first_.nsec >= kMinNsec) {
    mean_hz_ = rate(first_, now);
  }
  if (now.nsec - last_.nsec < kMinNsec) return;
  reached_hz_ = rate(last_, now);
  last_ = now;
}

void TickRate::skip_pause(std::int64_t now_nsec, std::uint64_t ticks) noexcept {
  const bool had_ticks = first_.ticks > 0;
  first_.nsec += now_nsec - looked_.nsec;
  first_.ticks += had_ticks ? ticks - looked_.ticks : ticks;
  looked_ = {now_nsec, ticks};
}

void TickRate::restart(std::int64_t now_nsec, std::uint64_t ticks) noexcept {
  first_ = {now_nsec, ticks};
}

}  // namespace cordis::node
