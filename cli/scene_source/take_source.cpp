// cli/scene_source/take_source.cpp
#include "cli/scene_source/take_source.h"

#include <algorithm>
#include <limits>

#include "cli/export/row_source.h"
#include "cli/take_file.h"
#include "idl/topics.h"
#include "node/config/count_text.h"
#include "viz_node/scene_check.h"

namespace cordis::cli {

TakeSource::TakeSource(const std::string& verb, const std::string& file, std::size_t scene)
    : take_(open_take(verb, file)),
      scene_(scene_of_take(*take_, scene)),
      frames_(*take_, msg::TOPIC_FRAME, loss_) {
  const std::string fault = viz::fault_of(scene_.description);
  if (!fault.empty()) throw UsageError(file + ": " + fault);
}

TimeSpan TakeSource::frame_span() {
  ReadLoss loss;  // is found again by who reads on
  MessageSource<msg::SceneFrame> frames(*take_, msg::TOPIC_FRAME, loss);
  double first_s = std::numeric_limits<double>::infinity();
  double last_s = 0.0;
  for (msg::SceneFrame frame; frames.next(frame);) {
    if (!scene_.has(frame)) continue;
    first_s = std::min(first_s, frame.simulated_s());
    last_s = std::max(last_s, frame.simulated_s());
  }
  if (first_s > last_s) throw UsageError(take_->path().string() + " has no frames of this scene");
  return {first_s, last_s - first_s + 0.5 / scene_.description.frame_rate_hz()};
}

TimeSpan TakeSource::signal_span() {
  ReadLoss loss;  // is found again by who reads on
  SignalRowSource rows(*take_, scene_, msg::RATE_GESTURE, loss);
  if (!rows.next()) return frame_span();
  const double rate_hz = scene_.description.step_rate_hz();
  const double period_s = 1.0 / scene_.description.gesture_rate_hz();
  const double first_s = std::max(0.0, static_cast<double>(rows.step()) / rate_hz - period_s);
  while (rows.next()) {
  }
  return {first_s, static_cast<double>(rows.step()) / rate_hz - first_s};
}

bool TakeSource::next(msg::SceneFrame& frame) {
  while (frames_.next(frame)) {
    if (!scene_.has(frame) || frame.frame() <= newest_frame_) continue;
    if (!viz::fault_of(frame, scene_.description).empty()) {
      ++refused_;
      continue;
    }
    newest_frame_ = frame.frame();
    return true;
  }
  return false;
}

std::optional<msg::SceneFrame> TakeSource::frame_at(double time_s) {
  const double period_s = 1.0 / scene_.description.frame_rate_hz();
  return picker_.at(time_s, period_s, [this](msg::SceneFrame& frame) { return next(frame); });
}

void TakeSource::read_signals(double from_s, double to_s, SignalSeries& rows,
                              const std::function<bool(double)>& progress) {
  SignalRowSource source(*take_, scene_, msg::RATE_GESTURE, loss_);
  const std::size_t columns = source.columns().size();
  const double half_step_s = 0.5 / scene_.description.step_rate_hz();  // ends are rounded
  while (source.next()) {
    const double time_s = static_cast<double>(source.step()) / scene_.description.step_rate_hz();
    if (time_s > to_s + half_step_s || progress(time_s)) break;
    if (time_s < from_s - half_step_s) continue;
    rows.time_s.push_back(time_s);
    rows.value.insert(rows.value.end(), source.values(), source.values() + columns);
  }
}

std::vector<std::string> TakeSource::notes() const {
  std::vector<std::string> notes = loss_.problems;
  if (loss_.unreadable > 0)
    notes.push_back(config::count_text(loss_.unreadable, "message") + " cannot be read");
  if (refused_ > 0)
    notes.push_back(config::count_text(refused_, "frame") + " left out: they do not fit the scene");
  return notes;
}

}  // namespace cordis::cli
