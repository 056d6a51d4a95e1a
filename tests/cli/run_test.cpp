// tests/cli/run_test.cpp -- what `cordis run` starts, shows and returns.
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/cli/fake_session.h"
#include "tests/support/small_disk.h"

namespace cordis::test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Run, StartsEveryNodeWithItsNameAndPrefixesItsLines) {
  FakeSession session;
  session.node("sim", "words;error of the sim");
  session.node("key", "words");
  session.node("view", "begin no newline;exit 0");
  const auto run = session.start({"key.x=1"});
  for (const char* text : {"--name sim", "of the sim", "--name key", "no newline"}) {
    ASSERT_TRUE(run->wait_for_output(text, kPatience));
  }

  run->signal(SIGTERM);

  EXPECT_EQ(end_of(*run), 0);
  EXPECT_TRUE(
      contains(run->output(), "sim    | " + session.launch_file() + " --name sim key.x=1\n"));
  EXPECT_TRUE(
      contains(run->output(), "key    | " + session.launch_file() + " --name key key.x=1\n"));
  EXPECT_TRUE(contains(run->output(), "sim    | of the sim\n"));
  EXPECT_TRUE(contains(run->output(), "view   | no newline\n"));
}

TEST(Run, PrintsTheCommandsOfADryRunAndStartsNothing) {
  FakeSession session;
  session.node("sim", "say started");
  session.check("sim", "say started");
  const auto run = session.start({"--dry-run", "--only", "sim,view", "sim.title=a b"});

  EXPECT_EQ(end_of(*run), 0);
  const std::string bin = CORDIS_FAKE_SESSION;
  EXPECT_EQ(run->output(), bin + "/sim_node '" + session.launch_file() +
                               "' --name sim 'sim.title=a b'\n" + bin + "/viz_node '" +
                               session.launch_file() + "' --name view 'sim.title=a b'\n");
}

TEST(Run, StartsTheRecorderBesideTheNodesOfOnly) {
  FakeSession session;
  for (const char* only : {"sim", "record,sim"}) {
    const auto run = session.start({"--dry-run", "--only", only, "--record", "/tmp/t.mcap"});
    EXPECT_EQ(end_of(*run), 0) << run->output();
    const std::size_t first = run->output().find("/record_node ");
    ASSERT_NE(first, std::string::npos) << run->output();
    EXPECT_EQ(run->output().find("/record_node ", first + 1), std::string::npos);
    EXPECT_TRUE(contains(run->output(), "/sim_node "));
    EXPECT_FALSE(contains(run->output(), "/viz_node "));
  }
}

TEST(Run, RefusesALaunchFileThatIsWrongOrMissing) {
  FakeSession session;
  const auto unknown_clock = session.start({"clock=sundial"});
  EXPECT_EQ(end_of(*unknown_clock), 2);
  EXPECT_TRUE(contains(unknown_clock->output(), "sundial"));

  const auto missing = session.start_words({FakeSession::cordis(), "run", "/nowhere/launch.yaml"});
  EXPECT_EQ(end_of(*missing), 2);
  EXPECT_TRUE(contains(missing->output(), "/nowhere/launch.yaml"));
}

TEST(Run, RefusesAMisspelledWord) {
  FakeSession session;
  const auto run = session.start({"--duration", "3"});
  EXPECT_EQ(end_of(*run), 2);
  EXPECT_TRUE(contains(run->output(), "'3' is not a duration"));
}

