// node/log_time.h -- when a message was there, as takes and live clients have it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "idl/topics.h"

namespace cordis::node {

/// True for the topics of the force loop.
inline bool is_of_loop(std::string_view topic) noexcept {
  return topic == msg::TOPIC_POSITIONS || topic == msg::TOPIC_FORCES;
}

/// The log times of what one writer says, in the order in which it came.
///
/// Most messages have the time at which they came. A force loop of this host has another thread send what it
/// writes. Its messages have the time at which they were written, however late they came, unless more than a
/// minute lies between: that is another clock.
class LogTime {
 public:
  static constexpr std::uint64_t kLongestDetour = 60'000'000'000;  ///< [ns]

  /// @param received_nsec, published_nsec  UTC [ns]
  /// @param is_of_loop_here  a force loop of this host writes it
  /// @return UTC [ns]; never below that of the message before, unless the clock was set back by a minute
  std::uint64_t next(std::uint64_t received_nsec, std::uint64_t published_nsec,
                     bool is_of_loop_here) noexcept {
    const bool is_sent_later = is_of_loop_here && received_nsec > published_nsec &&
                               received_nsec - published_nsec <= kLongestDetour;
    const std::uint64_t time = is_sent_later ? published_nsec : received_nsec;
    const bool is_set_back = last_nsec_ > received_nsec + kLongestDetour;  // the clock of the host
    last_nsec_ = is_of_loop_here && !is_set_back ? std::max(last_nsec_, time) : time;
    return last_nsec_;
  }

 private:
  std::uint64_t last_nsec_ = 0;
};

}  // namespace cordis::node
