// tests/integration/security_test.cpp -- a session with keys: its nodes, and strangers.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/topics.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/security/identity.h"
#include "node/security/keyring.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"
#include "tests/support/filled.h"
#include "tests/support/test_domain.h"
#include "tests/support/two_hosts.h"

namespace cordis::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using node::Role;

constexpr int kDomainOfHosts = 7;  // each host has all domains for itself

struct Ended {
  int code;
  std::string output;
};

/// A folder with a keyring and a launch file that names it, and what a test starts there.
class SecuredFolder {
 public:
  /// @param network  a line of the launch file; empty: one host
  SecuredFolder(const std::string& clock, int domain, const std::string& network = "") {
    std::string name = (fs::temp_directory_path() / "cordis-test-XXXXXX").string();
    folder = mkdtemp(name.data());
    add_file("launch.yaml",
             filled(R"(cordis: 1
session: secured
domain: <domain>
clock: <clock>
security: keys
<network>
nodes:
  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
  view: {node: viz_node, port: 0}
)",
                    {{"domain", std::to_string(domain)}, {"clock", clock}, {"network", network}}));
    add_file("scene.yaml", wall_scene(200.0));
    add_file("key.yaml", steady_key(-0.01, 0.0));
    EXPECT_EQ(ended({"keys", "new", (folder / "keys").string()}).code, 0);
  }
  ~SecuredFolder() {
    for (const auto& process : processes) process->signal(SIGINT);
    for (const auto& process : processes) process->wait(kPatience);
    processes.clear();
    fs::remove_all(folder);
  }
  SecuredFolder(const SecuredFolder&) = delete;
  SecuredFolder& operator=(const SecuredFolder&) = delete;

  void add_file(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
  }
  std::string launch_file() const { return (folder / "launch.yaml").string(); }

  ChildProcess& start(std::vector<std::string> words,
                      const std::map<std::string, std::string>& environment = {}) {
    processes.push_back(std::make_unique<ChildProcess>(words, environment));
    return *processes.back();
  }
  /// Starts `cordis words...`, and waits for its end.
  static Ended ended(std::vector<std::string> words,
                     const std::map<std::string, std::string>& environment = {}) {
    words.insert(words.begin(), program_path("cordis"));
    ChildProcess process(words, environment);
    const int code = process.wait(kPatience);
    process.wait_for_end_of_output(kPatience);
    return {code, process.output()};
  }

  dds::ParticipantConfig member(int domain, const std::string& name, Role role,
                                const std::string& clock = "realtime") const {
    dds::ParticipantConfig config{domain, "secured", name, clock == "lockstep"};
    config.security = node::identity_in(folder / "keys", {role}, "").security;
    return config;
  }

  fs::path folder;
  std::vector<std::unique_ptr<ChildProcess>> processes;
};

class SecuredClock : public ::testing::TestWithParam<const char*> {};

TEST_P(SecuredClock, RunsWithAllNodesAndIsRecorded) {
  SecuredFolder session(GetParam(), own_domain());
  const std::string take = (session.folder / "take.mcap").string();
  ChildProcess& launcher = session.start(
      {program_path("cordis"), "run", session.launch_file(), "--no-color", "--record", take});
  dds::Participant participant(
      session.member(own_domain(), "observer", Role::kController, GetParam()));
  StatusWatch status(participant);

  for (const char* name : {"sim", "keyboard", "view", "record"})
    EXPECT_TRUE(status.wait_for_phase(name, msg::PHASE_RUNNING)) << name;
  const Ended got = SecuredFolder::ended(
      {"ctl", session.launch_file(), "get", "wall.stiffness_n_per_m", "--timeout", "60s"});
  EXPECT_EQ(got.code, 0) << got.output;
  const Ended set = SecuredFolder::ended(
      {"ctl", session.launch_file(), "set", "wall.stiffness_n_per_m=150", "--timeout", "60s"});
  EXPECT_EQ(set.code, 0) << set.output;

  launcher.signal(SIGINT);
  EXPECT_EQ(launcher.wait(kPatience), 0) << launcher.output();
  EXPECT_NE(launcher.output().find(", secured"), std::string::npos) << launcher.output();
  const Ended info = SecuredFolder::ended({"info", take});
  // In real time a machine that stalls for long loses messages, and the take says so.
  const bool lost = info.output.find("messages lost on the way") != std::string::npos;
  EXPECT_EQ(info.code, lost && GetParam() == std::string("realtime") ? 3 : 0) << info.output;
  for (const char* topic : {"gesture/positions", "gesture/forces", "scene/frame", "node/status",
                            "scene/description", "scene/inputs", "device/description"})
    EXPECT_NE(info.output.find(topic), std::string::npos) << topic << "\n" << info.output;
}

