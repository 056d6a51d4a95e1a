// node/repeated_event.cpp
#include "node/repeated_event.h"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/milliseconds.h"

namespace cordis::node {

RepeatedEvent::RepeatedEvent(std::string what, spdlog::level::level_enum level) noexcept
    : what_(std::move(what)), level_(level) {}

RepeatedEvent::~RepeatedEvent() {
  log_count(/*window_is_over=*/false);
}

bool RepeatedEvent::record(std::int64_t now_nsec, double figure_s) noexcept {
  report(now_nsec);
  if (!is_open_) {
    is_open_ = true;
    begun_nsec_ = now_nsec;
    return true;
  }
  ++count_;
  worst_s_ = std::max(worst_s_, figure_s);
  return false;
}

void RepeatedEvent::report(std::int64_t now_nsec) noexcept {
  if (!is_open_ || now_nsec - begun_nsec_ < kWindowNsec) return;
  is_open_ = count_ > 0;  // while they go on, each window has its line
  log_count(/*window_is_over=*/true);
  begun_nsec_ = now_nsec;
  count_ = 0;
  worst_s_ = 0.0;
}

void RepeatedEvent::log_count(bool window_is_over) noexcept {
  if (count_ == 0) return;
  const char* const times = count_ == 1 ? "time" : "times";
  const char* const span = window_is_over ? " in 5 s" : "";
  if (worst_s_ > 0.0) {
    spdlog::log(level_, "{}: {} more {}{}, the worst {}", what_, count_, times, span,
                milliseconds_text(worst_s_));
  } else {
    spdlog::log(level_, "{}: {} more {}{}", what_, count_, times, span);
  }
}

}  // namespace cordis::node
