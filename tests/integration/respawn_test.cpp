// tests/integration/respawn_test.cpp -- any node of a shipped session may be killed while the
// others go on: the launcher starts it again.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "idl/gesture.h"
#include "node/config/launch.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/integration/status_watch.h"
#include "tests/support/rounds.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

using namespace std::chrono_literals;

/// What a page's server at http://127.0.0.1:PORT answers to a GET, or nothing.
std::string get(const std::string& url) {
  const std::size_t colon = url.rfind(':');
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1))));
  const std::string request = "GET / HTTP/1.1\r\nHost: " + url.substr(std::strlen("http://")) +
                              "\r\nConnection: close\r\n\r\n";
  std::string answer;
  const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      write(file, request.data(), request.size()) > 0) {
    char block[4096];
    for (ssize_t count = 0; (count = read(file, block, sizeof block)) > 0;)
      answer.append(block, static_cast<std::size_t>(count));
  }
  close(file);
  return answer;
}

/// `cordis run launch_configs/plucked_string.yaml`, in a domain of the test's own and with any
/// port.
class Respawn : public testing::Test {
 protected:
  Respawn()
      : participant_({own_domain(), "plucked_string", "observer", false, true}),
        status_(participant_),
        forces_(participant_, dds::Topic::kForces),
        launcher_({program_path("cordis"), "run",
                   CORDIS_SOURCE_DIR "/launch_configs/plucked_string.yaml",
                   "domain=" + std::to_string(own_domain()), "view.port=0", "--no-color"}) {}

  ~Respawn() override {
    if (launcher_runs()) {  // in order: a session of this name is refused while nodes of it live
      launcher_.signal(SIGINT);
      launcher_.wait(kPatience);
    }
    if (HasFailure()) std::fprintf(stderr, "---- output\n%s\n", launcher_.output().c_str());
  }

  bool launcher_runs() { return launcher_.wait(0ms) == -1; }

  bool all_run() {
    return status_.wait_for_phase("sim", msg::PHASE_RUNNING) &&
           status_.wait_for_phase("keyboard", msg::PHASE_RUNNING) &&
           status_.wait_for("view", [](const msg::NodeStatus& status) {
             return status.phase() == msg::PHASE_RUNNING && status.text().starts_with("http://");
           });
  }

  /// The key is felt: the living sim_node answers it with a force.
  bool is_felt() {
    msg::GestureForces force;
    while (forces_.take(force)) {
    }
    const std::uint64_t epoch = status_.of("sim").epoch();
    return eventually([&] {
      return forces_.take(force) && force.epoch() == epoch && std::abs(force.force_n()[0]) > 1e-3;
    });
  }

  bool page_answers() { return get(status_.of("view").text()).starts_with("HTTP/1.1 200"); }

  void kill_and_wait_for_the_next_life(const std::string& node) {
    const std::uint64_t old_epoch = status_.of(node).epoch();
    const pid_t process = process_of(launcher_, node);
    ASSERT_GT(process, 0) << node;
    ASSERT_EQ(kill(process, SIGKILL), 0);
    ASSERT_TRUE(launcher_.wait_for_output(node + ": killed by signal 9 (Killed); it starts again",
                                          kPatience));
    ASSERT_TRUE(status_.wait_for(node,
                                 [&](const msg::NodeStatus& status) {
                                   return status.epoch() != old_epoch &&
                                          status.phase() == msg::PHASE_RUNNING;
                                 }))
        << node << " does not run again";
  }

  dds::Participant participant_;
  StatusWatch status_;
  dds::Reader<msg::GestureForces> forces_;
  ChildProcess launcher_;
};

