// node/period_grid.cpp
#include "node/period_grid.h"

#include <algorithm>
#include <cmath>

#include "node/assert.h"

namespace cordis::node {
namespace {

constexpr double kGain = 1.0 / 16.0;  // of the phase-locked loop, per arrival
constexpr double kReserve = 1.0;      // [periods]
constexpr double kEnd = 0.5;          // of a period, after a whole multiple

}  // namespace

PeriodGrid::PeriodGrid(double rate_hz, std::int64_t now_nsec) noexcept
    : rate_hz_(rate_hz),
      period_nsec_(1e9 / rate_hz),
      index_(static_cast<std::int64_t>(
          std::floor(static_cast<double>(now_nsec) / period_nsec_ - kEnd))),
      reserve_(kReserve) {
  CORDIS_ASSERT(rate_hz > 0.0 && now_nsec >= 0);
  ++index_;
}

std::int64_t PeriodGrid::end_of(std::int64_t index) const noexcept {
  return std::llround((static_cast<double>(index) + kEnd) * period_nsec_ + shift_nsec_);
}

void PeriodGrid::follow(std::int64_t arrival_nsec) noexcept {
  const double middle = static_cast<double>(end_nsec()) - 0.5 * period_nsec_;
  const double error = (static_cast<double>(arrival_nsec) - middle) / period_nsec_;
  const double most = std::min(kLargestShift, reserve_);
  const double shift = std::clamp(kGain * error, -most, most);
  reserve_ -= std::abs(shift);
  shift_nsec_ += shift * period_nsec_;
}

std::uint64_t PeriodGrid::advance(std::int64_t now_nsec) noexcept {
  const double late = static_cast<double>(now_nsec - end_nsec()) / period_nsec_;
  const auto skipped = static_cast<std::int64_t>(std::max(late, 0.0));
  index_ += 1 + skipped;
  reserve_ = std::min(kReserve, reserve_ + kLargestDrift * static_cast<double>(1 + skipped));
  return static_cast<std::uint64_t>(skipped);
}

}  // namespace cordis::node