TEST(Run, NeverWritesOverItsLaunchFile) {
  FakeSession session;
  for (const char* option : {"--signals", "--summary"}) {
    const auto run = session.start({option, session.launch_file()});
    EXPECT_EQ(end_of(*run), 2);
    EXPECT_TRUE(contains(run->output(), std::string("FILE and ") + option + " name the same file"))
        << run->output();
  }
  EXPECT_EQ(end_of(*session.start({"--dry-run"})), 0) << "it still is a launch file";

  const std::string scene = session.launch_file() + ".scene.yaml";
  std::ofstream(scene) << "cordis: 1\n";
  const auto run = session.start({"--signals", scene});
  EXPECT_EQ(end_of(*run), 2);
  EXPECT_TRUE(contains(run->output(), "--signals would overwrite the YAML file " + scene));
  EXPECT_EQ(std::filesystem::file_size(scene), 10u);

  const std::string take = session.launch_file() + ".mcap";
  std::ofstream(take) << "a take";
  for (const char* option : {"--signals", "--summary"}) {
    const auto other = session.start({option, take});
    EXPECT_EQ(end_of(*other), 2);
    EXPECT_TRUE(contains(other->output(), option + (" would overwrite the take " + take)))
        << other->output();
  }
  EXPECT_EQ(std::filesystem::file_size(take), 6u);
}

TEST(Run, ShowsWhatAllNodesObjectToAndStartsNone) {
  FakeSession session;
  session.check("sim", "error scene.yaml:3:1: error: no mass;exit 2");
  session.check("key", "error device.yaml:7:2: error: no axis;exit 2");
  session.node("view", "say started");
  const auto run = session.start();

  EXPECT_EQ(end_of(*run), 2);
  EXPECT_EQ(run->output(), "scene.yaml:3:1: error: no mass\ndevice.yaml:7:2: error: no axis\n");
}

TEST(Run, FailsWhenACheckItselfFails) {
  FakeSession session;
  session.check("sim", "error scene.yaml:3:1: error: no mass;exit 2");
  session.check("key", "die 9");
  session.node("view", "say started");
  const auto run = session.start();

  EXPECT_EQ(end_of(*run), 1);
  EXPECT_TRUE(contains(run->output(), "no mass"));
  EXPECT_TRUE(contains(run->output(), "key could not check its files: killed by signal 9"));
  EXPECT_FALSE(contains(run->output(), "started"));
}

TEST(Run, EndsWithTheExitCodeOfTheRequiredNodeThatFailed) {
  FakeSession session;
  session.announce();
  session.node("key", "pid;await;exit 3");
  const auto run = session.start();
  ASSERT_TRUE(wait_for_all(*run));

  release(*run, "key");

  EXPECT_EQ(end_of(*run), 3);
  EXPECT_TRUE(contains(run->output(), "cordis | key: exit code 3; stopping the others\n"));
  EXPECT_TRUE(contains(run->output(), "sim    | stopped\n"));
}

TEST(Run, EndsWellWhenARequiredNodeEndsWell) {
  FakeSession session;
  session.announce();
  session.node("sim", "pid;await;exit 0");
  const auto run = session.start();
  ASSERT_TRUE(wait_for_all(*run));

  release(*run, "sim");

  EXPECT_EQ(end_of(*run), 0);
  EXPECT_TRUE(contains(run->output(), "cordis | sim: has ended; stopping the others\n"));
  EXPECT_TRUE(contains(run->output(), "key    | stopped\n"));
}

TEST(Run, NamesTheSignalThatKilledARequiredNode) {
  FakeSession session;
  session.node("sim", "die 9");
  const auto run = session.start();

  EXPECT_EQ(end_of(*run), 128 + 9);
  EXPECT_TRUE(
      contains(run->output(), "cordis | sim: killed by signal 9 (Killed); stopping the others\n"));
}

TEST(Run, GoesOnWithoutANodeThatIsNotRequired) {
  FakeSession session;
  session.node("view", "die 9");
  const auto run = session.start();

  ASSERT_TRUE(run->wait_for_output("cordis | view: killed by signal 9 (Killed); the others go on\n",
                                   kPatience));
  EXPECT_EQ(run->wait(std::chrono::milliseconds(0)), -1);
  EXPECT_FALSE(contains(run->output(), "stopped"));
  run->signal(SIGTERM);
  EXPECT_EQ(end_of(*run), 0);
}

TEST(Run, EndsWithTheCodeOfANodeThatFailedWhenNoneIsLeft) {
  FakeSession session;
  session.node("view", "exit 7");
  const auto run = session.start({"--only", "view"});

  EXPECT_EQ(end_of(*run), 7);
}

