// node/tick_cost.h -- what a tick of a loop costs this process.
#pragma once

#include <cstdint>
#include <string>

#include "node/processor_time.h"

namespace cordis::node {

/// Processor time of all threads of this process since a loop began, for each of its ticks.
class TickCost {
 public:
  TickCost() noexcept : begun_nsec_(process_processor_nsec()) {}

  /// @param ticks    that the loop has played
  /// @param polled_s processor time that it has spent waiting without sleep: it is counted apart [s]
  /// @return what a tick has cost so far; empty without a tick
  std::string text(std::uint64_t ticks, double polled_s = 0.0) const {
    return text_of(process_processor_nsec() - begun_nsec_, ticks, polled_s);
  }

  /// The words of text(). @param used_nsec  processor time, polling included
  static std::string text_of(std::int64_t used_nsec, std::uint64_t ticks, double polled_s);

 private:
  std::int64_t begun_nsec_;
};

}  // namespace cordis::node
