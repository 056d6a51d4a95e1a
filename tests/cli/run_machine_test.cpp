// tests/cli/run_machine_test.cpp -- what `cordis run` says of late ticks.
#include "tests/cli/fake_session.h"
#include "tests/support/timer_control.h"

namespace cordis::test {
namespace {

/// Stops a process until a timer that is due every millisecond has woken 50 times.
void stop_for_a_while(const ChildProcess& process) {
  const TimerControl timer;
  process.signal(SIGSTOP);
  EXPECT_TRUE(eventually([&] { return timer.turn_count() >= 50; }));
  process.signal(SIGCONT);
}

TEST(RunMachine, IsNamedOnceAndAtTheEndWhenItIsTheReasonOfLateTicks) {
  FakeSession session;
  session.node("sim", "late 5");
  const auto run = session.start();
  ASSERT_TRUE(run->wait_for_output("session 'fake'", kPatience));

  stop_for_a_while(*run);  // its timers are late, as those of all are on a machine that stalls

  ASSERT_TRUE(run->wait_for_output("cordis | the machine itself woke ", kPatience));
  EXPECT_EQ(count_of(run->output(), "the machine itself woke "), 1u);
  run->signal(SIGINT);
  EXPECT_EQ(end_of(*run), 0);
  EXPECT_EQ(count_of(run->output(), "the machine itself woke "), 2u);
  EXPECT_EQ(count_of(run->output(), "\nthe machine itself woke "), 1u) << "below the table";
  EXPECT_EQ(count_of(run->output(), "  not woken 5, device silent 1\n"), 1u)
      << "once the session is being stopped no silence counts\n"
      << run->output();
}

TEST(RunMachine, IsNotNamedWhenNoTickWasLate) {
  FakeSession session;
  session.node("view", "run http://127.0.0.1:8123");
  const auto run = session.start();
  ASSERT_TRUE(run->wait_for_output("page of view", kPatience));

  stop_for_a_while(*run);

  run->signal(SIGINT);
  EXPECT_EQ(end_of(*run), 0);
  EXPECT_EQ(count_of(run->output(), "the machine itself"), 0u);
}

}  // namespace
}  // namespace cordis::test