TEST_F(Respawn, OfEachNodeInTurnLeavesTheSessionWhole) {
  ASSERT_TRUE(all_run());
  ASSERT_TRUE(is_felt());
  for (const std::string node : {"sim", "keyboard", "view"}) {
    std::map<std::string, std::uint64_t> runs;
    for (const char* name : {"sim", "keyboard", "view"}) runs[name] = status_.of(name).epoch();

    ASSERT_NO_FATAL_FAILURE(kill_and_wait_for_the_next_life(node));

    ASSERT_TRUE(all_run()) << "after " << node;
    EXPECT_TRUE(is_felt()) << "after " << node;
    EXPECT_TRUE(page_answers()) << "after " << node;
    for (const char* name : {"sim", "keyboard", "view"}) {
      if (name == node) continue;
      EXPECT_EQ(status_.of(name).epoch(), runs[name]) << name << " was disturbed by " << node;
    }
    EXPECT_TRUE(launcher_runs());
  }
  EXPECT_NE(launcher_.output().find("begins at the start of the scene"), std::string::npos);

  launcher_.signal(SIGINT);

  EXPECT_EQ(launcher_.wait(kPatience), 0);
  for (const char* node : {"sim", "keyboard", "view"}) {
    EXPECT_NE(launcher_.output().find(std::string(node) + " was started again 1 time\n"),
              std::string::npos);
  }
}

TEST_F(Respawn, OfAPausedSimGivesNoForceBeforeResume) {
  const auto ctl = [](const std::string& verb) {
    ChildProcess process({program_path("cordis"), "ctl", "plucked_string", "--domain",
                          std::to_string(own_domain()), verb});
    return process.wait(kPatience);
  };
  ASSERT_TRUE(all_run());
  ASSERT_TRUE(is_felt());
  ASSERT_EQ(ctl("pause"), 0);
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_PAUSED));
  const std::uint64_t first = status_.of("sim").sequence_number();
  ASSERT_TRUE(status_.wait_for("sim", [&](const msg::NodeStatus& status) {
    return status.sequence_number() > first + 1;  // the launcher has received one, too
  }));
  const std::uint64_t old_epoch = status_.of("sim").epoch();
  ASSERT_EQ(kill(process_of(launcher_, "sim"), SIGKILL), 0);

  ASSERT_TRUE(status_.wait_for("sim", [&](const msg::NodeStatus& status) {
    return status.epoch() != old_epoch && status.phase() != msg::PHASE_STARTING;
  }));

  EXPECT_EQ(status_.of("sim").phase(), msg::PHASE_PAUSED);
  const std::uint64_t epoch = status_.of("sim").epoch();
  msg::GestureForces force;
  for (int answers = 0; answers < 100;) {
    if (!eventually([&] { return forces_.take(force); })) FAIL() << "no answers";
    if (force.epoch() != epoch) continue;
    ++answers;
    ASSERT_EQ(force.force_n()[0], 0.0) << "answer " << answers;
  }
  EXPECT_NE(launcher_.output().find("it was paused, and stays so until `resume`"),
            std::string::npos);
  ASSERT_EQ(ctl("resume"), 0);
  EXPECT_TRUE(is_felt());
}

/// A sim_node that is killed at the moment in which its reply to `pause` arrives.
TEST_F(Respawn, OfASimThatSaidItIsPausedStaysPaused) {
  dds::Reader<msg::ControlReply> replies(participant_, dds::Topic::kReply);
  ASSERT_TRUE(all_run());
  for (int life = 0; life < rounds(3); ++life) {
    const std::uint64_t old_epoch = status_.of("sim").epoch();
    const pid_t sim = process_of(launcher_, "sim");
    ChildProcess pause({program_path("cordis"), "ctl", "plucked_string", "--domain",
                        std::to_string(own_domain()), "pause"});
    msg::ControlReply reply;
    const auto is_confirmed = [&] {
      return replies.take(reply) && reply.node() == "sim" &&
             reply.text().starts_with("paused at step");
    };
    // Where this reader has not found the sim_node yet, the end of `cordis ctl` stands for the reply.
    while (!is_confirmed() && pause.wait(0ms) == -1) replies.wait(1ms);
    ASSERT_EQ(kill(sim, SIGKILL), 0);
    pause.wait(kPatience);  // its own copy of the reply may be lost with the sim_node

    ASSERT_TRUE(status_.wait_for("sim",
                                 [&](const msg::NodeStatus& status) {
                                   return status.epoch() != old_epoch &&
                                          status.phase() != msg::PHASE_STARTING;
                                 }))
        << "life " << life;
    EXPECT_EQ(status_.of("sim").phase(), msg::PHASE_PAUSED) << "life " << life;
    ChildProcess resume({program_path("cordis"), "ctl", "plucked_string", "--domain",
                         std::to_string(own_domain()), "resume"});
    ASSERT_EQ(resume.wait(kPatience), 0);
    ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
  }
}

