// tests/integration/command_key_test.cpp -- a session that a launcher has begun takes commands of
// whoever has its key.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "idl/control.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/runtime_folder.h"
#include "node/session_key.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code;
  std::string output;
};

/// `cordis run` with a scene and a hand, and somebody who speaks DDS in its domain.
class CommandKey : public ::testing::Test {
 protected:
  CommandKey()
      : session_("realtime", kSimAndKey),
        status_(session_.participant()),
        commands_(session_.participant(), dds::Topic::kCommand),
        replies_(session_.participant(), dds::Topic::kReply),
        seen_(session_.participant(), dds::Topic::kCommand) {
    session_.add_file("scene.yaml", wall_scene(200.0));
    session_.add_file("stiff.yaml", wall_scene(400.0));
    session_.add_file("key.yaml", steady_key(-0.01, 0.0));
    fs::create_directory(strange_folder());
    fs::permissions(strange_folder(), fs::perms::owner_all);
  }

  void start() {
    launcher_ = &session_.start_launcher();
    ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
    ASSERT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING));
    ASSERT_TRUE(eventually([this] { return commands_.matched_count() >= 2; }));
  }

  /// The registry of a user who has no session here.
  fs::path strange_folder() const { return session_.folder() / "stranger"; }
  static fs::path key_file() {
    return node::registered_key_file(node::runtime_folder(), "test", own_domain());
  }

  Outcome ctl(const std::vector<std::string>& words,
              const std::map<std::string, std::string>& environment = {}) const {
    std::vector<std::string> command{
        program_path("cordis"),      "ctl", session_.launch_file(), "--timeout", "60s", "--domain",
        std::to_string(own_domain())};
    command.insert(command.end(), words.begin(), words.end());
    ChildProcess process(command, environment);
    const int code = process.wait(kPatience);
    return {code, process.output()};
  }

  /// What the scene answers to a message, sent as it stands until it is answered.
  msg::ControlReply answer_to(msg::ControlCommand command) {
    msg::ControlReply reply;
    const bool answered = eventually([&] {
      EXPECT_TRUE(commands_.write(command));
      return replies_.wait(std::chrono::milliseconds(300)),
             replies_.take(reply) && reply.command_id() == command.command_id() &&
                 reply.node() == "sim";
    });
    EXPECT_TRUE(answered) << command.argument();
    return reply;
  }

  std::string stiffness() const { return ctl({"get", "wall.stiffness_n_per_m"}).output; }

  LiveSession session_;
  StatusWatch status_;
  dds::Writer<msg::ControlCommand> commands_;
  dds::Reader<msg::ControlReply> replies_;
  dds::Reader<msg::ControlCommand> seen_;
  ChildProcess* launcher_ = nullptr;
};

TEST_F(CommandKey, LacksAStrangerWhoseCommandsChangeNothing) {
  start();
  const std::string before = stiffness();
  EXPECT_NE(before.find("wall.stiffness_n_per_m = 200"), std::string::npos) << before;
  const std::vector<std::pair<msg::ControlVerb, std::string>> wanted{
      {msg::VERB_LOAD, "'stiff.yaml'"},
      {msg::VERB_SET, "{wall.stiffness_n_per_m: 100}"},
      {msg::VERB_PAUSE, ""},
      {msg::VERB_STEP, "5"},
      {msg::VERB_RESET, ""},
      {msg::VERB_STATE, "[wall, free]"}};
  std::uint64_t id = 0;
  for (const auto& [verb, argument] : wanted) {
    msg::ControlCommand command;
    command.command_id(++id);
    command.sender("stranger");
    command.target("sim_node");
    command.verb(verb);
    command.argument(argument);
    const msg::ControlReply reply = answer_to(command);
    EXPECT_FALSE(reply.accepted()) << reply.text();
    EXPECT_NE(reply.text().find("commands of its own user alone"), std::string::npos)
        << reply.text();
  }
  EXPECT_EQ(stiffness(), before);
  EXPECT_EQ(status_.of("sim").phase(), msg::PHASE_RUNNING);
  EXPECT_EQ(launcher_->wait(std::chrono::milliseconds(0)), -1) << "the session goes on";
}

