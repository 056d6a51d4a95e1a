// device_node/answer_poll.h -- whether a loop polls for its answer or sleeps.
#pragma once

#include <algorithm>
#include <cstdint>

namespace cordis::device {

/// Waking a thread takes longer than an answer is on its way, so a loop that polls for a short while
/// has it sooner. That pays only where another core is free for the scene and for DDS: else nothing
/// comes until the loop sleeps. So polling is tried for kTrial waits, and kept while kEnough of them
/// find their answer. A trial ends as soon as it has failed; then the loop sleeps for a pause, which
/// doubles with each further trial that fails.
///
/// A scene that answers nothing leaves open if polling pays: after a wait in vain the loop sleeps
/// until the next answer comes, and only the first of such waits counts. Knows no clock.
class AnswerPoll {
 public:
  static constexpr int kTrial = 32;            // waits
  static constexpr int kEnough = 24;           // of them
  static constexpr int kPause = 250;           // waits
  static constexpr int kLongestPause = 16000;  // waits

  /// How a wait ended.
  enum class Wait : std::uint8_t {
    kInTime,  ///< the answer came before polling would have ended
    kLate,    ///< later in the period
    kInVain   ///< no answer came before the next sample
  };

  /// What is known about polling.
  enum class Verdict : std::uint8_t { kNone, kPays, kFails };

  /// True if the loop polls for the next answer.
  bool is_on() const noexcept { return pause_ == 0 && !is_silent_; }
  Verdict verdict() const noexcept { return verdict_; }

  /// A wait is over. @return true if the verdict has changed
  bool record(Wait wait) noexcept {
    const bool was_silent = is_silent_;
    is_silent_ = wait == Wait::kInVain;
    if (pause_ > 0) {
      --pause_;
      return false;
    }
    if (was_silent) return false;  // the loop slept
    ++tried_;
    missed_ += wait != Wait::kInTime;
    if (missed_ > kTrial - kEnough) {
      pause_ = next_pause_;
      next_pause_ = std::min(2 * next_pause_, kLongestPause);
      return end_trial(Verdict::kFails);
    }
    if (tried_ < kTrial) return false;
    next_pause_ = kPause;
    return end_trial(Verdict::kPays);
  }

 private:
  bool end_trial(Verdict verdict) noexcept {
    tried_ = missed_ = 0;
    const bool is_new = verdict != verdict_;
    verdict_ = verdict;
    return is_new;
  }

  int tried_ = 0;
  int missed_ = 0;
  int pause_ = 0;
  int next_pause_ = kPause;
  bool is_silent_ = true;  // no answer has come to the sample before
  Verdict verdict_ = Verdict::kNone;
};

}  // namespace cordis::device
