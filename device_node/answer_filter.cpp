// device_node/answer_filter.cpp
#include "device_node/answer_filter.h"

namespace cordis::device {

AnswerFilter::AnswerFilter(const Series& series, bool lockstep, int delay_periods)
    : series_(series), lockstep_(lockstep), late_(static_cast<std::size_t>(delay_periods) + 1) {}

/// A new epoch of the scene is recognised by what it answers alone.
AnswerFilter::Outcome AnswerFilter::consider(const GestureMessage& answer,
                                             std::uint64_t last_sample,
                                             std::int64_t now_nsec) noexcept {
  if (answer.answered_epoch == 0) return Outcome::kForeign;
  if (answer.answered_epoch != series_.epoch) {
    has_answered_another_ = true;
    another_answered_nsec_ = now_nsec;
    return Outcome::kForeign;
  }
  const bool well_formed = answer.axis_count >= 1 && answer.axis_count <= kMaxAxes &&
                           answer.answered_time_nsec >= series_.begun_nsec &&
                           answer.answered_time_nsec <= now_nsec;
  const bool answers_us =
      answer.answered_sample >= series_.first_sample && answer.answered_sample <= last_sample;
  // Between two samples of this device the scene may answer twice: the later answer counts.
  const bool later = answer.epoch != newest_.epoch || answer.sample > newest_.sample;
  const bool newer = !has_any_ || answer.answered_sample > newest_.answered_sample ||
                     (answer.answered_sample == newest_.answered_sample && later && !lockstep_);
  if (!well_formed || !answers_us || !newer) return Outcome::kRefused;
  take(answer);
  return Outcome::kTaken;
}

void AnswerFilter::take(const GestureMessage& answer) noexcept {
  newly_answered_ = has_any_ ? answer.answered_sample - newest_.answered_sample : 1;
  has_any_ = true;
  newest_ = answer;
  late_[answer.answered_sample % late_.size()] = answer;
  // The ring holds the delay and one more: the next to be replaced is the oldest.
  in_use_ = lockstep_ ? late_[(answer.answered_sample + 1) % late_.size()] : answer;
}

bool AnswerFilter::answers_another(double within_s, std::int64_t now_nsec) const noexcept {
  const double since_s = static_cast<double>(now_nsec - another_answered_nsec_) * 1e-9;
  return has_answered_another_ && since_s < within_s;
}

}  // namespace cordis::device
