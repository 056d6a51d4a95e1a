// cli/simulate/row_schedule.cpp
#include "cli/simulate/row_schedule.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cli/command_line.h"
#include "cli/duration.h"
#include "cli/number.h"

namespace cordis::cli {

RowSchedule::RowSchedule(const std::string& every, double step_rate_hz) : kind_(Kind::kTick) {
  if (every == "tick") return;
  kind_ = Kind::kSteps;
  if (every == "step") return;
  if (!every.empty() &&
      std::ranges::all_of(every, [](unsigned char c) { return std::isdigit(c); })) {
    stride_ = static_cast<std::uint64_t>(parse_whole_number("--every", every, 1, 1'000'000'000));
    return;
  }
  kind_ = Kind::kTime;
  if (every.empty() || std::isdigit(static_cast<unsigned char>(every.front())) == 0) {
    throw UsageError("--every '" + every +
                     "' is none of step, tick, a number of steps (10) or a time (0.01s)");
  }
  const double span_s = seconds_of(parse_duration(every));
  steps_per_row_ = span_s * step_rate_hz;
  if (steps_per_row_ < 1.0)
    throw UsageError("--every " + every + " is shorter than a step; write --every step");
}

bool RowSchedule::has_row(std::uint64_t step) noexcept {
  if (kind_ != Kind::kTime) return step % stride_ == 0;
  if (step < static_cast<std::uint64_t>(std::llround(static_cast<double>(rows_) * steps_per_row_)))
    return false;
  ++rows_;
  return true;
}

}  // namespace cordis::cli
