// cli/scene_source/frame_picker.h -- of frames that come one by one, those nearest to given times.
#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include "idl/scene.h"

namespace cordis::cli {

/// Keeps two frames: the one nearest so far, and the one behind it.
class FramePicker {
 public:
  /// The frame nearest to a time; nothing when the time lies behind the last frame by more than
  /// half of `period_s`. Times ascend.
  /// @param next  puts the next frame into its argument; false at the end
  template <class Next>
  std::optional<msg::SceneFrame> at(double time_s, double period_s, const Next& next) {
    if (!current_) current_ = fetch(next);
    if (!current_) return std::nullopt;
    if (!behind_) behind_ = fetch(next);
    while (behind_ && std::abs(behind_->simulated_s() - time_s) <=
                          std::abs(current_->simulated_s() - time_s)) {
      current_ = std::exchange(behind_, fetch(next));
    }
    if (!behind_ && time_s > current_->simulated_s() + 0.5 * period_s + 1e-9) return std::nullopt;
    return current_;
  }

 private:
  template <class Next>
  static std::optional<msg::SceneFrame> fetch(const Next& next) {
    msg::SceneFrame frame;
    if (!next(frame)) return std::nullopt;
    return frame;
  }

  std::optional<msg::SceneFrame> current_;
  std::optional<msg::SceneFrame> behind_;
};

}  // namespace cordis::cli
