// node/inherited_priority.cpp
#include "node/inherited_priority.h"

#include <pthread.h>

namespace cordis::node {

InheritedPriority::InheritedPriority(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  changed_ = pthread_getschedparam(pthread_self(), &policy_, &parameters_) == 0 &&
             pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

InheritedPriority::~InheritedPriority() {
  if (changed_) pthread_setschedparam(pthread_self(), policy_, &parameters_);
}

}  // namespace cordis::node
