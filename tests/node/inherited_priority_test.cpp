// tests/node/inherited_priority_test.cpp
#include "node/inherited_priority.h"

#include <thread>

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

namespace cordis::node {
namespace {

int policy_of_a_new_thread() {
  int policy = -1;
  std::thread([&policy] {
    sched_param parameters{};
    pthread_getschedparam(pthread_self(), &policy, &parameters);
  }).join();
  return policy;
}

/// Whether this process may have realtime priority at all.
bool is_permitted() {
  bool permitted = false;
  std::thread([&permitted] {
    sched_param parameters{};
    parameters.sched_priority = 1;
    permitted = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
  }).join();
  return permitted;
}

TEST(InheritedPriority, IsThatOfThreadsThatAreMadeMeanwhile) {
  if (!is_permitted()) GTEST_SKIP() << "realtime priority is not permitted here";
  const int before = policy_of_a_new_thread();
  {
    const InheritedPriority priority(1);
    EXPECT_EQ(policy_of_a_new_thread(), SCHED_FIFO);
  }
  EXPECT_EQ(policy_of_a_new_thread(), before);
}

}  // namespace
}  // namespace cordis::node
