// node/period_grid.h -- periods whose phase follows what arrives.
#pragma once

#include <cstdint>

namespace cordis::node {

/// The periods of a loop that plays one tick in each: as soon as all it waits for has arrived, or at
/// the end of the period. Knows no clock.
///
/// The periods follow the phase of the arrivals, which then come in the middle of a period: what is
/// late or early by less than half a period still belongs to its own. A phase-locked loop of first
/// order moves the periods by 1/16 of the error of each arrival, by at most kLargestShift. A sender
/// of another rate, or one that lies, cannot carry the rate away: beyond one whole period in
/// reserve, all shifts together stay within kLargestDrift of the time that passes.
/// Source: Gardner, Phaselock Techniques, first-order loop.
class PeriodGrid {
 public:
  static constexpr double kLargestShift = 0.01;   ///< by an arrival [periods]
  static constexpr double kLargestDrift = 0.001;  ///< largest error of the rate, in the long run

  /// The first period ends at the next middle between two whole multiples of the period: what is
  /// sent at these multiples arrives soon after the middle of a period.
  /// @param rate_hz   periods per second, > 0
  /// @param now_nsec  any time >= 0, of the clock of all other times
  PeriodGrid(double rate_hz, std::int64_t now_nsec) noexcept;

  double rate_hz() const noexcept { return rate_hz_; }
  /// When the present period begins and ends [ns]. Its tick belongs between the two.
  std::int64_t begin_nsec() const noexcept { return end_of(index_ - 1); }
  std::int64_t end_nsec() const noexcept { return end_of(index_); }

  /// All that the tick of the present period waits for had arrived at that time.
  void follow(std::int64_t arrival_nsec) noexcept;

  /// The tick of the present period begins now: the next one is present from here on. A tick that
  /// begins a period or more after its end stands for those that it missed: they are skipped.
  /// @return the number of periods skipped
  std::uint64_t advance(std::int64_t now_nsec) noexcept;

 private:
  std::int64_t end_of(std::int64_t index) const noexcept;

  double rate_hz_;
  double period_nsec_;
  std::int64_t index_ = 0;  // of the present period, from the time 0 of the clock
  double shift_nsec_ = 0.0;
  double reserve_;  // for shifts [periods]
};

}  // namespace cordis::node
