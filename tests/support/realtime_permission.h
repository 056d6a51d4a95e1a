// tests/support/realtime_permission.h -- whether this machine lets a test have realtime priority.
#pragma once

#include <thread>

#include <pthread.h>
#include <sched.h>

namespace cordis::test {

/// True if this process may have realtime priority; its threads keep their priorities.
inline bool may_have_realtime_priority() {
  bool may = false;
  std::thread([&may] {
    sched_param parameters{};
    parameters.sched_priority = 1;
    may = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
  }).join();
  return may;
}

}  // namespace cordis::test
