// tests/machine/machine_test.cpp -- what is measured of the machine itself.
#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "node/machine/deadline_record.h"
#include "node/machine/processor_quota.h"
#include "node/machine/processor_time.h"
#include "node/machine/timer_watch.h"
#include "node/machine/wakeups.h"
#include "tests/support/fake_root.h"
#include "tests/support/realtime_permission.h"

namespace cordis::machine {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

TEST(DeadlineRecord, CountsTheDeadlinesThatPassMeanwhile) {
  DeadlineRecord record;
  for (int n = 0; n < 95; ++n) EXPECT_EQ(record.record(50'000, kMillisecond), 0);

  EXPECT_EQ(record.record(4 * kMillisecond + 100'000, kMillisecond), 4);

  // Late by 4.1, 3.1, 2.1, 1.1 and 0.1 ms: four are late, and as many lost.
  EXPECT_EQ(record.count(), 100u);
  EXPECT_DOUBLE_EQ(record.late_share(), 0.04);
  EXPECT_DOUBLE_EQ(record.lost_share(), 0.04);
  EXPECT_DOUBLE_EQ(record.worst_s(), 4.1e-3);
  EXPECT_GT(record.p99_s(), 3e-3);
}

TEST(DeadlineRecord, IsEmptyAtFirst) {
  const DeadlineRecord record;
  EXPECT_EQ(record.count(), 0u);
  EXPECT_EQ(record.late_share(), 0.0);
  EXPECT_EQ(record.worst_s(), 0.0);
}

TEST(SystemFiles, TakeWhatIsMissingForNothing) {
  const FakeRoot root;
  root.put("sys/one", "text \n");
  EXPECT_EQ(root.files().text("sys/one"), "text");
  EXPECT_FALSE(root.files().text("sys/two"));
  EXPECT_FALSE(root.files().text("sys"));
  EXPECT_TRUE(root.files().names("dev", "tty").empty());
}

TEST(ProcessorQuota, IsTheSmallestOfAllGroupsAround) {
  const FakeRoot root;
  root.put("proc/self/cgroup", "0::/a.slice/b.scope");
  EXPECT_FALSE(processor_quota(root.files()));
  root.put("sys/fs/cgroup/a.slice/b.scope/cpu.max", "max 100000\n");
  EXPECT_FALSE(processor_quota(root.files()));
  root.put("sys/fs/cgroup/a.slice/cpu.max", "250000 100000\n");
  EXPECT_EQ(processor_quota(root.files()), 2.5);
  root.put("sys/fs/cgroup/a.slice/b.scope/cpu.max", "300000 100000\n");
  EXPECT_EQ(processor_quota(root.files()), 2.5);
  root.put("sys/fs/cgroup/a.slice/b.scope/cpu.max", "50000 100000\n");
  EXPECT_EQ(processor_quota(root.files()), 0.5);
}

TEST(ProcessorQuota, IsReadOfVersion1Too) {
  const FakeRoot root;
  root.put("proc/self/cgroup", "5:cpuset:/a\n4:cpu,cpuacct:/a\n0::/\n");
  root.put("sys/fs/cgroup/cpuset/a/cpu.cfs_quota_us", "1\n");
  root.put("sys/fs/cgroup/cpuset/a/cpu.cfs_period_us", "1\n");
  root.put("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "-1\n");
  root.put("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000\n");
  EXPECT_FALSE(processor_quota(root.files()));
  root.put("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "150000\n");
  EXPECT_EQ(processor_quota(root.files()), 1.5);
}

/// A container has the path of its host, and its own group as the root.
TEST(ProcessorQuota, IsThatOfTheRootInAContainer) {
  const FakeRoot root;
  root.put("proc/self/cgroup", "0::/docker/0123\n");
  root.put("sys/fs/cgroup/cpu.max", "200000 100000\n");
  EXPECT_EQ(processor_quota(root.files()), 2.0);
}

TEST(ProcessorQuota, LimitsTheProcessorsThatAreUsedToWholeOnes) {
  const FakeRoot root;
  EXPECT_EQ(usable_processors(root.files()), usable_cores().size());
  root.put("proc/self/cgroup", "0::/\n");
  for (const char* quota : {"50000 100000", "100000 100000", "190000 100000"}) {
    root.put("sys/fs/cgroup/cpu.max", quota);
    EXPECT_EQ(usable_processors(root.files()), 1U) << quota;
  }
  root.put("sys/fs/cgroup/cpu.max", "100000000 100000");
  EXPECT_EQ(usable_processors(root.files()), usable_cores().size());
}

TEST(ProcessorTime, ReportsTheShareThatWasStolen) {
  const FakeRoot root;
  root.put("proc/stat", "cpu  100 0 50 800 10 0 5 35 99 0\ncpu0 1 1 1 1 1 1 1 1 0 0\n");
  const auto before = read_processor_time(root.files());
  root.put("proc/stat", "cpu  150 0 50 1100 10 0 5 85 99 0\n");
  const auto after = read_processor_time(root.files());

  ASSERT_TRUE(before);
  EXPECT_EQ(before->total, 1000u);
  EXPECT_EQ(stolen_share(before, after), 0.125);  // 50 of 400
}

TEST(ProcessorTime, IsNothingWhereTheKernelDoesNotReport) {
  const FakeRoot root;
  EXPECT_FALSE(read_processor_time(root.files()));
  root.put("proc/stat", "intr 5\n");
  EXPECT_FALSE(read_processor_time(root.files()));
  root.put("proc/stat", "cpu 1 2 3 4\n");
  const auto time = read_processor_time(root.files());
  ASSERT_TRUE(time);
  EXPECT_EQ(time->stolen, 0u);
  EXPECT_FALSE(stolen_share(time, time));
  EXPECT_FALSE(stolen_share(std::nullopt, time));
}

TEST(Wakeups, AreMeasuredOnEachCoreAtBothPriorities) {
  const std::vector<CoreWakeups> measured = measure_wakeups(std::chrono::milliseconds(300));

  ASSERT_EQ(measured.size(), usable_cores().size());
  for (const CoreWakeups& core : measured) {
    EXPECT_EQ(core.realtime.has_value(), test::may_have_realtime_priority());
    // Every deadline counts, however late a busy machine wakes.
    EXPECT_GE(core.normal.count(), 290u);
    EXPECT_GE(core.of_loops().count(), 290u);
    EXPECT_GE(core.normal.worst_s(), core.normal.p99_s());
    EXPECT_LE(core.normal.lost_share(), core.normal.late_share());
  }
}

TEST(TimerWatch, WatchesAsLongAsItLives) {
  const TimerWatch watch;
  TimerFigures figures;
  while (figures.watched_s < 0.1) {
    usleep(10'000);
    figures = watch.figures();
  }
  EXPECT_GE(figures.late_share, 0.0);
  EXPECT_LE(figures.late_share, 1.0);
}

TEST(TimerWatch, CountsWhatItsProcessAndChildrenCompute) {
  const std::int64_t before = family_processor_nsec();
  const pid_t child = fork();
  if (child == 0) {
    while (true) {
    }
  }
  ASSERT_GT(child, 0);
  while (family_processor_nsec() - before < 100'000'000) usleep(10'000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_GE(family_processor_nsec() - before, 100'000'000) << "it still counts when it has ended";
}

}  // namespace
}  // namespace cordis::machine
