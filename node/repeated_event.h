// node/repeated_event.h -- one line per 5 s in the log, however often an event comes.
#pragma once

#include <cstdint>
#include <string>

#include <spdlog/common.h>

namespace cordis::node {

/// Events of one kind. The caller logs the first in words of its own; those that follow are
/// counted, and reported in one line at the end of 5 s: `WHAT: 37 more times in 5 s, the worst 12.3
/// ms`. One that comes after 5 s without any is a first one again. The destructor reports the rest.
///
/// Real time: record() and report() take no lock, and with a `what` of up to 120 bytes they
/// allocate nothing. One thread at a time.
class RepeatedEvent {
 public:
  static constexpr std::int64_t kWindowNsec = 5'000'000'000;

  /// @param what  begins the line
  explicit RepeatedEvent(std::string what,
                         spdlog::level::level_enum level = spdlog::level::warn) noexcept;
  ~RepeatedEvent();
  RepeatedEvent(const RepeatedEvent&) = delete;
  RepeatedEvent& operator=(const RepeatedEvent&) = delete;

  /// An event has come. @param now_nsec  CLOCK_MONOTONIC @param figure_s  how bad it is [s]; 0: it
  /// has no figure. @return whether the caller logs it
  [[nodiscard]] bool record(std::int64_t now_nsec, double figure_s = 0.0) noexcept;

  /// Reports what was counted, once 5 s are over. To be called at least now and then.
  void report(std::int64_t now_nsec) noexcept;

 private:
  void log_count(bool window_is_over) noexcept;

  std::string what_;
  spdlog::level::level_enum level_;
  bool is_open_ = false;  // the first event was less than a window ago
  std::int64_t begun_nsec_ = 0;
  std::uint64_t count_ = 0;  // of those after the first
  double worst_s_ = 0.0;
};

}  // namespace cordis::node