INSTANTIATE_TEST_SUITE_P(Both, SecuredClock, ::testing::Values("realtime", "lockstep"),
                         [](const auto& clock) { return std::string(clock.param); });

TEST(SecuredSession, FindsEachNodeAgainThatWasKilledAndKeepsItsTake) {
  SecuredFolder session("realtime", own_domain());
  const std::string take = (session.folder / "take.mcap").string();
  const std::string saved = (session.folder / "saved.mcap").string();
  ChildProcess& launcher = session.start(
      {program_path("cordis"), "run", session.launch_file(), "--no-color", "--record", take});
  dds::Participant participant(session.member(own_domain(), "observer", Role::kController));
  StatusWatch status(participant);
  dds::Reader<msg::GestureForces> forces(participant, dds::Topic::kForces);

  EXPECT_TRUE(eventually([&] {
    std::error_code absent;
    const auto size = fs::file_size(take + ".part", absent);
    return !absent && size > 100'000;
  }));

  for (const char* name : {"record", "sim", "keyboard", "view"}) {
    ASSERT_TRUE(status.wait_for_phase(name, msg::PHASE_RUNNING)) << name;
    const std::uint64_t epoch = status.of(name).epoch();
    kill(process_of(launcher, name), SIGKILL);
    EXPECT_TRUE(status.wait_for(name, [&](const msg::NodeStatus& one) {
      return one.epoch() != epoch && one.phase() == msg::PHASE_RUNNING;
    })) << name;
    EXPECT_TRUE(eventually([&] {
      msg::GestureForces force;
      return forces.take(force) && force.force_n()[0] > 1.9;
    })) << "the wall is felt again after the end of "
        << name;
  }
  const Ended recovered = SecuredFolder::ended({"recover", take + ".part", "--output", saved});
  EXPECT_TRUE(recovered.code == 0 || recovered.code == 3) << recovered.output;
  const Ended info = SecuredFolder::ended({"info", saved});
  EXPECT_EQ(info.code, 0) << info.output;
  for (const char* topic : {"gesture/positions", "gesture/forces", "scene/frame"})
    EXPECT_NE(info.output.find(topic), std::string::npos) << topic << "\n" << info.output;
}

TEST(SecuredSession, PlaysATakeForThoseWithKeysAlone) {
  SecuredFolder session("lockstep", own_domain());
  const std::string keys = (session.folder / "keys").string();
  const std::string take = (session.folder / "take.mcap").string();
  const std::string domain = std::to_string(own_domain());
  const Ended recorded =
      SecuredFolder::ended({"run", session.launch_file(), "--no-color", "--record", take, "--only",
                            "sim,keyboard,record", "--duration", "1s"});
  ASSERT_EQ(recorded.code, 0) << recorded.output;
  ChildProcess& player = session.start({program_path("cordis"), "play", take, "--loop", "--session",
                                        "secured", "--domain", domain, "--security", keys});
  ASSERT_TRUE(player.wait_for_output(", secured", kPatience)) << player.output();

  dds::Participant inside(session.member(own_domain(), "observer", Role::kView));
  dds::Participant outside({own_domain(), "secured", "stranger"});
  dds::Reader<msg::GestureForces> forces(inside, dds::Topic::kForces);
  dds::Reader<msg::GestureForces> stolen(outside, dds::Topic::kForces);
  msg::GestureForces force;
  EXPECT_TRUE(eventually([&] { return forces.take(force); })) << player.output();
  EXPECT_FALSE(stolen.take(force));
  const Ended paused = SecuredFolder::ended({"ctl", "secured", "pause", "--timeout", "60s"});
  EXPECT_EQ(paused.code, 0) << paused.output;
  const Ended none = SecuredFolder::ended({"keys", "add", keys, "screen", "--role", "view", "-o",
                                           (session.folder / "looking").string()});
  ASSERT_EQ(none.code, 0) << none.output;
  const Ended refused = SecuredFolder::ended(
      {"play", take, "--session", "another", "--security", (session.folder / "looking").string()});
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.output.find("which plays no take"), std::string::npos) << refused.output;
}

