// node/tick_rate.h -- how often a loop has turned.
#pragma once

#include <cstdint>

namespace cordis::node {

/// The rate of a loop, from the number of its ticks as it is looked at now and then. What the loop
/// waited before its first tick does not count, and no pause does.
class TickRate {
 public:
  explicit TickRate(std::int64_t now_nsec) noexcept
      : first_{now_nsec, 0}, looked_(first_), last_(first_) {}

  void update(std::int64_t now_nsec, std::uint64_t ticks) noexcept;

  /// The loop was paused since the look before: the mean counts neither that time nor its ticks. An
  /// update() follows.
  void skip_pause(std::int64_t now_nsec, std::uint64_t ticks) noexcept;

  /// The loop aims at another rate from now on: the mean begins again.
  void restart(std::int64_t now_nsec, std::uint64_t ticks) noexcept;

  double reached_hz() const noexcept { return reached_hz_; }  ///< lately
  double mean_hz() const noexcept {
    return mean_hz_;
  }  ///< since the ticks began, or restart(); without pauses

 private:
  struct Reading {
    std::int64_t nsec;
    std::uint64_t ticks;
  };
  static double rate(const Reading& older, const Reading& newer) noexcept;

  Reading first_;   // when ticks had begun, later by the pauses since then
  Reading looked_;  // at the look before
  Reading last_;    // of the reached rate
  double reached_hz_ = 0.0;
  double mean_hz_ = 0.0;
};

}  // namespace cordis::node
