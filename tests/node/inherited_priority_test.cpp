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

TEST(InheritedPriority, IsThatOfThreadsThatAreMadeMeanwhile) {
  const int before = policy_of_a_new_thread();
  {
    const InheritedPriority priority(1);
    const int meanwhile = policy_of_a_new_thread();
    if (meanwhile == before) GTEST_SKIP() << "realtime priority is not permitted here";
    EXPECT_EQ(meanwhile, SCHED_FIFO);
  }
  EXPECT_EQ(policy_of_a_new_thread(), before);
}

}  // namespace
}  // namespace cordis::node