TEST_F(CommandKey, IsReadByCtlOfItsUserAndOfWhoHasACopy) {
  start();
  struct stat found {};
  ASSERT_EQ(stat(key_file().c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 07777, static_cast<mode_t>(0600));
  EXPECT_EQ(ctl({"set", "wall.stiffness_n_per_m=150"}).code, 0);
  EXPECT_NE(stiffness().find("= 150"), std::string::npos);

  std::map<std::string, std::string> stranger{{"CORDIS_RUNTIME_DIR", strange_folder()}};
  const Outcome refused = ctl({"set", "wall.stiffness_n_per_m=160"}, stranger);
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.output.find("CORDIS_SESSION_KEY_FILE"), std::string::npos) << refused.output;

  const fs::path copy = strange_folder() / "key";
  stranger["CORDIS_SESSION_KEY_FILE"] = copy;
  node::write_key_file(copy, node::SessionKey::random());
  const Outcome other = ctl({"set", "wall.stiffness_n_per_m=160"}, stranger);
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.output.find("another key"), std::string::npos) << other.output;
  EXPECT_NE(stiffness().find("= 150"), std::string::npos);

  node::write_key_file(copy, node::read_key_file(key_file()));
  EXPECT_EQ(ctl({"set", "wall.stiffness_n_per_m=160"}, stranger).code, 0);
  EXPECT_NE(stiffness().find("= 160"), std::string::npos);

  fs::permissions(copy, fs::perms::others_read, fs::perm_options::add);
  const Outcome open = ctl({"pause"}, stranger);
  EXPECT_NE(open.code, 0);
  EXPECT_NE(open.output.find("chmod 600"), std::string::npos) << open.output;

  launcher_->signal(SIGINT);
  EXPECT_EQ(launcher_->wait(kPatience), 0);
  EXPECT_FALSE(fs::exists(key_file())) << "it ends with the session";
}

TEST_F(CommandKey, MakesNoCommandWorkTwice) {
  start();
  msg::ControlCommand pause;
  // A program that ends at once may have gone before another reader has found it.
  ASSERT_TRUE(eventually([&] {
    EXPECT_EQ(ctl({"pause"}).code, 0);
    return seen_.take(pause) && pause.verb() == msg::VERB_PAUSE;
  })) << "whoever takes part in the session reads it";
  EXPECT_FALSE(pause.authenticators().empty());
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_PAUSED));
  ASSERT_EQ(ctl({"resume"}).code, 0);
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));

  static_cast<void>(answer_to(pause));
  pause.command_id(pause.command_id() + 1);
  EXPECT_FALSE(answer_to(pause).accepted()) << "nor does a change of it";
  pause.command_id(pause.command_id() - 1);

  const std::uint64_t epoch = status_.of("sim").epoch();
  ASSERT_EQ(kill(process_of(*launcher_, "sim"), SIGKILL), 0);
  ASSERT_TRUE(status_.wait_for("sim", [&](const msg::NodeStatus& sim) {
    return sim.epoch() != epoch && sim.phase() == msg::PHASE_RUNNING;
  }));
  ASSERT_TRUE(eventually([this] { return commands_.matched_count() >= 2; }));
  EXPECT_TRUE(commands_.write(pause));
  msg::ControlCommand marker;  // whatever comes before it has been evaluated when it is answered
  marker.command_id(1);
  marker.sender("marker");
  marker.target("sim_node");
  marker.verb(msg::VERB_GET);
  marker.argument("[wall]");
  EXPECT_TRUE(answer_to(marker).accepted());
  EXPECT_NE(stiffness().find("wall.stiffness_n_per_m"), std::string::npos);
  EXPECT_EQ(status_.of("sim").phase(), msg::PHASE_RUNNING) << "nor in the next life of the node";
  EXPECT_NE(ctl({"resume"}).output.find("was running already"), std::string::npos);
}

}  // namespace
}  // namespace cordis::test
