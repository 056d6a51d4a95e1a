// device_node/answer_filter.h -- which answers of a scene a device takes, and which is in use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "device_node/gesture_channel.h"

namespace cordis::device {

/// Takes an answer that is well formed, answers a sample of this exchange and is newer than the one
/// before. Whoever takes part in the session may write an answer, and no number of it is trusted.
///
/// The answer in use is the newest, or with a delay the one so many samples before it.
class AnswerFilter {
 public:
  enum class Outcome {
    kTaken,
    kRefused,  ///< malformed, outdated, or of a sample that this exchange has not sent
    kForeign,  ///< meant for another node, or sent by a scene that has not received this device yet
  };

  /// What the filter holds answers to.
  struct Series {
    std::uint64_t epoch = 0;         ///< epoch of this process
    std::uint64_t first_sample = 0;  ///< first sample of this exchange
    std::int64_t begun_nsec = 0;     ///< when this exchange began
  };

  /// @param lockstep       each sample has one answer, and the delay counts
  /// @param delay_periods  0 or more
  AnswerFilter(const Series& series, bool lockstep, int delay_periods);

  /// @param last_sample  number of the sample sent last
  Outcome consider(const GestureMessage& answer, std::uint64_t last_sample,
                   std::int64_t now_nsec) noexcept;

  bool has_any() const noexcept { return has_any_; }  ///< true once an answer is taken
  const GestureMessage& newest() const noexcept { return newest_; }
  const GestureMessage& in_use() const noexcept { return in_use_; }
  /// Samples that the answer taken last is the first to follow; 0 when it repeats an answered one.
  std::uint64_t newly_answered() const noexcept { return newly_answered_; }
  bool has_answered(std::uint64_t sample) const noexcept {
    return has_any_ && newest_.answered_sample == sample;
  }
  /// True if another node was answered within so many seconds.
  bool answers_another(double within_s, std::int64_t now_nsec) const noexcept;

 private:
  void take(const GestureMessage& answer) noexcept;

  Series series_;
  bool lockstep_;
  GestureMessage newest_;
  GestureMessage in_use_;
  std::vector<GestureMessage> late_;  // the last answers, by the sample they answer
  std::uint64_t newly_answered_ = 0;
  bool has_any_ = false;
  bool has_answered_another_ = false;
  std::int64_t another_answered_nsec_ = 0;
};

}  // namespace cordis::device
