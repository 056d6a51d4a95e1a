// device_node/answer_poll.h -- whether a loop polls for its answer or sleeps.
#pragma once

#include <cstdint>

namespace cordis::device {

/// Waking a thread takes longer than an answer is on its way, so a loop that polls for a short while
/// has it sooner. That pays only where another core is free for the scene and for DDS: else nothing
/// comes until the loop sleeps. So polling is tried, kept while kEnough of kTrial answers come to
/// a loop that polls, and tried again after kPause answers. Knows no clock.
class AnswerPoll {
 public:
  static constexpr int kTrial = 32;
  static constexpr int kEnough = 24;
  static constexpr int kPause = 2000;

  /// True if the loop polls for the next answer.
  bool is_on() const noexcept { return pause_ == 0; }
  /// True if the last trial has been passed.
  bool pays() const noexcept { return pays_; }

  /// A wait is over. @param came  the answer came before polling would have ended
  void record(bool came) noexcept {
    if (pause_ > 0) {
      --pause_;
      return;
    }
    came_ += came;
    if (++tried_ < kTrial) return;
    pays_ = came_ >= kEnough;
    pause_ = pays_ ? 0 : kPause;
    tried_ = came_ = 0;
  }

 private:
  int tried_ = 0;
  int came_ = 0;
  int pause_ = 0;
  bool pays_ = false;
};

}  // namespace cordis::device
