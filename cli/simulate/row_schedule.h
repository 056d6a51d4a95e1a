// cli/simulate/row_schedule.h -- which steps of a simulation become rows of a table.
#pragma once

#include <cstdint>
#include <string>

namespace cordis::cli {

/// `step`, a number of steps, `tick`, or a span of time.
class RowSchedule {
 public:
  /// @param every  what a person typed after --every
  /// @throws UsageError unless it is one of these.
  RowSchedule(const std::string& every, double step_rate_hz);

  /// True if the rows are those of complete gesture periods, as on `scene/signals`.
  bool is_by_tick() const noexcept { return kind_ == Kind::kTick; }

  /// True if this step has a row. To be asked for each step since the start, in order, from 1; with is_by_tick() for
  /// none. Of a span of time these are the steps nearest to its multiples.
  bool has_row(std::uint64_t step) noexcept;

 private:
  enum class Kind : std::uint8_t { kTick, kSteps, kTime };

  Kind kind_;
  std::uint64_t stride_ = 1;    // steps
  double steps_per_row_ = 1.0;  // of a span of time
  std::uint64_t rows_ = 1;      // number of the next row, of a span of time
};

}  // namespace cordis::cli
