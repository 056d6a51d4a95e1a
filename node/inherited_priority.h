// node/inherited_priority.h -- realtime priority for threads that a library makes.
#pragma once

#include <sched.h>

namespace cordis::node {

/// While it lives, threads that the calling thread makes have SCHED_FIFO at a priority, where that
/// is permitted; at its end the calling thread has its own policy again.
class InheritedPriority {
 public:
  explicit InheritedPriority(int priority) noexcept;
  ~InheritedPriority();
  InheritedPriority(const InheritedPriority&) = delete;
  InheritedPriority& operator=(const InheritedPriority&) = delete;

 private:
  int policy_ = SCHED_OTHER;
  sched_param parameters_{};
  bool changed_ = false;
};

}  // namespace cordis::node