TEST(SecuredSession, TakesNoPartOfItselfWithoutKeys) {
  SecuredFolder session("realtime", own_domain());
  session.start({program_path("cordis"), "run", session.launch_file(), "--no-color", "--only",
                 "sim,keyboard"});
  dds::Participant participant(session.member(own_domain(), "observer", Role::kController));
  StatusWatch status(participant);
  ASSERT_TRUE(status.wait_for_phase("sim", msg::PHASE_RUNNING));
  session.add_file("open.yaml", filled(R"(cordis: 1
session: secured
domain: <domain>
nodes:
  view: {node: viz_node, port: 0}
)",
                                       {{"domain", std::to_string(own_domain())}}));

  ChildProcess open({program_path("viz_node"), (session.folder / "open.yaml").string()});
  EXPECT_EQ(open.wait(kPatience), 1);
  EXPECT_TRUE(open.wait_for_output("and this part of it has none", kPatience)) << open.output();
  fs::remove(session.folder / "keys" / "view.permissions.p7s");
  ChildProcess broken({program_path("viz_node"), session.launch_file()});
  EXPECT_EQ(broken.wait(kPatience), 1);
  EXPECT_TRUE(broken.wait_for_output("view.permissions.p7s cannot be read", kPatience))
      << broken.output();
}

/// A secured session on the first of two hosts, and strangers on the second.
class SecuredHosts : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string why_not = TwoHosts::why_not();
    if (!why_not.empty()) GTEST_SKIP() << "two hosts are not permitted here: " << why_not;
    hosts_ = std::make_unique<TwoHosts>();
    session_ = std::make_unique<SecuredFolder>("realtime", kDomainOfHosts,
                                               "network: {peers: [192.168.5.1, 192.168.5.2]}");
    launcher_ = &session_->start(
        hosts_->on(TwoHosts::kFirst,
                   {program_path("cordis"), "run", session_->launch_file(), "--no-color"}),
        {{"CORDIS_RUNTIME_DIR", (session_->folder / "host0").string()}});
    hosts_->run_on(TwoHosts::kFirst, [&] {
      inside_ = std::make_unique<dds::Participant>(on_network(
          session_->member(kDomainOfHosts, "observer", Role::kController), TwoHosts::kFirst));
    });
    status_ = std::make_unique<StatusWatch>(*inside_);
    for (const char* name : {"sim", "keyboard", "view"})
      ASSERT_TRUE(status_->wait_for_phase(name, msg::PHASE_RUNNING)) << launcher_->output();
  }
  void TearDown() override {
    if (HasFailure() && launcher_ != nullptr) launcher_->print();
    status_.reset();
    inside_.reset();
    session_.reset();
  }

  static dds::ParticipantConfig on_network(dds::ParticipantConfig config, TwoHosts::Host host) {
    config.network.address = TwoHosts::address(host);
    config.network.peers = {
        TwoHosts::address(host == TwoHosts::kFirst ? TwoHosts::kSecond : TwoHosts::kFirst)};
    return config;
  }

  /// Waits until the session has played for a second more, with its whole force and no restart.
  void expect_that_it_goes_on() {
    const auto epoch_of = [&](const char* name) { return status_->of(name).epoch(); };
    const std::uint64_t sim = epoch_of("sim");
    const std::uint64_t keyboard = epoch_of("keyboard");
    const std::uint64_t ticks = status_->of("keyboard").ticks();
    EXPECT_TRUE(status_->wait_for("keyboard", [&](const msg::NodeStatus& one) {
      return one.phase() == msg::PHASE_RUNNING && one.ticks() > ticks + 2000;
    }));
    EXPECT_EQ(epoch_of("sim"), sim);
    EXPECT_EQ(epoch_of("keyboard"), keyboard);
    EXPECT_EQ(status_->of("sim").phase(), msg::PHASE_RUNNING);
  }

  std::unique_ptr<TwoHosts> hosts_;
  std::unique_ptr<SecuredFolder> session_;
  ChildProcess* launcher_ = nullptr;
  std::unique_ptr<dds::Participant> inside_;
  std::unique_ptr<StatusWatch> status_;
};

