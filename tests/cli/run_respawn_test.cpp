// tests/cli/run_respawn_test.cpp -- which nodes `cordis run` starts again, how often, and how that
// ends.
#include <filesystem>

#include "tests/cli/fake_session.h"

namespace cordis::test {
namespace {

/// A session whose nodes start again when they die.
class RunRespawn : public testing::Test {
 protected:
  RunRespawn() {
    session_.respawn();
    session_.announce();
  }

  FakeSession session_;
};

TEST_F(RunRespawn, StartsANodeAgainThatDiedWhileTheOthersGoOn) {
  for (const std::string end : {"die 9", "die 11", "exit 1"}) {
    FakeSession session;
    session.respawn();
    session.announce();
    session.node("key", "pid;await;" + end + "|say back;pid");
    const auto run = session.start();
    ASSERT_TRUE(wait_for_all(*run));

    release(*run, "key");

    ASSERT_TRUE(run->wait_for_output("; it starts again in 0.2 s\n", kPatience)) << run->output();
    ASSERT_TRUE(run->wait_for_output("key    | back\n", kPatience)) << run->output();
    EXPECT_EQ(count_of(run->output(), "| stopped"), 0u);
    run->signal(SIGTERM);
    EXPECT_EQ(end_of(*run), 0);
    EXPECT_EQ(count_of(run->output(), "| stopped\n"), 3u) << run->output();
    EXPECT_EQ(count_of(run->output(), "key was started again 1 time\n"), 1u) << run->output();
  }
}

TEST_F(RunRespawn, SaysThatASceneBeginsAtItsStart) {
  session_.node("sim", "die 9|say back;pid");
  const auto run = session_.start();

  ASSERT_TRUE(run->wait_for_output("sim    | back\n", kPatience)) << run->output();
  EXPECT_EQ(count_of(run->output(),
                     "cordis | sim: killed by signal 9 (Killed); it starts again in 0.2 s and "
                     "begins at the start of the scene\n"),
            1u)
      << run->output();
  run->signal(SIGTERM);
  EXPECT_EQ(end_of(*run), 0);
}

TEST_F(RunRespawn, GivesUpAfterFiveRestartsAMinuteAndSaysSoInSixLines) {
  session_.node("sim", "die 11");
  session_.node("view", "exit 3");
  const auto run = session_.start();

  EXPECT_EQ(end_of(*run), 128 + SIGSEGV);

  const std::string output = run->output();
  EXPECT_EQ(count_of(output, "cordis | sim: killed by signal 11 (Segmentation fault); it starts"),
            5u)
      << output;
  EXPECT_EQ(
      count_of(output,
               "cordis | sim: killed by signal 11 (Segmentation fault), after 5 restarts in a "
               "minute; stopping the others\n"),
      1u)
      << output;
  EXPECT_EQ(count_of(output, "cordis | sim:"), 6u) << output;
  EXPECT_LE(count_of(output, "cordis | view:"), 6u) << output;
  EXPECT_EQ(count_of(output, "key    | stopped\n"), 1u) << output;
}

TEST_F(RunRespawn, DoesNotStartANodeAgainThatIsDoneOrFindsBadInput) {
  session_.node("view", "exit 0");
  session_.node("sim", "die 9|error scene.yaml:3:1: error: no mass;exit 2");
  const auto run = session_.start();

  EXPECT_EQ(end_of(*run), 2);
  const std::string output = run->output();
  EXPECT_EQ(count_of(output, "cordis | view: has ended; the others go on\n"), 1u) << output;
  EXPECT_EQ(count_of(output, "sim    | scene.yaml:3:1: error: no mass\n"), 1u) << output;
  EXPECT_EQ(
      count_of(output,
               "cordis | sim: exit code 2 (bad input, which a restart does not mend); stopping "
               "the others\n"),
      1u)
      << output;
}

TEST_F(RunRespawn, EndsAtOnceWhenItIsStoppedWhileANodeWaits) {
  const auto summary = session_.directory() / "summary.json";
  session_.node("key", "pid;await;die 9|die 9|die 9");
  const auto run = session_.start({"--summary", summary});
  ASSERT_TRUE(wait_for_all(*run));
  release(*run, "key");
  ASSERT_TRUE(run->wait_for_output("it starts again in 5 s\n", kPatience)) << run->output();

  run->signal(SIGINT);

  EXPECT_EQ(end_of(*run), 1) << "the session needs it";
  const std::string output = run->output();
  EXPECT_EQ(count_of(output, "key was down at the end\n"), 1u) << output;
  std::string said;
  std::getline(std::ifstream(summary), said, '\0');
  EXPECT_EQ(count_of(said, "\"complete\": false"), 1u) << said;
  EXPECT_EQ(count_of(said, "\"reason\": \"was down at the end\""), 1u) << said;
  EXPECT_EQ(count_of(output, "cordis | stopping; once more kills\n"), 1u) << output;
  EXPECT_EQ(count_of(output, "cordis | key: "), 3u) << "nothing more is said of it\n" << output;
  EXPECT_EQ(count_of(output, "sim    | stopped\n"), 1u) << output;
}

TEST_F(RunRespawn, LeavesLockstepSessionsToEndUnlessTheLaunchFileWantsARestart) {
  session_.clock("lockstep");
  session_.node("view", "die 9|say back;pid");
  session_.node("sim", "pid;await;die 9|say back;pid");
  const auto run = session_.start();
  ASSERT_TRUE(run->wait_for_output("view   | back\n", kPatience)) << "it only shows";
  ASSERT_TRUE(run->wait_for_output("sim    | pid", kPatience));

  release(*run, "sim");

  EXPECT_EQ(end_of(*run), 128 + SIGKILL) << run->output();
  EXPECT_EQ(count_of(run->output(), "sim: killed by signal 9 (Killed); stopping the others\n"), 1u)
      << run->output();

  const auto wanted = session_.start({"sim.respawn=true"});
  ASSERT_TRUE(wanted->wait_for_output("sim    | pid", kPatience));
  release(*wanted, "sim");
  ASSERT_TRUE(wanted->wait_for_output("sim    | back\n", kPatience)) << wanted->output();
  wanted->signal(SIGTERM);
  EXPECT_EQ(end_of(*wanted), 0);
}

TEST_F(RunRespawn, StartsTheProgramThatStandsThereNowAndWaitsForOneThatIsMissing) {
  const auto copies = session_.directory() / "bin";
  std::filesystem::create_directories(copies);
  for (const char* program : {"cordis", "sim_node", "device_node", "viz_node"}) {
    std::filesystem::copy(std::filesystem::path(CORDIS_FAKE_SESSION) / program, copies / program);
  }
  session_.node("key", "pid;await;die 9|say back;pid");
  const auto run = session_.start_words({copies / "cordis", "run", session_.launch_file()});
  ASSERT_TRUE(wait_for_all(*run));
  std::filesystem::rename(copies / "device_node", copies / "gone");

  release(*run, "key");

  ASSERT_TRUE(run->wait_for_output("key: cannot start " + (copies / "device_node").string() +
                                       ": No such file or directory; it starts again in 1 s\n",
                                   kPatience))
      << run->output();
  std::filesystem::rename(copies / "gone", copies / "device_node");
  ASSERT_TRUE(run->wait_for_output("key    | back\n", kPatience)) << run->output();
  run->signal(SIGTERM);
  EXPECT_EQ(end_of(*run), 0);
}

}  // namespace
}  // namespace cordis::test
