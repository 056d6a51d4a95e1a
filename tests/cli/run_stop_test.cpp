// tests/cli/run_stop_test.cpp -- how `cordis run` ends its nodes, and that it always does.
#include "tests/cli/fake_session.h"
#include "tests/support/timer_control.h"

namespace cordis::test {
namespace {

TEST(RunStop, StopsDeviceThenDisplayThenSim) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    FakeSession session;
    session.announce();
    const auto run = session.start();
    ASSERT_TRUE(wait_for_all(*run));

    run->signal(signal);

    EXPECT_EQ(end_of(*run), 0);
    const std::string output = run->output();
    const std::size_t key = output.find("key    | stopped");
    const std::size_t view = output.find("view   | stopped");
    const std::size_t sim = output.find("sim    | stopped");
    EXPECT_LT(key, view);
    EXPECT_LT(view, sim);
    EXPECT_NE(sim, std::string::npos) << output;
  }
}

TEST(RunStop, KillsANodeThatDoesNotListenAndStopsTheRest) {
  FakeSession session;
  session.announce();
  session.node("key", "pid;deaf");
  const auto run = session.start();
  ASSERT_TRUE(wait_for_all(*run));

  run->signal(SIGTERM);

  EXPECT_EQ(end_of(*run), 128 + SIGKILL);
  EXPECT_NE(run->output().find("cordis | key: did not stop in time and is killed\n"),
            std::string::npos);
  EXPECT_NE(run->output().find("sim    | stopped\n"), std::string::npos);
}

TEST(RunStop, KillsAllAtTheSecondSignal) {
  FakeSession session;
  session.announce();
  session.node("key", "pid;deaf");
  const auto run = session.start();
  ASSERT_TRUE(wait_for_all(*run));

  run->signal(SIGINT);
  ASSERT_TRUE(run->wait_for_output("cordis | stopping; once more kills\n", kPatience));
  EXPECT_TRUE(eventually([&] {  // what comes too soon is the same request
    run->signal(SIGINT);
    return run->output().find("cordis | killing all nodes;") != std::string::npos;
  }));

  EXPECT_EQ(end_of(*run), 128 + SIGKILL);
  EXPECT_NE(run->output().find("cordis | killing all nodes; devices have 0.5 s to let go\n"),
            std::string::npos);
  EXPECT_EQ(run->output().find("sim    | stopped\n"), std::string::npos);
}

TEST(RunStop, TakesTheDoubleSignalOfTimeoutForOneRequest) {
  FakeSession session;
  session.announce();
  const auto run = session.start();
  ASSERT_TRUE(wait_for_all(*run));

  const TimerControl control;
  for (int i = 0; i < 5; ++i) run->signal(SIGTERM);
  const int code = end_of(*run);

  // They are one request within 300 ms.
  const std::string reason = control.reason_to_skip(std::chrono::milliseconds(100));
  if (code != 0 && !reason.empty()) GTEST_SKIP() << reason;
  EXPECT_EQ(code, 0);
  EXPECT_NE(run->output().find("sim    | stopped\n"), std::string::npos);
}

TEST(RunStop, HearsSigintEvenWhenTheShellIgnoredIt) {
  FakeSession session;
  session.announce();
  const auto run = session.start_words({"sh", "-c", "trap '' INT; exec \"$0\" run \"$1\"",
                                        FakeSession::cordis(), session.launch_file()});
  ASSERT_TRUE(wait_for_all(*run));

  run->signal(SIGINT);

  EXPECT_EQ(end_of(*run), 0);
  EXPECT_NE(run->output().find("sim    | stopped\n"), std::string::npos);
}

TEST(RunStop, LeavesNothingBehindWhenItIsKilled) {
  FakeSession session;
  session.announce();
  session.node("view", "pid;deaf");
  const auto run = session.start();
  ASSERT_TRUE(wait_for_all(*run));

  run->signal(SIGKILL);

  EXPECT_EQ(end_of(*run), 128 + SIGKILL);
  const std::vector<pid_t> pids = pids_in(run->output());
  ASSERT_EQ(pids.size(), 3u);
  for (const pid_t pid : pids) EXPECT_TRUE(is_gone(pid)) << pid;
}

TEST(RunStop, EndsTheProcessesThatANodeStartedToo) {
  for (const std::string end : {"exit 0", "die 9"}) {
    FakeSession session;
    session.node("sim", "child;" + end);
    const auto run = session.start();

    end_of(*run);

    const std::vector<pid_t> pids = pids_in(run->output());
    ASSERT_EQ(pids.size(), 1u);
    EXPECT_TRUE(is_gone(pids[0])) << "after " << end;
  }
}

TEST(RunStop, IsNotHeldUpByANodeThatFloodsItsOutput) {
  FakeSession session;
  session.announce();
  session.node("sim", "pid;flood");
  session.node("key", "pid;say heard");
  const auto run = session.start();
  ASSERT_TRUE(wait_for_all(*run));
  ASSERT_TRUE(run->wait_for_output("key    | heard\n", kPatience));
  ASSERT_TRUE(run->wait_for_output("sim    | drop of a flood\n", kPatience));

  run->signal(SIGTERM);

  EXPECT_EQ(end_of(*run), 0);
  EXPECT_NE(run->output().find("sim    | stopped\n"), std::string::npos);
}

TEST(RunStop, LeavesNothingBehindWhenAProgramIsMissing) {
  FakeSession session;
  const auto copies = session.directory() / "bin";
  std::filesystem::create_directories(copies);
  for (const char* program : {"cordis", "sim_node", "device_node"}) {
    std::filesystem::copy(std::filesystem::path(CORDIS_FAKE_SESSION) / program, copies / program);
  }
  session.check("sim", "child;pid;exit 0");
  const auto run = session.start_words({copies / "cordis", "run", session.launch_file()});

  EXPECT_EQ(end_of(*run), 1);
  EXPECT_EQ(run->output(), "cordis run: cannot start " + (copies / "viz_node").string() +
                               ": No such file or directory\n");
}

}  // namespace
}  // namespace cordis::test
