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
#include "node/dds/participant_impl.h"
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

constexpr int kPriority = 40;

bool is_ordinary(pid_t thread) {
  return sched_getscheduler(thread) == SCHED_OTHER;
}

int realtime_priority_of(pid_t thread) {
  sched_param parameters{};
  if (sched_getscheduler(thread) != SCHED_FIFO || sched_getparam(thread, &parameters) != 0)
    return 0;
  return parameters.sched_priority;
}

TEST(ResendingThread, AloneOfAParticipantHasTheLowestRealtimePriority) {
  if (!test::may_have_realtime_priority())
    GTEST_SKIP() << "realtime priority is not permitted here";
  const std::vector<pid_t> before = threads_of_process();
  std::optional<Participant> participant;
  {
    const node::InheritedPriority priority(kPriority);
    participant.emplace(ParticipantConfig{test::own_domain(), "resending", "here"});
  }
  const std::vector<pid_t> threads = made_since(before);

  const auto is_lowest = [](pid_t thread) { return realtime_priority_of(thread) == 1; };
  ASSERT_EQ(std::ranges::count_if(threads, is_lowest), 1);
  EXPECT_EQ(std::ranges::count(threads, kPriority, realtime_priority_of), std::ssize(threads) - 1);
  const pid_t resending = *std::ranges::find_if(threads, is_lowest);
  std::string name;
  std::getline(std::ifstream("/proc/self/task/" + std::to_string(resending) + "/comm"), name);
  EXPECT_EQ(name, "dds-resend");
  EXPECT_TRUE(test::eventually([&] { return waits_without_limit(resending); }));
  EXPECT_TRUE(test::eventually([&] { return std::ranges::count_if(threads, receives) == 2; }));
}

TEST(ResendingThread, IsOvertakenByWhoAddsAndRemovesReadersAndWriters) {
  if (!test::may_have_realtime_priority())
    GTEST_SKIP() << "realtime priority is not permitted here";
  std::optional<Participant> participant;
  {
    const node::InheritedPriority priority(kPriority);
    participant.emplace(ParticipantConfig{test::own_domain(), "resending", "here"});
  }
  /// Writes down the priority of the thread that makes it.
  class Watch : public Endpoint {
   public:
    void prepare(Presence&) override { priority = node::realtime_priority(); }
    void change_over() noexcept override {}
    int priority = -1;
  } watch;

  participant->impl().add(watch);
  EXPECT_EQ(watch.priority, kPriority);
  int while_removed = -1;
  participant->impl().remove(watch, [&] { while_removed = node::realtime_priority(); });
  EXPECT_EQ(while_removed, kPriority);
  EXPECT_EQ(node::realtime_priority(), 0);
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