TEST_F(SecuredHosts, ShareNothingWithStrangersOfFastDds) {
  node::make_keyring(session_->folder / "others", {});
  dds::ParticipantConfig of_others{kDomainOfHosts, "secured", "stranger"};
  of_others.security = node::identity_in(session_->folder / "others", {Role::kSim}, "").security;
  const dds::ParticipantConfig without{kDomainOfHosts, "secured", "stranger"};

  for (const dds::ParticipantConfig& config : {without, of_others}) {
    hosts_->run_on(TwoHosts::kSecond, [&] {
      dds::Participant stranger(on_network(config, TwoHosts::kSecond));
      dds::Reader<msg::NodeStatus> status(stranger, dds::Topic::kStatus);
      dds::Reader<msg::GesturePositions> positions(stranger, dds::Topic::kPositions);
      dds::Writer<msg::GestureForces> forces(stranger, dds::Topic::kForces);
      expect_that_it_goes_on();
      msg::NodeStatus said;
      EXPECT_FALSE(status.take(said));
      EXPECT_EQ(status.matched_count() + positions.matched_count() + forces.matched_count(), 0);
      for (const dds::FoundWriter& found : stranger.writers())
        EXPECT_EQ(found.topic.name, msg::TOPIC_FORCES) << "its own writer is all that it knows of";
      const bool is_secured = config.security.is_on();
      EXPECT_EQ(stranger.peers().empty(), is_secured) << "announcements alone are in the clear";
    });
    EXPECT_EQ(status_->of("sim").text().find("stranger"), std::string::npos);
  }
}

TEST_F(SecuredHosts, LetAControllerWithAKeyCommandFromElsewhere) {
  const std::string handed = (session_->folder / "handed").string();
  const std::string looking = (session_->folder / "looking").string();
  const std::string keys = (session_->folder / "keys").string();
  ASSERT_EQ(
      SecuredFolder::ended({"keys", "add", keys, "remote", "--role", "controller", "-o", handed})
          .code,
      0);
  ASSERT_EQ(
      SecuredFolder::ended({"keys", "add", keys, "screen", "--role", "view", "-o", looking}).code,
      0);
  const auto ctl = [&](const std::string& folder) {
    ChildProcess process(
        hosts_->on(TwoHosts::kSecond,
                   {program_path("cordis"), "ctl", session_->launch_file(), "set",
                    "wall.stiffness_n_per_m=150", "--timeout", "60s", "--security", folder}),
        {{"CORDIS_RUNTIME_DIR", (session_->folder / "host1").string()}});
    const int code = process.wait(kPatience);
    process.wait_for_end_of_output(kPatience);
    return Ended{code, process.output()};
  };

  const Ended done = ctl(handed);
  EXPECT_EQ(done.code, 0) << done.output;
  const Ended refused = ctl(looking);
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.output.find("which does not command"), std::string::npos) << refused.output;
}

