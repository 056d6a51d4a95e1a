// node/inherited_priority.cpp
#include "node/inherited_priority.h"

#include <pthread.h>

#include "node/assert.h"

namespace cordis::node {

InheritedPriority::InheritedPriority(int priority) noexcept {
  CORDIS_ASSERT(priority >= 0);
  if (priority == 0 || realtime_priority() > 0) return;
  sched_param parameters{};
  parameters.sched_priority = priority;
  changed_ = pthread_getschedparam(pthread_self(), &policy_, &parameters_) == 0 &&
             pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

InheritedPriority::~InheritedPriority() {
  if (changed_) pthread_setschedparam(pthread_self(), policy_, &parameters_);
}

int realtime_priority() noexcept {
  int policy = SCHED_OTHER;
  sched_param parameters{};
  if (pthread_getschedparam(pthread_self(), &policy, &parameters) != 0) return 0;
  return policy == SCHED_FIFO || policy == SCHED_RR ? parameters.sched_priority : 0;
}

}  // namespace cordis::node
