// cli/export/table_export.cpp
#include "cli/export/table_export.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "cli/command_line.h"
#include "cli/duration.h"
#include "cli/export/device_rows.h"
#include "cli/export/row_source.h"
#include "cli/export/time_window.h"
#include "idl/topics.h"
#include "node/config/count_text.h"

namespace cordis::cli {
namespace {

/// Which rows a table has.
enum class Rows { kTicks, kFrames, kSteps };

struct RowChoice {
  Rows rows = Rows::kTicks;
  double span_s = 0.0;  // between two rows; 0: all
};

RowChoice choice_of(const std::string& every) {
  if (every == "tick") return {};
  if (every == "frame") return {.rows = Rows::kFrames};
  if (every == "step") return {.rows = Rows::kSteps};
  const bool has_unit = !every.empty() && std::isalpha(static_cast<unsigned char>(every.back()));
  if (!has_unit || std::isdigit(static_cast<unsigned char>(every.front())) == 0)
    throw UsageError("--every '" + every + "' is none of tick, frame, step or a time (0.01s)");
  return {.span_s = seconds_of(parse_duration(every))};
}

class TableExport {
 public:
  TableExport(const mcap::Reader& take, const TakeScene& scene, const ExportOptions& options,
              ReadLoss& loss)
      : choice_(choice_of(options.every)),
        scene_(scene),
        window_(options.start_s, options.duration_s, scene.description.step_rate_hz()),
        signals_(take, scene, choice_.rows == Rows::kSteps ? msg::RATE_STEP : msg::RATE_GESTURE,
                 loss),
        frames_(take, scene, options.mats, loss) {
    if (choice_.rows == Rows::kSteps && signals_.columns().empty())
      throw UsageError("--every step: the scene has no signal with 'rate: step'");
    if (choice_.rows == Rows::kSteps && !options.mats.empty())
      throw UsageError("--mat: MATs have positions by frame; write --every tick or frame");
    if (choice_.rows != Rows::kSteps) devices_ = std::make_unique<DeviceRows>(take, scene, loss);
    columns_ = {{"time", "s"}};
    add_columns(signals_.columns());
    if (devices_) add_columns(devices_->columns());
    add_columns(frames_.columns());
    if (columns_.size() == 1)
      throw UsageError("the scene '" + scene.description.name() +
                       "' has neither signals nor devices; ask for positions with --mat NAME");
    row_.resize(columns_.size());
    if (choice_.span_s > 0.0) record_uneven_span(options.every);
    if (choice_.span_s > 0.0) last_number_ = number_at(options.start_s);
    files_ = make_table_files(options, columns_);
  }

  void write(ExportResult& result) {
    has_signal_ = signals_.next();
    has_frame_ = (choice_.rows == Rows::kFrames || !frames_.columns().empty()) && frames_.next();
    switch (choice_.rows) {
      case Rows::kFrames:
        for (; has_frame_; has_frame_ = frames_.next()) take(frames_.step());
        break;
      case Rows::kTicks:
        if (!has_signal_ && devices_) {
          for (const std::uint64_t step : devices_->steps()) take(step);
          break;
        }
        [[fallthrough]];
      case Rows::kSteps:
        for (; has_signal_; has_signal_ = signals_.next()) take(signals_.step());
        break;
    }
    for (const auto& file : files_) file->finish();
    result.row_count = row_count_;
    report(result);
  }

 private:
  void add_columns(const std::vector<Column>& more) {
    columns_.insert(columns_.end(), more.begin(), more.end());
  }

  /// Rows are those of the take: a span between two of them is none that a table can have.
  void record_uneven_span(const std::string& every) {
    const double ticks = choice_.span_s * scene_.description.gesture_rate_hz();
    if (ticks >= 0.999 && std::abs(ticks - std::round(ticks)) < 1e-3) return;
    note_ = fmt::format(
        "--every {} is no whole number of gesture periods of {:.6g} s: each row is the first of "
        "the take at or after its time",
        every, 1.0 / scene_.description.gesture_rate_hz());
  }

  /// How many spans of time are over.
  double number_at(double time_s) const {
    const double half_step = 0.5 / scene_.description.step_rate_hz();
    return std::floor((time_s + half_step) / choice_.span_s);
  }

