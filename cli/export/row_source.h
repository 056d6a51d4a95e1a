// cli/export/row_source.h -- signals and positions of MATs in a take, row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/export/message_source.h"
#include "cli/export/take_scene.h"
#include "cli/mat_words.h"
#include "cli/table/column.h"
#include "idl/scene.h"

namespace cordis::cli {

/// The rows of one rate of `scene/signals`, by ascending steps.
class SignalRowSource {
 public:
  SignalRowSource(const mcap::Reader& take, const TakeScene& scene, msg::SignalRate rate,
                  ReadLoss& loss);

  const std::vector<Column>& columns() const noexcept { return columns_; }
  /// Goes to the next row; false at the end.
  bool next();
  std::uint64_t step() const noexcept { return step_; }
  const double* values() const noexcept { return batch_.value().data() + row_ * columns_.size(); }
  /// Rows that lie between those that came, and do not come.
  std::uint64_t lost_rows() const noexcept { return lost_rows_; }

 private:
  bool next_batch();
  std::size_t row_count() const noexcept { return batch_.value().size() / columns_.size(); }

  MessageSource<msg::SceneSignals> source_;
  const TakeScene& scene_;
  msg::SignalRate rate_;
  double steps_per_row_;
  std::vector<Column> columns_;
  msg::SceneSignals batch_;
  std::size_t row_ = 0;
  std::uint64_t step_ = 0;
  std::uint64_t lost_rows_ = 0;
};

/// The positions of MATs in `scene/frame`, by ascending steps.
class FrameRowSource {
 public:
  /// @throws UsageError for a word that fits no MAT
  FrameRowSource(const mcap::Reader& take, const TakeScene& scene,
                 const std::vector<std::string>& mats, ReadLoss& loss);

  const std::vector<Column>& columns() const noexcept { return columns_; }
  bool next();
  std::uint64_t step() const noexcept { return step_; }
  const double* values() const noexcept { return values_.data(); }
  /// Frames that lie between those that came, and do not come.
  std::uint64_t lost_frames() const noexcept { return lost_frames_; }

 private:
  MessageSource<msg::SceneFrame> source_;
  const TakeScene& scene_;
  std::vector<PickedMat> mats_;
  std::vector<Column> columns_;
  msg::SceneFrame frame_;
  std::vector<double> values_;
  std::uint64_t newest_frame_ = 0;
  std::uint64_t step_ = 0;
  std::uint64_t lost_frames_ = 0;
};

}  // namespace cordis::cli
