// tests/node/resending_thread_test.cpp
#include "node/dds/resending_thread.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/syscall.h>

#include "node/dds/participant.h"
#include "node/inherited_priority.h"
#include "tests/support/eventually.h"
#include "tests/support/realtime_permission.h"
#include "tests/support/test_domain.h"

namespace cordis::dds {
namespace {

/// What a thread waits in: the number of the system call, and its first four arguments.
struct Wait {
  long number = -1;
  unsigned long arguments[4]{};
};

Wait wait_of(pid_t thread) {
  std::ifstream file("/proc/self/task/" + std::to_string(thread) + "/syscall");
  Wait wait;
  file >> wait.number >> std::hex;
  for (unsigned long& argument : wait.arguments) file >> argument;
  return wait;
}

bool receives(pid_t thread) {
  return wait_of(thread).number == SYS_recvfrom;
}

/// Waits to be woken, however long: all other threads of a participant look around now and then.
bool waits_without_limit(pid_t thread) {
  const Wait wait = wait_of(thread);
  return wait.number == SYS_futex && wait.arguments[3] == 0;
}

std::vector<pid_t> made_since(const std::vector<pid_t>& before) {
  std::vector<pid_t> threads = threads_of_process();
  std::erase_if(threads, [&before](pid_t thread) {
    return std::ranges::find(before, thread) != before.end();
  });
  return threads;
}

bool is_ordinary(pid_t thread) {
  return sched_getscheduler(thread) == SCHED_OTHER;
}

TEST(ResendingThread, AloneOfAParticipantHasNoRealtimePriority) {
  if (!test::may_have_realtime_priority())
    GTEST_SKIP() << "realtime priority is not permitted here";
  const std::vector<pid_t> before = threads_of_process();
  std::optional<Participant> participant;
  {
    const node::InheritedPriority priority(1);
    participant.emplace(ParticipantConfig{test::own_domain(), "resending", "here"});
  }
  const std::vector<pid_t> threads = made_since(before);

  ASSERT_EQ(std::ranges::count_if(threads, is_ordinary), 1);
  const pid_t resending = *std::ranges::find_if(threads, is_ordinary);
  EXPECT_TRUE(test::eventually([&] { return waits_without_limit(resending); }));
  EXPECT_TRUE(test::eventually([&] { return std::ranges::count_if(threads, receives) == 2; }));
}

TEST(ResendingThread, OfAParticipantOfOrdinaryPriorityStaysAsItIs) {
  const std::vector<pid_t> before = threads_of_process();

  const Participant participant({test::own_domain(), "resending", "here"});

  const std::vector<pid_t> threads = made_since(before);
  EXPECT_FALSE(threads.empty());
  EXPECT_TRUE(std::ranges::all_of(threads, is_ordinary));
}

}  // namespace
}  // namespace cordis::dds
