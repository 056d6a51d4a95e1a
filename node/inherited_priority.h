// node/inherited_priority.h -- realtime priority for threads that a library makes.
#pragma once

#include <sched.h>

namespace cordis::node {

/// While it lives, the calling thread and those that it makes have SCHED_FIFO at a priority, where
/// that is permitted; at its end the calling thread has its own policy again. A thread that has
/// realtime priority before keeps it.
class InheritedPriority {
 public:
  /// @param priority  0: all stays as it is
  explicit InheritedPriority(int priority) noexcept;
  ~InheritedPriority();
  InheritedPriority(const InheritedPriority&) = delete;
  InheritedPriority& operator=(const InheritedPriority&) = delete;

 private:
  int policy_ = SCHED_OTHER;
  sched_param parameters_{};
  bool changed_ = false;
};

/// The priority of the calling thread under SCHED_FIFO or SCHED_RR; 0 under another policy.
int realtime_priority() noexcept;

}  // namespace cordis::node