TEST(Run, StartsOnlyTheNodesAskedFor) {
  FakeSession session;
  session.node("key", "say started");
  session.node("view", "say started;exit 0");
  session.node("sim", "say started;exit 0");
  const auto run = session.start({"--only", "sim"});

  EXPECT_EQ(end_of(*run), 0);
  EXPECT_TRUE(contains(run->output(), "sim    | started\n"));
  EXPECT_FALSE(contains(run->output(), "key"));
  EXPECT_FALSE(contains(run->output(), "view"));
}

TEST(Run, NamesTheWordsThatAnotherLauncherNeeds) {
  FakeSession session;
  session.node("sim", "run");
  const auto run = session.start({"--only", "sim", "sim.title=a b"});

  EXPECT_TRUE(run->wait_for_output(" 'sim.title=a b' --only ", kPatience));
  run->signal(SIGINT);
  EXPECT_EQ(end_of(*run), 0);
}

TEST(Run, ShowsThePageAndEndsWithATable) {
  FakeSession session;
  session.node("sim", "run");
  session.node("view", "run http://127.0.0.1:8123");
  const auto run = session.start();

  ASSERT_TRUE(run->wait_for_output("cordis | page of view: http://127.0.0.1:8123\n", kPatience));
  run->signal(SIGINT);
  EXPECT_EQ(end_of(*run), 0);
  EXPECT_TRUE(contains(run->output(), "\nnode  rate [Hz]  wanted  overruns"));
  EXPECT_TRUE(
      contains(run->output(), "\nlast known state hash 0123456789abcdef after 4711 steps\n"))
      << "the fake sim never says that it ended";
  EXPECT_TRUE(contains(run->output(), "\nkey   no status was received\n"));
}

