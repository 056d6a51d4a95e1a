// tests/node/inherited_priority_test.cpp
#include "node/inherited_priority.h"

#include <thread>

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include "tests/support/realtime_permission.h"

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
  if (!test::may_have_realtime_priority())
    GTEST_SKIP() << "realtime priority is not permitted here";
  const int before = policy_of_a_new_thread();
  {
    const InheritedPriority priority(1);
    EXPECT_EQ(policy_of_a_new_thread(), SCHED_FIFO);
  }
  EXPECT_EQ(policy_of_a_new_thread(), before);
}

TEST(InheritedPriority, LeavesAThreadOfRealtimePriorityAsItIs) {
  if (!test::may_have_realtime_priority())
    GTEST_SKIP() << "realtime priority is not permitted here";
  EXPECT_EQ(realtime_priority(), 0);
  {
    const InheritedPriority outer(3);
    const InheritedPriority inner(2);
    EXPECT_EQ(realtime_priority(), 3);
  }
  const InheritedPriority none(0);
  EXPECT_EQ(realtime_priority(), 0);
}

}  // namespace
}  // namespace cordis::node