TEST_F(SecuredHosts, SayToAPartWithoutKeysWhatItLacks) {
  session_->add_file("open.yaml", filled(R"(cordis: 1
session: secured
domain: <domain>
network: {peers: [192.168.5.1, 192.168.5.2]}
nodes:
  screen: {node: viz_node, port: 0}
)",
                                         {{"domain", std::to_string(kDomainOfHosts)}}));
  const std::string open = (session_->folder / "open.yaml").string();
  const std::string take = (session_->folder / "elsewhere.mcap").string();
  const std::map<std::string, std::string> environment{
      {"CORDIS_RUNTIME_DIR", (session_->folder / "host1").string()}};
  using Words = std::vector<std::string>;

  for (Words words : {Words{"viz_node", open}, Words{"cordis", "ctl", open, "pause"},
                      Words{"cordis", "get", open, "wall"}, Words{"cordis", "echo", open},
                      Words{"cordis", "record", open, "-o", take}, Words{"cordis", "list", open},
                      Words{"cordis", "info", open}}) {
    words[0] = program_path(words[0]);
    ChildProcess part(hosts_->on(TwoHosts::kSecond, words), environment);
    EXPECT_TRUE(part.wait_for_output("is secured, and this process has no keys", kPatience));
    EXPECT_TRUE(part.wait_for_output("with --security FOLDER", kPatience)) << part.output();
    part.signal(SIGINT);
    part.wait(kPatience);
  }
}

#ifdef CORDIS_CYCLONE_READER
TEST_F(SecuredHosts, ShareNothingWithAStrangerOfCycloneDds) {
  session_->add_file("cyclonedds.xml", R"(<CycloneDDS><Domain Id="any">
<General><Interfaces><NetworkInterface address="192.168.5.2" multicast="false"/></Interfaces><AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>31</MaxAutoParticipantIndex>
<Peers><Peer Address="192.168.5.1"/></Peers></Discovery>
</Domain></CycloneDDS>
)");
  const std::map<std::string, std::string> environment{
      {"CYCLONEDDS_URI", "file://" + (session_->folder / "cyclonedds.xml").string()}};
  ChildProcess stranger(
      hosts_->on(TwoHosts::kSecond, {CORDIS_CYCLONE_READER, std::to_string(kDomainOfHosts),
                                     "secured", std::to_string(msg::WIRE_VERSION)}),
      environment);
  dds::Reader<msg::GesturePositions> positions(*inside_, dds::Topic::kPositions);

  expect_that_it_goes_on();
  EXPECT_EQ(stranger.output(), "") << "it has read a status";
  EXPECT_EQ(stranger.wait(0ms), -1) << "it still tries";
  for (msg::GesturePositions sample; positions.take(sample);)
    EXPECT_NE(sample.device_id(), 1u) << "it has written";
  EXPECT_EQ(status_->of("sim").text().find("wire"), std::string::npos);
}

/// Control of the test above: this program reads and writes a session without keys.
TEST(SecuredHostsOff, AreOpenToAStrangerOfCycloneDds) {
  if (const std::string why_not = TwoHosts::why_not(); !why_not.empty())
    GTEST_SKIP() << "two hosts are not permitted here: " << why_not;
  dds::Participant sim({own_domain(), "secured", "sim"});
  dds::Writer<msg::NodeStatus> writer(sim, dds::Topic::kStatus);
  dds::Reader<msg::GesturePositions> positions(sim, dds::Topic::kPositions);
  msg::NodeStatus status;
  status.node("sim");
  static_cast<void>(writer.write(status));
  ChildProcess stranger({CORDIS_CYCLONE_READER, std::to_string(own_domain()), "secured",
                         std::to_string(msg::WIRE_VERSION)},
                        {{"CYCLONEDDS_URI", "file://" CORDIS_SOURCE_DIR "/idl/cyclonedds.xml"}});

  EXPECT_TRUE(stranger.wait_for_output("sim kind", kPatience));
  EXPECT_TRUE(eventually([&] {
    msg::GesturePositions sample;
    return positions.take(sample) && sample.device_id() == 1;
  }));
}
#endif

}  // namespace
}  // namespace cordis::test
