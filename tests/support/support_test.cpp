// tests/support/support_test.cpp -- what the tests of processes and clocks rely on.
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/child_process.h"
#include "tests/support/eventually.h"
#include "tests/support/filled.h"
#include "tests/support/line_control.h"
#include "tests/support/timer_control.h"

namespace cordis::test {
namespace {

using namespace std::chrono_literals;

TEST(Eventually, AsksAgainUntilTheConditionHolds) {
  int asked = 0;
  EXPECT_TRUE(eventually([&] { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
}

TEST(Eventually, EndsInVainAndSaysSo) {
  testing::internal::CaptureStderr();
  const bool held = eventually([] { return false; }, 3ms);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "a condition did not hold within 0.003 s\n");
  EXPECT_FALSE(held);
}

TEST(Filled, PutsEachValueIntoItsGapsAndNowhereElse) {
  EXPECT_EQ(filled("m: {k: <k>, z: <z>}\nn: {k: <k>, when: x < 1}\n", {{"k", "30"}, {"z", ""}}),
            R"(m: {k: 30, z: }
n: {k: 30, when: x < 1}
)");
  EXPECT_EQ(filled("<a>", {{"a", "<a><a>"}}), "<a><a>");
  EXPECT_THROW(static_cast<void>(filled("m: <k>\n", {{"z", "1"}})), std::invalid_argument);
}

TEST(ChildProcess, GivesTheOutputAndTheExitCode) {
  ChildProcess process({"sh", "-c", "echo $WORD; echo wrong >&2; exit 3"}, {{"WORD", "right"}});
  EXPECT_EQ(process.wait(kPatience), 3);
  EXPECT_EQ(process.output(), "right\nwrong\n");
}

TEST(ChildProcess, ThatIsKilledGivesItsSignal) {
  ChildProcess process({"sleep", "1000"});
  EXPECT_EQ(process.wait(0ms), -1) << "it runs";
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait(kPatience), 128 + SIGKILL);
}

TEST(ChildProcess, IsEndedWithItsObject) {
  pid_t id = 0;
  {
    const ChildProcess process({"sleep", "1000"});
    id = process.id();
  }
  EXPECT_EQ(kill(id, 0), -1);
}

void wait_in_vain() {
  ChildProcess process({"sh", "-c", "echo words; exec sleep 1000"});
  EXPECT_TRUE(process.wait_for_output("words", kPatience));
  EXPECT_TRUE(process.wait_for_output("others", 3ms));
}

TEST(ChildProcess, OfATestThatFailsIsPrinted) {
  if (std::getenv("CORDIS_WAIT_IN_VAIN") != nullptr) return wait_in_vain();
  ChildProcess self({"/proc/self/exe", "--gtest_filter=ChildProcess.OfATestThatFailsIsPrinted"},
                    {{"CORDIS_WAIT_IN_VAIN", "1"}});
  EXPECT_EQ(self.wait(kPatience), 1);
  const std::string said = self.output();
  EXPECT_NE(said.find("no 'others' within 0.003 s from sh -c echo words"), std::string::npos);
  EXPECT_NE(said.find("\n---- output of sh -c echo words; exec sleep 1000\nwords\n"),
            std::string::npos)
      << said;
}

TEST(ChildProcess, OfATestThatPassesIsNotPrinted) {
  testing::internal::CaptureStderr();
  ChildProcess({"echo", "words"}).wait(kPatience);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

void hang() {
  ChildProcess process({"sh", "-c", "echo last words; exec sleep 1000"});
  process.wait_for_output("last words", kPatience);
  for (;;) pause();
}

TEST(HangWatch, EndsATestThatHangsWithTheOutputOfItsProcesses) {
  if (std::getenv("CORDIS_TEST_LIMIT_S") != nullptr) return hang();
  ChildProcess self(
      {"/proc/self/exe", "--gtest_filter=HangWatch.EndsATestThatHangsWithTheOutputOfItsProcesses"},
      {{"CORDIS_TEST_LIMIT_S", "5"}});
  EXPECT_EQ(self.wait(kPatience), 128 + SIGABRT);
  const std::string said = self.output();
  EXPECT_NE(said.find("this test hangs: it takes longer than 5 s\n"), std::string::npos) << said;
  EXPECT_NE(said.find("---- output of sh -c echo last words; exec sleep 1000\nlast words\n"),
            std::string::npos)
      << said;
}

/// How late a timer was in a process that stalled for `pause`.
std::chrono::nanoseconds worst_after_a_pause_of(std::chrono::milliseconds pause) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const TimerControl control;
    while (control.turn_count() == 0) usleep(100);
    raise(SIGSTOP);
    const std::uint64_t before = control.turn_count();
    while (control.turn_count() < before + 2) usleep(100);
    const std::chrono::nanoseconds worst = control.worst();
    _exit(write(ends[1], &worst, sizeof worst) == sizeof worst ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, WUNTRACED);
  EXPECT_TRUE(WIFSTOPPED(status));
  std::this_thread::sleep_for(pause);
  kill(child, SIGCONT);
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  std::chrono::nanoseconds worst{};
  EXPECT_EQ(read(ends[0], &worst, sizeof worst), static_cast<ssize_t>(sizeof worst));
  close(ends[0]);
  close(ends[1]);
  return worst;
}

TEST(TimerControl, CountsAPauseOfTheProcessAsADelay) {
  EXPECT_GE(worst_after_a_pause_of(30ms), 28ms) << "30 ms, less the period in which it began";
}

TEST(TimerControl, WakesAgainAndAgainAndSaysWhyATestIsSkipped) {
  const TimerControl control;
  ASSERT_TRUE(eventually([&] { return control.turn_count() >= 5; }));
  EXPECT_GT(control.worst(), 0ns);
  EXPECT_EQ(control.reason_to_skip(std::chrono::hours(1)), "");
  const std::string reason = control.reason_to_skip(0ns);
  EXPECT_EQ(reason.find("this machine wakes timers "), 0u) << reason;
  EXPECT_TRUE(reason.ends_with(" ms late")) << reason;
}

TEST(LineControl, CarriesByteAfterByteAndMeasuresTheWay) {
  const LineControl control;
  ASSERT_TRUE(eventually([&] { return control.turn_count() >= 5; }));
  EXPECT_GT(control.worst(), 0ns);
}

}  // namespace
}  // namespace cordis::test