config::Launch load(const std::string& path) {
  config::Problems problems;
  config::Launch launch = config::load_launch(path, {}, problems);
  EXPECT_EQ(problems.text(), "") << path;
  return launch;
}

/// The launch files that ship with `clock: realtime`, without `.yaml`. A build that checks
/// preconditions is too slow for the larger scenes: one of each set of nodes.
std::vector<std::string> realtime_sessions() {
  if (rounds(2) == 1) return {"mobile", "plucked_string"};
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(CORDIS_SOURCE_DIR "/launch_configs")) {
    if (entry.path().extension() != ".yaml") continue;
    if (load(entry.path()).clock == config::Clock::kRealtime) names.push_back(entry.path().stem());
  }
  std::ranges::sort(names);
  return names;
}

/// `cordis run` of a launch file that ships.
class ShippedSession : public testing::TestWithParam<std::string> {
 protected:
  ShippedSession()
      : launch_(load(file())),
        participant_({own_domain(), launch_.session, "observer", false, true}),
        status_(participant_),
        launcher_({program_path("cordis"), "run", file(), "domain=" + std::to_string(own_domain()),
                   "view.port=0", "--no-color"}) {}

  ~ShippedSession() override {
    if (HasFailure()) std::fprintf(stderr, "---- output\n%s\n", launcher_.output().c_str());
  }

  static std::string file() { return CORDIS_SOURCE_DIR "/launch_configs/" + GetParam() + ".yaml"; }

  /// True once a life of the node runs that is not the one before. A hot standby stands by, but for
  /// what it plays in between. A scene that plays on without a device runs, too, where a machine
  /// that is taken away answers later than a stiff port permits.
  bool runs(const config::LaunchNode& node, std::uint64_t epoch_before = 0) {
    const bool is_standby = node.section.find("standby_for").exists();
    return status_.wait_for(node.name, [&](const msg::NodeStatus& status) {
      const bool is_too_late = status.phase() == msg::PHASE_WAITING &&
                               status.text().find("It needs an answer within") != std::string::npos;
      return status.epoch() != epoch_before &&
             (is_too_late ||
              status.phase() == (is_standby ? msg::PHASE_STANDBY : msg::PHASE_RUNNING));
    });
  }

  config::Launch launch_;
  dds::Participant participant_;
  StatusWatch status_;
  ChildProcess launcher_;
};

TEST_P(ShippedSession, GoesOnWithoutEachOfItsNodesUntilThatIsBack) {
  for (const config::LaunchNode& node : launch_.nodes) ASSERT_TRUE(runs(node)) << node.name;

  for (const config::LaunchNode& killed : launch_.nodes) {
    std::map<std::string, std::uint64_t> epochs;
    for (const config::LaunchNode& node : launch_.nodes)
      epochs[node.name] = status_.of(node.name).epoch();
    const pid_t process = process_of(launcher_, killed.name);
    ASSERT_GT(process, 0) << killed.name;

    ASSERT_EQ(kill(process, SIGKILL), 0);

    ASSERT_TRUE(runs(killed, epochs[killed.name])) << killed.name << " does not run again";
    for (const config::LaunchNode& node : launch_.nodes) {
      ASSERT_TRUE(runs(node)) << node.name << " after " << killed.name;
      if (node.name == killed.name) continue;
      EXPECT_EQ(status_.of(node.name).epoch(), epochs[node.name])
          << node.name << " was disturbed by " << killed.name;
    }
  }

  launcher_.signal(SIGINT);
  EXPECT_EQ(launcher_.wait(kPatience), 0);
  for (const config::LaunchNode& node : launch_.nodes)
    EXPECT_NE(launcher_.output().find(node.name + " was started again 1 time\n"), std::string::npos)
        << node.name;
}

INSTANTIATE_TEST_SUITE_P(Launch, ShippedSession, testing::ValuesIn(realtime_sessions()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace cordis::test