TEST(Run, IsNotCompleteWhereANodeThatItNeedsWasKilled) {
  for (const char* clock : {"lockstep", "realtime"}) {
    FakeSession session;
    session.clock(clock);
    session.node("sim", "run;pid");
    const std::string summary = session.directory() / "summary.json";
    const auto run = session.start({"--summary", summary});
    ASSERT_TRUE(run->wait_for_output("sim    | pid", kPatience));
    kill(pids_in(run->output())[0], SIGKILL);
    EXPECT_EQ(end_of(*run), 128 + SIGKILL);
    const std::string text = text_of(summary);
    EXPECT_TRUE(contains(text, R"("complete": false)")) << text;
    EXPECT_TRUE(contains(text, R"("phase": "failed")")) << text;
    EXPECT_TRUE(contains(text, R"("reason": "killed by signal 9)")) << text;
  }
}

/// Runs a session for 100 ms. The launcher waits 5 s for all nodes to run, and says when that was
/// not enough: a busy machine gets five tries.
std::string output_of_a_short_run(FakeSession& session, int code = 0) {
  std::string output;
  for (int i = 0; i < 5; ++i) {
    const auto run = session.start({"--duration", "100ms"});
    EXPECT_EQ(end_of(*run), code) << run->output();
    output = run->output();
    if (!contains(output, "not all nodes run yet")) break;
  }
  return output;
}

TEST(Run, CountsTheDurationAtOnceWhereTheSceneWaitsForNobody) {
  FakeSession session;
  session.node("sim", "phase waiting");
  session.node("key", "phase unused");
  session.node("view", "run");

  const std::string output = output_of_a_short_run(session, 1);

  EXPECT_FALSE(contains(output, "not all nodes run yet"));
  EXPECT_TRUE(contains(output, "no device has joined that a port of the scene plays"));
}

TEST(Run, FailsWhereNoDeviceCameForAPortAndNoneWasExpectedElsewhere) {
  FakeSession session;
  session.node("sim", "phase waiting");
  session.node("key", "phase unused");
  session.node("view", "run");
  const std::string summary = session.directory() / "summary.json";

  const auto run = session.start({"--duration", "100ms", "--summary", summary});
  EXPECT_EQ(end_of(*run), 1) << run->output();
  EXPECT_TRUE(contains(text_of(summary), R"("complete": false)")) << text_of(summary);
  EXPECT_TRUE(contains(text_of(summary), "no device has joined")) << text_of(summary);

  const auto part = session.start({"--duration", "100ms", "--only", "sim,view"});
  EXPECT_EQ(end_of(*part), 0) << part->output();
  EXPECT_FALSE(contains(part->output(), "no device has joined")) << part->output();
}

TEST(Run, EndsByItselfOnceAllNodesHaveRunForTheDuration) {
  FakeSession session;
  for (const char* name : {"sim", "key", "view"}) session.node(name, "run");

  const std::string output = output_of_a_short_run(session);

  EXPECT_TRUE(contains(output, "state hash"));
  EXPECT_FALSE(contains(output, "not all nodes run yet"));
}

TEST(Run, FailsWhereARequiredNodeSaysThatItFailed) {
  FakeSession session;
  session.node("sim", "run");
  session.node("view", "run;say views");
  session.node("key", "phase failed;say failed");
  const auto run = session.start();
  ASSERT_TRUE(run->wait_for_output("key    | failed\n", kPatience));
  ASSERT_TRUE(run->wait_for_output("view   | views\n", kPatience));
  run->signal(SIGINT);
  EXPECT_EQ(end_of(*run), 1);

  session.node("key", "run;say runs");
  session.node("view", "phase failed;say failed");
  const auto again = session.start();
  ASSERT_TRUE(again->wait_for_output("key    | runs\n", kPatience));
  ASSERT_TRUE(again->wait_for_output("view   | failed\n", kPatience));
  again->signal(SIGINT);
  EXPECT_EQ(end_of(*again), 0) << "no session needs its view";
}

TEST(Run, LeavesSimulatedTimeToTheSimulation) {
  FakeSession session;
  session.clock("lockstep");
  session.node("sim", "words;exit 0");
  const auto run = session.start({"--duration", "2500ms"});

  EXPECT_EQ(end_of(*run), 0);
  EXPECT_TRUE(contains(run->output(), "--name sim sim.duration_s=2.5\n"));
}

TEST(Run, WritesTheLinesOfEveryNodeIntoItsFile) {
  FakeSession session;
  session.announce();
  session.node("sim", "say one;error two;pid");
  const auto logs = session.directory() / "new" / "logs";
  const auto run = session.start({"--log-dir", logs});
  ASSERT_TRUE(wait_for_all(*run));

  run->signal(SIGTERM);

  EXPECT_EQ(end_of(*run), 0);
  EXPECT_TRUE(contains(text_of(logs / "sim.log"), " one\n"));
  EXPECT_TRUE(contains(text_of(logs / "sim.log"), " two\n"));
  EXPECT_TRUE(contains(text_of(logs / "view.log"), " stopped\n"));
}

TEST(Run, SaysOnceThatALogTakesNoMore) {
  FakeSession session;
  session.announce();
  std::string commands;
  for (int i = 0; i < 300; ++i) commands += "say " + std::string(100, 'x') + ";";
  session.node("sim", commands + "say the last;pid");
  const auto logs = session.directory() / "logs";
  std::unique_ptr<ChildProcess> run;
  {
    const SmallDisk disk(10000);  // the launcher has files of its own
    run = session.start({"--log-dir", logs});
  }
  ASSERT_TRUE(wait_for_all(*run));

  run->signal(SIGTERM);

  EXPECT_EQ(end_of(*run), 0) << run->output();
  const std::string warning = "warning: cannot write " + logs.string();
  EXPECT_EQ(count_of(run->output(), warning), 1u) << run->output();
  EXPECT_TRUE(contains(run->output(), "sim    | the last\n"));
}

TEST(Run, FailsInOneLineWhenALogCannotBeWritten) {
  FakeSession session;
  const auto run = session.start({"--log-dir", "/proc/none"});

  EXPECT_EQ(end_of(*run), 1);
  EXPECT_EQ(run->output(), "cordis run: cannot write /proc/none/sim.log\n");
}

}  // namespace
}  // namespace cordis::test
