// cli/scene_source/take_source.cpp
#include "cli/scene_source/take_source.h"

#include <algorithm>

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
  find_ends();
}

void TakeSource::find_ends() {
  MessageSource<msg::SceneFrame> frames(*take_, msg::TOPIC_FRAME, loss_);
  msg::SceneFrame frame;
  bool is_first = true;
  while (frames.next(frame)) {
    if (!scene_.has(frame)) continue;
    if (is_first) first_s_ = frame.simulated_s();
    is_first = false;
    last_s_ = std::max(last_s_, frame.simulated_s());
  }
  if (is_first) throw UsageError(take_->path().string() + " has no frames of this scene");
  loss_ = {};  // is found again by who reads on
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
  while (source.next()) {
    const double time_s = static_cast<double>(source.step()) / scene_.description.step_rate_hz();
    if (time_s > to_s || progress(time_s)) break;
    if (time_s < from_s) continue;
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
