// tests/integration/session_end_test.cpp -- verbs that read a session end with it, and not before.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/integration/live_session.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

using namespace std::chrono_literals;

const std::string kString = CORDIS_SOURCE_DIR "/launch_configs/plucked_string.yaml";

/// Verbs beside a session in a domain of the test's own, and a folder for their files.
class SessionEnd : public testing::Test {
 protected:
  SessionEnd() { std::filesystem::create_directories(folder_); }
  ~SessionEnd() override { std::filesystem::remove_all(folder_); }

  static std::unique_ptr<ChildProcess> launcher(
      const std::map<std::string, std::string>& environment = {}) {
    return std::make_unique<ChildProcess>(
        std::vector<std::string>{program_path("cordis"), "run", kString, "domain=" + domain(),
                                 "--only", "sim,keyboard", "--no-color"},
        environment);
  }

  /// A verb that reads what the nodes say of themselves.
  static std::unique_ptr<ChildProcess> verb(
      std::vector<std::string> words, const std::map<std::string, std::string>& environment = {}) {
    words.insert(words.begin(), program_path("cordis"));
    words.insert(words.end(), {"--domain", domain()});
    return std::make_unique<ChildProcess>(words, environment);
  }

  static std::string domain() { return std::to_string(own_domain()); }

  static void end(ChildProcess& launcher) {
    launcher.signal(SIGINT);
    EXPECT_EQ(launcher.wait(kPatience), 0) << launcher.output();
  }

  static void expect_end(ChildProcess& verb, const std::string& sentence) {
    EXPECT_EQ(verb.wait(kPatience), 0);
    verb.wait_for_end_of_output(kPatience);
    EXPECT_NE(verb.output().find(sentence), std::string::npos) << verb.output();
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("session_end." + std::to_string(getpid()));
};

TEST_F(SessionEnd, EndsTheVerbsThatReadItAndANodeThatStartsAgainDoesNot) {
  const auto run = launcher();
  ASSERT_TRUE(run->wait_for_output("keyboard | ", kPatience));
  const auto hz = verb({"hz", "plucked_string", "node/status"});
  const auto echo = verb({"echo", "plucked_string", "node/status"});
  const auto record = verb({"record", "plucked_string", "--topics", "node/status", "-o",
                            (folder_ / "take.mcap").string()});
  ASSERT_TRUE(hz->wait_for_output("node/status ", kPatience));
  ASSERT_TRUE(echo->wait_for_output("keyboard", kPatience));
  ASSERT_TRUE(record->wait_for_output("records into", kPatience));

  ASSERT_EQ(kill(process_of(*run, "sim"), SIGKILL), 0);
  ASSERT_TRUE(run->wait_for_output("it starts again", kPatience));
  std::this_thread::sleep_for(3s);
  for (ChildProcess* reader : {hz.get(), echo.get(), record.get()})
    EXPECT_EQ(reader->wait(0ms), -1) << reader->output();
  end(*run);

  for (ChildProcess* reader : {hz.get(), echo.get(), record.get()})
    expect_end(*reader, ": session 'plucked_string' has ended\n");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "take.mcap"));
}

TEST_F(SessionEnd, IsNotThatOfASessionThatHasNotBegun) {
  const auto hz = verb({"hz", kString, "node/status"});
  ASSERT_TRUE(hz->wait_for_output("no message has come", kPatience));
  const auto run = launcher();
  ASSERT_TRUE(hz->wait_for_output("node/status ", kPatience)) << run->output();
  end(*run);

  expect_end(*hz, "cordis hz: session 'plucked_string' has ended\n");
}

TEST_F(SessionEnd, IsSilenceWhereItsRegistryIsOutOfReach) {
  const auto run = launcher({{"CORDIS_RUNTIME_DIR", (folder_ / "theirs").string()}});
  ASSERT_TRUE(run->wait_for_output("keyboard | ", kPatience));
  const auto hz = verb({"hz", "plucked_string", "node/status"},
                       {{"CORDIS_RUNTIME_DIR", (folder_ / "own").string()}});
  ASSERT_TRUE(hz->wait_for_output("node/status ", kPatience));
  end(*run);

  expect_end(*hz,
             "cordis hz: session 'plucked_string' has ended, or its host or the network is "
             "gone: no node has spoken for 10 s\n");
}

TEST_F(SessionEnd, WithoutAMessageIsAFailure) {
  const auto run = launcher();
  ASSERT_TRUE(run->wait_for_output("keyboard | ", kPatience));
  const auto hz = verb({"hz", "plucked_string", "lab/none"});
  const auto echo = verb({"echo", "plucked_string", "lab/none"});
  for (ChildProcess* reader : {hz.get(), echo.get()})
    ASSERT_TRUE(reader->wait_for_output("no message has come", kPatience));
  end(*run);

  for (ChildProcess* reader : {hz.get(), echo.get()}) {
    EXPECT_EQ(reader->wait(kPatience), 1);
    EXPECT_NE(reader->output().find("has ended"), std::string::npos) << reader->output();
  }
}

}  // namespace
}  // namespace cordis::test
