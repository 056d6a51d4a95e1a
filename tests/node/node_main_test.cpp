// tests/node/node_main_test.cpp
#include "node/node_main.h"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "node/background_work.h"
#include "node/instance_lock.h"
#include "node/runtime_folder.h"
#include "node/session_registry.h"

namespace cordis::node {
namespace {

/// A launch file in a folder of its own, gone with the object.
class LaunchFile {
 public:
  explicit LaunchFile(const std::string& text) {
    char folder[] = "/tmp/cordis-test-XXXXXX";
    path_ = std::string(mkdtemp(folder)) + "/launch.yaml";
    setenv("CORDIS_RUNTIME_DIR", folder, /*overwrite=*/1);
    std::ofstream(path_) << text;
  }
  ~LaunchFile() { std::filesystem::remove_all(std::filesystem::path(path_).parent_path()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

const char* const kTwoDevices =
    R"(cordis: 1
session: test
domain: 7
clock: lockstep
nodes:
  left: {node: device_node, device: a.yaml}
  right: {node: device_node, device: b.yaml}
  sim: {node: sim_node, scene: s.yaml}
)";

NodeStart last_start;

int remember(const NodeStart& start, config::Problems&) {
  last_start = start;
  last_start.node = last_start.launch.find(start.node->name);
  return 0;
}

int run_main(std::vector<std::string> words, const std::string& kind,
             int (*run)(const NodeStart&, config::Problems&) = remember) {
  words.insert(words.begin(), kind);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  return node_main(static_cast<int>(arguments.size()), arguments.data(), kind, run);
}

int warn_and_fail(const NodeStart&, config::Problems& problems) {
  problems.warning({"scene\x1b[2J.yaml", 1, 1},
                   "'\xc2\x9b"
                   "31m' and '\x1b]0;title\a' are odd");
  report(problems);
  throw std::runtime_error("a device named '\x1b[8m\xe2\x80\xae'");
}

int leave_work_behind(const NodeStart&, config::Problems&) {
  static_cast<void>(start_background_work(std::function<int()>([] {
    for (;;) pause();
    return 0;
  })));
  spdlog::warn("the last line");
  return 3;
}

TEST(NodeMainDeathTest, EndsBesideBackgroundWorkWithItsLogWritten) {
  const LaunchFile file(kTwoDevices);
  ::testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(
      {
        run_main({file.path(), "--name", "left"}, "device_node", leave_work_behind);
        _exit(4);
      },
      ::testing::ExitedWithCode(3), "the last line");
}

TEST(NodeMain, PrintsTextsOfFilesWithoutEscapeCodes) {
  const LaunchFile file(kTwoDevices);
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run_main({file.path(), "--name", "left"}, "device_node", warn_and_fail), 1);
  EXPECT_EQ(run_main({file.path(), "--name", "l\x1b[2Jeft"}, "device_node"), 2);
  const LaunchFile broken(R"(cordis: 1
session: t
nodes: {sim: {node: "\e[2J"}}
)");
  EXPECT_EQ(run_main({broken.path()}, "sim_node"), 2);

  const std::string seen = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(seen.find("'?31m' and '?]0;title?' are odd"), std::string::npos) << seen;
  EXPECT_NE(seen.find("a device named '?[8m?'"), std::string::npos) << seen;
  EXPECT_NE(seen.find("l?[2Jeft"), std::string::npos) << seen;
  EXPECT_EQ(seen.find('\x1b'), std::string::npos);
  EXPECT_EQ(seen.find("\xc2\x9b"), std::string::npos);
}

TEST(NodeMain, FindsItsNodeOfTheLaunchFile) {
  const LaunchFile file(kTwoDevices);

  EXPECT_EQ(run_main({file.path(), "--name", "right", "right.driver=script"}, "device_node"), 0);

  const dds::ParticipantConfig config = last_start.config();
  EXPECT_EQ(config.node, "right");
  EXPECT_EQ(config.session, "test");
  EXPECT_EQ(config.domain, 7);
  EXPECT_TRUE(config.lockstep);
  EXPECT_FALSE(last_start.check_only);
  EXPECT_GT(last_start.epoch, 0u);
}

TEST(NodeMain, NeedsNoNameWhenThereIsOneOfItsKind) {
  const LaunchFile file(kTwoDevices);
  EXPECT_EQ(run_main({file.path(), "--check"}, "sim_node"), 0);
  EXPECT_EQ(last_start.node->name, "sim");
  EXPECT_TRUE(last_start.check_only);
}

TEST(NodeMain, EndsWith2ForBadUsageAndBadFiles) {
  const LaunchFile file(kTwoDevices);
  EXPECT_EQ(run_main({}, "sim_node"), 2);
  EXPECT_EQ(run_main({file.path()}, "device_node"), 2) << "two devices: which?";
  EXPECT_EQ(run_main({file.path(), "--name", "middle"}, "device_node"), 2);
  EXPECT_EQ(run_main({file.path(), "--name"}, "device_node"), 2);
  EXPECT_EQ(run_main({file.path(), "--verbose"}, "sim_node"), 2);
  EXPECT_EQ(run_main({"/nonexistent/launch.yaml"}, "sim_node"), 2);
  EXPECT_EQ(run_main({file.path(), "sim.nothing.at.all"}, "sim_node"), 2) << "not name.key=value";
  EXPECT_EQ(run_main({"--help"}, "sim_node"), 0);
}

TEST(NodeMain, EndsWith1WhenTheNodeFails) {
  const LaunchFile file(kTwoDevices);
  EXPECT_EQ(
      run_main({file.path()}, "sim_node",
               [](const NodeStart&, config::Problems&) -> int { throw std::runtime_error("no"); }),
      1);
}

TEST(NodeMain, JoinsTheRunningSessionOfItsNameOrClaimsADomain) {
  const LaunchFile file(
      R"(cordis: 1
session: test
nodes:
  sim: {node: sim_node}
  view: {node: viz_node}
)");
  const pid_t other = fork();
  if (other == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const SessionRegistration running(runtime_folder(), {"test", 9, file.path(), {"sim"}});
    for (;;) pause();
  }
  while (running_sessions(runtime_folder()).empty()) std::this_thread::yield();

  EXPECT_EQ(run_main({file.path()}, "viz_node"), 0);
  EXPECT_EQ(last_start.domain, 9);
  EXPECT_EQ(run_main({file.path()}, "sim_node"), 1) << "there is one already";
  EXPECT_EQ(run_main({file.path(), "--check"}, "sim_node"), 0) << "which does not run it";
  EXPECT_EQ(run_main({file.path(), "session=other"}, "sim_node"), 0);
  EXPECT_NE(last_start.domain, 9);
  EXPECT_EQ(running_sessions(runtime_folder()).size(), 1u) << "what has ended is not recorded";
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
}

TEST(InstanceLock, IsHeldByOneProcessAtATimeAndLeavesNothing) {
  const std::string name = "cordis/test/lock/" + std::to_string(getpid());
  lock_instance(name, "taken");

  EXPECT_THROW(lock_instance(name, "taken"), std::runtime_error);
  EXPECT_NO_THROW(lock_instance(name + "/other", "taken"));
}

}  // namespace
}  // namespace cordis::node
