// cli/export/row_source.cpp
#include "cli/export/row_source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "idl/topics.h"

namespace cordis::cli {

SignalRowSource::SignalRowSource(const mcap::Reader& take, const TakeScene& scene,
                                 msg::SignalRate rate, ReadLoss& loss)
    : source_(take, msg::TOPIC_SIGNALS, loss),
      scene_(scene),
      rate_(rate),
      steps_per_row_(rate == msg::RATE_STEP
                         ? 1.0
                         : scene.description.step_rate_hz() / scene.description.gesture_rate_hz()) {
  for (const msg::SignalDescription& signal : scene.description.signals()) {
    if (rate == msg::RATE_GESTURE || signal.rate() == rate)
      columns_.push_back({signal.name(), signal.unit()});
  }
}

bool SignalRowSource::next_batch() {
  while (source_.next(batch_)) {
    if (!scene_.has(batch_) || batch_.rate() != rate_) continue;
    if (batch_.signal_count() != columns_.size() || batch_.value().size() < columns_.size())
      continue;
    return true;
  }
  batch_.value().clear();
  return false;
}

bool SignalRowSource::next() {
  if (columns_.empty()) return false;
  const std::uint64_t last = step_;
  do {
    if (++row_ >= row_count()) {
      if (!next_batch()) return false;
      row_ = 0;
    }
    step_ = batch_.first_step() + (row_ < batch_.row_step().size() ? batch_.row_step()[row_]
                                                                   : row_ * batch_.stride_steps());
  } while (step_ <= last);
  const double rows = static_cast<double>(step_ - last) / steps_per_row_;
  if (last > 0) lost_rows_ += static_cast<std::uint64_t>(std::max(0LL, std::llround(rows) - 1));
  return true;
}

FrameRowSource::FrameRowSource(const mcap::Reader& take, const TakeScene& scene,
                               const std::vector<std::string>& mats, ReadLoss& loss)
    : source_(take, msg::TOPIC_FRAME, loss), scene_(scene) {
  std::vector<scene::NamedRange> matter;
  for (const msg::NamedRange& range : scene.description.matter())
    matter.push_back({range.name(), range.first(), range.count()});
  for (const std::string& word : mats) {
    for (const PickedMat& mat : pick_mats(matter, word)) mats_.push_back(mat);
  }
  const int space = std::clamp(static_cast<int>(scene.description.space()), 1, 3);
  for (const PickedMat& mat : mats_) {
    for (int axis = 0; axis < space; ++axis)
      columns_.push_back({mat.name + axis_suffix(axis), "m"});
  }
}

bool FrameRowSource::next() {
  const std::uint64_t last = step_;
  do {
    if (!source_.next(frame_)) return false;
    if (!scene_.has(frame_) || frame_.frame() <= newest_frame_) continue;
    if (newest_frame_ > 0) lost_frames_ += frame_.frame() - newest_frame_ - 1;
    newest_frame_ = frame_.frame();
    step_ = frame_.step();
  } while (step_ <= last);  // a scene that is paused shows a step again
  const int space = std::clamp(static_cast<int>(scene_.description.space()), 1, 3);
  values_.clear();
  for (const PickedMat& mat : mats_) {
    for (int axis = 0; axis < space; ++axis) {
      const std::size_t shown = space == 1 ? 1 : static_cast<std::size_t>(axis);
      const std::size_t coordinate = 3 * std::size_t{mat.index} + shown;
      values_.push_back(coordinate < frame_.position_m().size()
                            ? double{frame_.position_m()[coordinate]}
                            : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return true;
}

}  // namespace cordis::cli
