// tests/support/timer_control.cpp
#include "tests/support/timer_control.h"

#include <algorithm>
#include <cstdio>
#include <ctime>

namespace cordis::test {
namespace {

constexpr std::int64_t kPeriodNsec = 1'000'000;

std::int64_t now_nsec() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

void sleep_until(std::int64_t nsec) noexcept {
  const timespec until{nsec / 1'000'000'000, nsec % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

}  // namespace

TimerControl::TimerControl() : due_nsec_(now_nsec() + kPeriodNsec), thread_([this] { run(); }) {}

TimerControl::~TimerControl() {
  ends_ = true;
  thread_.join();
}

void TimerControl::run() noexcept {
  while (!ends_) {
    sleep_until(due_nsec_);
    const std::int64_t now = now_nsec();
    worst_nsec_ = std::max(worst_nsec_.load(), now - due_nsec_);
    ++wakes_;
    due_nsec_ = std::max(due_nsec_ + kPeriodNsec, now);
  }
}

std::chrono::nanoseconds TimerControl::worst() const noexcept {
  return std::chrono::nanoseconds(std::max(worst_nsec_.load(), now_nsec() - due_nsec_));
}

std::string TimerControl::reason_to_skip(std::chrono::nanoseconds bearable) const {
  const std::chrono::nanoseconds seen = worst();
  if (seen <= bearable) return "";
  char text[96];
  std::snprintf(text, sizeof text, "this machine wakes timers %.3g ms late",
                std::chrono::duration<double, std::milli>(seen).count());
  return text;
}

}  // namespace cordis::test