  /// True if rows that are apart by a span of time have one at this time.
  bool is_due(double time_s) {
    if (choice_.span_s == 0.0) return true;
    const double number = number_at(time_s);
    if (number <= last_number_) return false;
    last_number_ = number;
    return true;
  }

  void take(std::uint64_t step) {
    const double time_s = static_cast<double>(step) / scene_.description.step_rate_hz();
    if (!window_.has(step) || !is_due(time_s)) return;
    if (row_count_ == 0) first_step_ = step;
    double* value = row_.data();
    *value++ = time_s;
    while (has_signal_ && signals_.step() < step) has_signal_ = signals_.next();
    const bool has_row = has_signal_ && signals_.step() == step;
    if (has_row) has_signal_row_ = true;
    value = put(value, has_row ? signals_.values() : nullptr, signals_.columns().size());
    if (devices_) value = put(value, devices_->values_at(step), devices_->columns().size());
    if (devices_ && devices_->gap().empty()) add(devices_->missing_at(step));
    while (has_frame_ && frames_.step() < step) has_frame_ = frames_.next();
    const bool is_frame = has_frame_ && frames_.step() == step;
    put(value, is_frame ? frames_.values() : nullptr, frames_.columns().size());
    for (const auto& file : files_) file->write(row_);
    ++row_count_;
  }

  void add(const DeviceRows::Missing& more) {
    missing_.lost += more.lost;
    missing_.before += more.before;
    missing_.silent += more.silent;
  }

  static double* put(double* cell, const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      *cell++ = values == nullptr ? std::numeric_limits<double>::quiet_NaN() : values[i];
    return cell;
  }

  void report(ExportResult& result) {
    if (!note_.empty()) result.warnings.push_back(note_);
    if (row_count_ == 0) {
      result.losses.push_back("the take has no row of this table");
    } else if (!signals_.columns().empty() && !has_signal_row_) {
      result.losses.push_back("the take has no values of signals: record " + msg::TOPIC_SIGNALS);
    }
    const double rate_hz = scene_.description.step_rate_hz();
    const double late_s = static_cast<double>(first_step_ - window_.first()) / rate_hz;
    if (row_count_ > 0 && choice_.rows == Rows::kTicks && choice_.span_s == 0.0 &&
        late_s > 1.0 / scene_.description.gesture_rate_hz()) {
      result.losses.push_back(fmt::format("the take begins late: its first row is at {:.6g} s",
                                          static_cast<double>(first_step_) / rate_hz));
    }
    if (signals_.lost_rows() > 0)
      result.losses.push_back("the take lacks " + config::count_text(signals_.lost_rows(), "row") +
                              " of signals");
    if (frames_.lost_frames() > 0)
      result.losses.push_back("the take lacks " +
                              config::count_text(frames_.lost_frames(), "frame") + " of the scene");
    if (devices_ && !devices_->gap().empty()) result.losses.push_back(devices_->gap());
    if (missing_.lost > 0)
      result.losses.push_back("the take lacks " + config::count_text(missing_.lost, "answer") +
                              " to devices, which are on " + msg::TOPIC_FORCES + " and " +
                              msg::TOPIC_POSITIONS);
    if (missing_.before > 0)
      result.notes.push_back("the recorder began " + config::count_text(missing_.before, "answer") +
                             " to devices later than the table: their cells are nan");
    if (missing_.silent > 0)
      result.notes.push_back("the scene gave no answer to devices in " +
                             config::count_text(missing_.silent, "gesture period") +
                             ": their cells are nan");
  }

  RowChoice choice_;
  const TakeScene& scene_;
  TimeWindow window_;
  SignalRowSource signals_;
  FrameRowSource frames_;
  std::unique_ptr<DeviceRows> devices_;
  std::vector<Column> columns_;
  std::vector<double> row_;
  std::vector<std::unique_ptr<TableFile>> files_;
  bool has_signal_ = false;
  bool has_frame_ = false;
  double last_number_ = 0.0;
  std::string note_;
  bool has_signal_row_ = false;
  std::uint64_t first_step_ = 0;
  DeviceRows::Missing missing_;
  std::uint64_t row_count_ = 0;
};

}  // namespace

void export_table(const mcap::Reader& take, const TakeScene& scene, const ExportOptions& options,
                  ReadLoss& loss, ExportResult& result) {
  TableExport(take, scene, options, loss).write(result);
}

}  // namespace cordis::cli
