// tests/integration/network_test.cpp -- one session on two hosts, with a bad cable between them.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "idl/gesture.h"
#include "idl/scene.h"
#include "node/dds/participant_ports.h"
#include "node/dds/reader.h"
#include "node/dds/udp_address.h"
#include "node/dds/writer.h"
#include "node/time.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"
#include "tests/support/filled.h"
#include "tests/support/two_hosts.h"

namespace cordis::test {
namespace {

using namespace std::chrono_literals;

constexpr int kDomain = 7;  // each host has all domains for itself
constexpr double kWatchdog = 0.12;
constexpr double kForceLimit = 5.0;
constexpr double kSlew = 100.0;     // [N/s]
constexpr double kPressed = 2.0;    // the force of the wall, where the key is held [N]
constexpr double kRounding = 1e-6;  // of the trace [N]

/// A folder with the files of a session, and what runs on its two hosts.
class Apart {
 public:
  explicit Apart(const std::string& clock, std::uint64_t seed = 1) : hosts(seed) {
    std::string name = (std::filesystem::temp_directory_path() / "cordis-test-XXXXXX").string();
    folder = mkdtemp(name.data());
    add_file("launch.yaml", filled(R"(cordis: 1
session: apart
domain: <domain>
network: {peers: [192.168.5.1, 192.168.5.2]}
clock: <clock>
nodes:
  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
  view: {node: viz_node, port: 0}
)",
                                   {{"domain", std::to_string(kDomain)}, {"clock", clock}}));
    add_file("scene.yaml", wall_scene(200.0));
    add_file("key.yaml", steady_key(-0.01, 0.0) + "force_limit_n: " + std::to_string(kForceLimit) +
                             "\nslew_limit_n_per_s: " + std::to_string(kSlew) +
                             "\nwatchdog_s: " + std::to_string(kWatchdog) + "\ntrace: {file: " +
                             (folder / "trace.csv").string() + ", last_s: 120}\n");
  }

  ~Apart() {
    for (const auto& process : processes) process->signal(SIGINT);
    for (const auto& process : processes) process->wait(kPatience);
    processes.clear();
    std::filesystem::remove_all(folder);
  }

  void add_file(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
  }
  std::string launch_file() const { return (folder / "launch.yaml").string(); }

  /// Starts `cordis words...` on a host, whose user has a runtime folder of its own there.
  ChildProcess& start(TwoHosts::Host host, std::vector<std::string> words,
                      std::map<std::string, std::string> environment = {}) {
    words.insert(words.begin(), program_path("cordis"));
    environment["CORDIS_RUNTIME_DIR"] = runtime_folder(host);
    processes.push_back(std::make_unique<ChildProcess>(hosts.on(host, words), environment));
    return *processes.back();
  }
  std::string runtime_folder(TwoHosts::Host host) const {
    return (folder / ("host" + std::to_string(host))).string();
  }
  /// Starts a line of a document on a host, in the folder of the sources.
  ChildProcess& start_line(TwoHosts::Host host, const std::string& line) {
    const std::string path = std::string(CORDIS_PROGRAM_DIR) + ":" + getenv("PATH");
    const std::string runtime = (folder / ("host" + std::to_string(host))).string();
    processes.push_back(std::make_unique<ChildProcess>(
        hosts.on(host, {"bash", "-c", "cd " CORDIS_SOURCE_DIR " && exec " + line}),
        std::map<std::string, std::string>{{"CORDIS_RUNTIME_DIR", runtime}, {"PATH", path}}));
    return *processes.back();
  }
  ChildProcess& run(TwoHosts::Host host, const std::string& only,
                    const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", launch_file(), "--no-color", "--only", only};
    words.insert(words.end(), more.begin(), more.end());
    return start(host, words);
  }

  /// A member of the session on a host.
  std::unique_ptr<dds::Participant> observer(TwoHosts::Host host, bool lockstep = false) {
    std::unique_ptr<dds::Participant> participant;
    hosts.run_on(host, [&] {
      dds::ParticipantConfig config{kDomain, "apart", "observer", lockstep};
      config.network.address = TwoHosts::address(host);
      config.network.peers = {
          TwoHosts::address(host == TwoHosts::kFirst ? TwoHosts::kSecond : TwoHosts::kFirst)};
      participant = std::make_unique<dds::Participant>(config);
    });
    return participant;
  }

  TwoHosts hosts;
  std::filesystem::path folder;
  std::vector<std::unique_ptr<ChildProcess>> processes;
};

class Network : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string why_not = TwoHosts::why_not();
    if (!why_not.empty()) GTEST_SKIP() << "two hosts are not permitted here: " << why_not;
  }
};

/// Waits until the key feels the wall with its whole force.
bool feels_the_wall(dds::Reader<msg::GestureForces>& forces) {
  msg::GestureForces force;
  return eventually(
      [&] { return forces.take(force) && std::abs(force.force_n()[0] - kPressed) < 1e-9; });
}

/// Waits until the key has played for a second since it was seen to play. Its start ramp takes 0.2 s.
bool plays_for_a_second(StatusWatch& status) {
  std::optional<std::uint64_t> begun;
  return status.wait_for("keyboard", [&](const msg::NodeStatus& keyboard) {
    if (keyboard.phase() != msg::PHASE_RUNNING)
      begun.reset();
    else if (!begun)
      begun = keyboard.ticks();
    return begun && keyboard.ticks() >= *begun + 1000;
  });
}

struct Row {
  std::int64_t time_nsec = 0;
  double commanded = 0.0;
};

std::vector<Row> read_trace(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    Row row;
    char comma = 0;
    cells >> row.time_nsec >> comma >> row.commanded;
    rows.push_back(row);
  }
  return rows;
}

/// No force moved faster than the slew limit. A row may be late, and its force with it; a decision
/// and its row are less than half a period apart unless the machine takes the core away. A loop that
/// the machine stops for 18 ms restarts from zero force, since its motors may have let go meanwhile. If it
/// stops between a decision and its row, the restart is the next row.
void expect_slew_limit(const std::vector<Row>& rows) {
  constexpr double kPeriod = 1e-3;
  constexpr double kStall = 0.018 - kPeriod;
  double passed_before = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double passed = static_cast<double>(rows[i].time_nsec - rows[i - 1].time_nsec) * 1e-9;
    const bool restarts = passed > kStall || passed_before > kStall;
    passed_before = passed;
    if (restarts && rows[i].commanded == 0.0) continue;
    const double longest = std::max(passed, kPeriod) + 0.5 * kPeriod;
    ASSERT_LE(std::abs(rows[i].commanded - rows[i - 1].commanded), kSlew * longest + kRounding)
        << "row " << i;
  }
}

TEST_F(Network, TwoHostsPlayOneSessionWithEachOthersNodesAndTools) {
  Apart apart("realtime");
  apart.hosts.set({.delay = 200us});
  ChildProcess& first = apart.run(TwoHosts::kFirst, "sim");
  ASSERT_TRUE(first.wait_for_output(
      "no launcher has started keyboard yet: start the rest with `cordis run", kPatience));
  ChildProcess& second = apart.run(TwoHosts::kSecond, "keyboard,view");
  const auto here = apart.observer(TwoHosts::kFirst);
  dds::Reader<msg::GestureForces> forces(*here, dds::Topic::kForces);
  StatusWatch status(*here);

  EXPECT_TRUE(feels_the_wall(forces));
  EXPECT_TRUE(first.wait_for_output("keyboard runs on ", kPatience));
  EXPECT_TRUE(second.wait_for_output("sim runs on ", kPatience));
  EXPECT_NE(
      first.output().find("warning: this session is open to everybody who reaches 192.168.5.1"),
      std::string::npos);
  EXPECT_TRUE(second.wait_for_output("page of view: http://127.0.0.1:", kPatience));
  EXPECT_TRUE(status.wait_for("keyboard", [](const msg::NodeStatus& keyboard) {
    return keyboard.host().ends_with("(192.168.5.2)") && keyboard.link_samples() > 100 &&
           keyboard.latency_p50_s() > 2 * 200e-6;
  })) << "the round trip is that of the cable at least";
  EXPECT_TRUE(status.wait_for("view", [](const msg::NodeStatus& view) {
    return view.phase() == msg::PHASE_RUNNING && view.ticks() > 10;
  })) << "frames come";

  const std::vector<std::string> words{"ctl", apart.launch_file(), "pause"};
  ChildProcess& refused = apart.start(TwoHosts::kSecond, words);
  EXPECT_EQ(refused.wait(kPatience), 2);
  EXPECT_NE(refused.output().find("another key"), std::string::npos) << refused.output();
  const std::string key = apart.runtime_folder(TwoHosts::kFirst) + "/apart.7.key";
  ChildProcess& pause = apart.start(TwoHosts::kSecond, words, {{"CORDIS_SESSION_KEY_FILE", key}});
  EXPECT_EQ(pause.wait(kPatience), 0) << pause.output();
  EXPECT_TRUE(status.wait_for_phase("sim", msg::PHASE_PAUSED));
  ChildProcess& list = apart.start(TwoHosts::kSecond, {"list"});
  EXPECT_EQ(list.wait(kPatience), 0);
  EXPECT_NE(list.output().find("keyboard,view"), std::string::npos) << list.output();
  ChildProcess& of_domain = apart.start(TwoHosts::kSecond, {"list", apart.launch_file()});
  EXPECT_EQ(of_domain.wait(kPatience), 0);
  for (const char* node : {"session 'apart' in DDS domain 7\n", "(192.168.5.1)\n",
                           "(192.168.5.2)\n", "  keyboard ", "  sim ", "  view "}) {
    EXPECT_NE(of_domain.output().find(node), std::string::npos) << of_domain.output();
  }

  second.signal(SIGINT);
  EXPECT_EQ(second.wait(kPatience), 0);
  EXPECT_TRUE(first.wait_for_output("keyboard has ended on ", kPatience));
}

/// The lines of docs/network.md that start a part of a session.
std::vector<std::string> documented_lines() {
  std::vector<std::string> lines;
  std::ifstream document(CORDIS_SOURCE_DIR "/docs/network.md");
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("cordis run ") && line.find(" --only ") != std::string::npos)
      lines.push_back(line);
  }
  return lines;
}

TEST_F(Network, TheExampleOfTheDocumentPlays) {
  const std::vector<std::string> lines = documented_lines();
  ASSERT_EQ(lines.size(), 2u);
  Apart apart("realtime");
  ChildProcess& first = apart.start_line(TwoHosts::kFirst, lines[0]);
  ChildProcess& second = apart.start_line(TwoHosts::kSecond, lines[1]);

  EXPECT_TRUE(first.wait_for_output("keyboard runs on ", kPatience));
  EXPECT_TRUE(first.wait_for_output("view runs on ", kPatience));
  EXPECT_TRUE(second.wait_for_output("sim runs on ", kPatience));
  EXPECT_TRUE(second.wait_for_output("page of view: http://127.0.0.1:8080", kPatience));
  EXPECT_TRUE(second.wait_for_output("role mass in scene 'plucked_string'", kPatience));
  // Headers of IP and UDP take 28 of it. The description of the scene needs more than one.
  EXPECT_LE(apart.hosts.largest(), 1428u) << "a larger datagram is lost with any of its parts";
  EXPECT_GT(apart.hosts.largest(), 1200u);
  for (ChildProcess* part : {&second, &first}) {
    part->signal(SIGINT);
    EXPECT_EQ(part->wait(kPatience), 0);
  }
}

TEST_F(Network, ForcesEndWithinTheWatchdogWhenTheCableIsCutAndComeBackByThemselves) {
  Apart apart("realtime");
  apart.hosts.set({.delay = 2ms, .jitter = 3ms, .loss = 0.1});
  apart.run(TwoHosts::kFirst, "sim");
  ChildProcess& second = apart.run(TwoHosts::kSecond, "keyboard");
  const auto here = apart.observer(TwoHosts::kSecond);
  dds::Reader<msg::GestureForces> forces(*here, dds::Topic::kForces);
  StatusWatch status(*here);
  ASSERT_TRUE(feels_the_wall(forces));
  ASSERT_TRUE(status.wait_for("keyboard", [](const msg::NodeStatus& keyboard) {
    return keyboard.link_unanswered() > 20;
  })) << "losses of the link are counted";

  ASSERT_TRUE(second.wait_for_output("sim runs on ", kPatience));
  ASSERT_TRUE(plays_for_a_second(status));
  apart.hosts.set({.is_cut = true});
  const std::int64_t cut_nsec = node::monotonic_nsec();
  ASSERT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_LOST));
  EXPECT_TRUE(second.wait_for_output("sim: no status for 5 s", kPatience));
  ASSERT_TRUE(eventually([&] { return node::monotonic_nsec() - cut_nsec > 5'000'000'000; }));
  const std::int64_t healed_nsec = node::monotonic_nsec();
  apart.hosts.set({.delay = 2ms, .jitter = 3ms, .loss = 0.1});
  EXPECT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_RUNNING));
  EXPECT_TRUE(second.wait_for_output("sim is back on ", kPatience));
  EXPECT_TRUE(plays_for_a_second(status));
  second.signal(SIGINT);
  EXPECT_EQ(second.wait(kPatience), 0);

  const std::vector<Row> rows = read_trace(apart.folder / "trace.csv");
  ASSERT_GT(rows.size(), 5000u);
  expect_slew_limit(rows);
  // From the watchdog on the force is zero; two periods more for the row and its period.
  const auto silent_nsec = cut_nsec + static_cast<std::int64_t>(kWatchdog * 1e9) + 2'000'000;
  std::size_t zeros = 0;
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].time_nsec < cut_nsec) before = std::max(before, std::abs(rows[i].commanded));
    if (rows[i].time_nsec >= healed_nsec) after = std::max(after, std::abs(rows[i].commanded));
    // The machine may take the core away between a decision and its row.
    if (rows[i - 1].time_nsec < silent_nsec || rows[i].time_nsec >= healed_nsec) continue;
    EXPECT_EQ(rows[i].commanded, 0.0) << "row " << i;
    ++zeros;
  }
  EXPECT_GT(zeros, 1000u);
  EXPECT_NEAR(before, kPressed, 0.01);
  EXPECT_NEAR(after, kPressed, 0.01);
}

TEST_F(Network, ForcesStayWithinTheirLimitsOverASlowAndBadCable) {
  Apart apart("realtime");
  apart.hosts.set({.delay = 20ms, .jitter = 10ms, .loss = 0.3});
  apart.run(TwoHosts::kFirst, "sim");
  ChildProcess& second = apart.run(TwoHosts::kSecond, "keyboard");
  const auto here = apart.observer(TwoHosts::kSecond);
  dds::Reader<msg::GestureForces> forces(*here, dds::Topic::kForces);
  StatusWatch status(*here);
  // Its description may need many attempts on such a cable; until it comes there is no force.
  ASSERT_TRUE(feels_the_wall(forces));
  std::optional<std::uint64_t> begun;
  ASSERT_TRUE(status.wait_for("keyboard", [&begun](const msg::NodeStatus& keyboard) {
    if (!begun) begun = keyboard.link_samples();
    return keyboard.link_samples() > *begun + 3000 && keyboard.latency_p50_s() > 0.040 &&
           keyboard.link_unanswered() > keyboard.link_samples() / 5;
  }));
  second.signal(SIGINT);
  EXPECT_EQ(second.wait(kPatience), 0);

  const std::vector<Row> rows = read_trace(apart.folder / "trace.csv");
  ASSERT_GT(rows.size(), 3000u);
  expect_slew_limit(rows);
  const auto presses = [](const Row& row) { return std::abs(row.commanded) > 1.9; };
  const auto first = std::find_if(rows.begin(), rows.end(), presses);
  EXPECT_GT(std::count_if(first, rows.end(), presses), (rows.end() - first) / 4)
      << "such a link is bad, and not dead";
}

constexpr double kSoftWall = 100.0;  // [N/m]: with 1 N s/m an answer may take 9.5 ms
constexpr const char* kWeakKey =
    R"(viscosity_n_s_per_m: 1
moving_mass_kg: 0.05
force_limit_n: 5
slew_limit_n_per_s: 100
)";
constexpr const char* kTooSlow = "It needs an answer within [0-9]+ us; its answers take [0-9]+ us";

/// A key with known limits before a soft wall, and a trace of what its motor gets.
void play_weak_key(const Apart& apart) {
  apart.add_file("scene.yaml", wall_scene(kSoftWall));
  apart.add_file("key.yaml", steady_key(-0.01, 0.0) + kWeakKey + "watchdog_s: 0.2\ntrace: {file: " +
                                 (apart.folder / "trace.csv").string() + ", last_s: 120}\n");
}

bool says(StatusWatch& status, const std::string& pattern) {
  return status.wait_for("sim", [expression = std::regex(pattern)](const msg::NodeStatus& sim) {
    return std::regex_search(sim.text(), expression);
  });
}

TEST_F(Network, ALinkTooSlowForTheSceneIsReportedBeforeAnyForce) {
  Apart apart("realtime");
  play_weak_key(apart);
  apart.hosts.set({.delay = 10ms});
  ChildProcess& first = apart.run(TwoHosts::kFirst, "sim");
  ChildProcess& second = apart.run(TwoHosts::kSecond, "keyboard");
  const auto here = apart.observer(TwoHosts::kFirst);
  StatusWatch status(*here);

  EXPECT_TRUE(first.wait_for_output(
      "runs on another host: no force until 1000 answers are measured", kPatience));
  EXPECT_TRUE(says(status, kTooSlow));
  second.signal(SIGINT);
  EXPECT_EQ(second.wait(kPatience), 0);

  const std::vector<Row> rows = read_trace(apart.folder / "trace.csv");
  ASSERT_GT(rows.size(), 1000u);
  EXPECT_TRUE(
      std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.commanded == 0.0; }));
}

TEST_F(Network, ALinkThatBecomesTooSlowIsReportedAndItsForceTakenAway) {
  Apart apart("realtime");
  play_weak_key(apart);
  ChildProcess& first = apart.run(TwoHosts::kFirst, "sim");
  ChildProcess& second = apart.run(TwoHosts::kSecond, "keyboard");
  const auto here = apart.observer(TwoHosts::kSecond);
  dds::Reader<msg::GestureForces> forces(*here, dds::Topic::kForces);
  StatusWatch status(*here);
  msg::GestureForces force;
  const auto is_near = [&](double wanted_n) {
    return eventually(
        [&] { return forces.take(force) && std::abs(force.force_n()[0] - wanted_n) < 1e-9; });
  };
  ASSERT_TRUE(is_near(0.01 * kSoftWall)) << "the link is measured, and fast enough";

  apart.hosts.set({.delay = 10ms});
  EXPECT_TRUE(says(status, kTooSlow));
  EXPECT_TRUE(is_near(0.0));
  // Of several reports within 5 s, which may have been there before, one is written whole.
  EXPECT_TRUE(eventually([&] {
    const std::string words = first.output();
    return words.find("of the answers to the device 'keyboard' take at most 2") !=
               std::string::npos ||
           words.find("its answers take 2") != std::string::npos;
  })) << first.output();

  apart.hosts.set({});
  EXPECT_TRUE(is_near(0.01 * kSoftWall)) << "back by itself, after ten calm seconds";
  second.signal(SIGINT);
  EXPECT_EQ(second.wait(kPatience), 0);
  expect_slew_limit(read_trace(apart.folder / "trace.csv"));
}

/// The words that deploy/cordis@.service starts for apart.yaml, of this build, with these words of /etc/cordis/apart.env.
std::vector<std::string> words_of_the_unit(const Apart& apart, const std::string& more) {
  std::ifstream unit(CORDIS_SOURCE_DIR "/deploy/cordis@.service");
  std::string line;
  while (std::getline(unit, line) && !line.starts_with("ExecStart=")) {
  }
  const std::vector<std::pair<std::string, std::string>> replaced{
      {"ExecStart=", ""},
      {"/usr/local/bin/cordis", program_path("cordis")},
      {"/etc/cordis/%i.yaml", apart.launch_file()},
      {"$CORDIS_WORDS", more}};
  for (const auto& [from, to] : replaced) {
    const std::size_t found = line.find(from);
    EXPECT_NE(found, std::string::npos) << from << " is not in " << line;
    if (found != std::string::npos) line.replace(found, from.size(), to);
  }
  std::istringstream words(line);
  return {std::istream_iterator<std::string>(words), {}};
}

/// The first child of a process; 0: it has none.
pid_t child_of(pid_t process) {
  const std::string number = std::to_string(process);
  pid_t child = 0;
  std::ifstream("/proc/" + number + "/task/" + number + "/children") >> child;
  return child;
}

TEST_F(Network, TheUnitOfDeployPlaysWithAContainerOfAnotherHost) {
  Apart apart("realtime");
  const auto environment = [&](TwoHosts::Host host) {
    return std::map<std::string, std::string>{{"CORDIS_RUNTIME_DIR", apart.runtime_folder(host)}};
  };
  ChildProcess too_soon(
      apart.hosts.on(TwoHosts::kFirst,
                     words_of_the_unit(apart, "network.interface=wire1 --only sim")),
      environment(TwoHosts::kFirst));
  EXPECT_NE(too_soon.wait(kPatience), 0)
      << "systemd tries again when its interface is not there yet";

  apart.processes.push_back(std::make_unique<ChildProcess>(
      apart.hosts.on(TwoHosts::kFirst, words_of_the_unit(apart, "--only sim")),
      environment(TwoHosts::kFirst)));
  ChildProcess& service = *apart.processes.back();
  // As podman runs it with the network of the host: processes have numbers of their own there.
  std::vector<std::string> container{"unshare",      "--pid",
                                     "--fork",       "--mount-proc",
                                     "--kill-child", program_path("cordis"),
                                     "run",          apart.launch_file(),
                                     "--no-color",   "--only",
                                     "keyboard"};
  apart.processes.push_back(std::make_unique<ChildProcess>(
      apart.hosts.on(TwoHosts::kSecond, container), environment(TwoHosts::kSecond)));
  ChildProcess& contained = *apart.processes.back();

  EXPECT_TRUE(service.wait_for_output("keyboard runs on ", kPatience));
  EXPECT_TRUE(contained.wait_for_output("role mass in scene 'wall'", kPatience));
  EXPECT_TRUE(contained.wait_for_output("sim runs on ", kPatience));
  service.signal(SIGTERM);  // to the launcher alone, as KillMode=mixed says
  EXPECT_EQ(service.wait(kPatience), 0);
  EXPECT_TRUE(contained.wait_for_output("sim has ended on ", kPatience));
  const pid_t first = child_of(contained.id());
  ASSERT_NE(first, 0);
  kill(first, SIGTERM);  // as podman stops a container: its first process alone
  EXPECT_EQ(contained.wait(kPatience), 0);
}

/// "state hash H after N steps" of a run.
std::string hash_of(const std::string& output) {
  std::smatch match;
  EXPECT_TRUE(
      std::regex_search(output, match, std::regex("state hash [0-9a-f]{16} after [0-9]+ steps")))
      << output;
  return match.str();
}

class NetworkLoss : public Network, public ::testing::WithParamInterface<double> {};

TEST_P(NetworkLoss, ALockstepSessionGivesTheHashThatItGivesOnOneHost) {
  Apart apart("lockstep");
  apart.add_file("key.yaml", R"(cordis: 1
axes: 1
rate_hz: 1000
driver: mock
)");
  ChildProcess& alone = apart.start(
      TwoHosts::kFirst,
      {"run", apart.launch_file(), "--no-color", "--only", "sim,keyboard", "--duration", "100ms"});
  ASSERT_EQ(alone.wait(kPatience), 0);

  apart.hosts.set({.delay = 500us, .jitter = 1ms, .loss = GetParam()});
  ChildProcess& sim = apart.run(TwoHosts::kFirst, "sim", {"--duration", "100ms"});
  apart.run(TwoHosts::kSecond, "keyboard");
  ASSERT_EQ(sim.wait(kPatience), 0);

  EXPECT_EQ(hash_of(sim.output()), hash_of(alone.output()));
  EXPECT_EQ(apart.hosts.lost() > 0, GetParam() > 0.0);
}

/// Minutes long: tests/campaigns/network.sh runs it.
TEST_F(Network, DISABLED_EveryDelayJitterAndLossGivesTheHashOfOneHost) {
  Apart apart("lockstep");
  apart.add_file("key.yaml", R"(cordis: 1
axes: 1
rate_hz: 1000
driver: mock
)");
  ChildProcess& alone = apart.start(
      TwoHosts::kFirst,
      {"run", apart.launch_file(), "--no-color", "--only", "sim,keyboard", "--duration", "50ms"});
  ASSERT_EQ(alone.wait(kPatience), 0);
  const std::string hash = hash_of(alone.output());
  for (const auto delay : {0ms, 5ms, 10ms, 20ms}) {
    for (const double loss : {0.0, 0.1, 0.2, 0.3}) {
      apart.hosts.set({.delay = delay, .jitter = delay / 2, .loss = loss});
      ChildProcess& sim = apart.run(TwoHosts::kFirst, "sim", {"--duration", "50ms"});
      ChildProcess& keyboard = apart.run(TwoHosts::kSecond, "keyboard");
      ASSERT_EQ(sim.wait(kPatience), 0);
      EXPECT_EQ(hash_of(sim.output()), hash) << delay.count() << " ms, loss " << loss;
      keyboard.signal(SIGINT);
      ASSERT_EQ(keyboard.wait(kPatience), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shares, NetworkLoss, ::testing::Values(0.0, 0.1, 0.3));

TEST_F(Network, AProcessOfAnotherHostIsNeverLookedUpHere) {
  Apart apart("realtime");
  const auto here = apart.observer(TwoHosts::kFirst);
  const auto beside = apart.observer(TwoHosts::kSecond);
  apart.run(TwoHosts::kFirst, "sim");
  ChildProcess& second = apart.run(TwoHosts::kSecond, "keyboard");
  const auto prefix_of = [](const dds::Participant& participant, const std::string& name) {
    for (const dds::Peer& peer : participant.peers()) {
      if (peer.name == name) return peer.prefix;
    }
    return dds::ParticipantPrefix{};
  };
  const auto knows = [](const dds::Participant& participant, const dds::ParticipantPrefix& one) {
    const std::vector<dds::Peer> peers = participant.peers();
    return std::any_of(peers.begin(), peers.end(),
                       [&](const dds::Peer& peer) { return peer.prefix == one; });
  };
  dds::ParticipantPrefix killed{};
  ASSERT_TRUE(eventually([&] {
    killed = prefix_of(*here, "apart/keyboard");
    return killed != dds::ParticipantPrefix{} && knows(*beside, killed) &&
           prefix_of(*beside, "apart/sim") != dds::ParticipantPrefix{};
  }));
  EXPECT_TRUE(here->has_peers_elsewhere());

  // The hosts of this test share their processes: whoever looked would see that it has ended.
  const pid_t keyboard = process_of(second, "keyboard");
  ASSERT_NE(keyboard, 0);
  kill(keyboard, SIGKILL);
  EXPECT_TRUE(eventually([&] { return !knows(*beside, killed); }))
      << "on its own host it is looked up";
  for (const dds::Peer& peer : here->peers()) {
    const bool is_of_sim = peer.name.starts_with("apart/sim");
    const bool is_of_keyboard = peer.name.starts_with("apart/keyboard");
    if (is_of_sim || is_of_keyboard) {
      EXPECT_EQ(peer.is_here(), is_of_sim) << peer.name;
    }
  }
  EXPECT_TRUE(knows(*here, killed)) << "elsewhere only its own farewell counts";

  // The launcher starts it again, and all find it.
  StatusWatch status(*here);
  EXPECT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_RUNNING));
  EXPECT_EQ(here->rejoin_count(), 0u);
}

TEST_F(Network, AHostThatWasDroppedIsFoundAgain) {
  Apart apart("realtime");
  const auto here = apart.observer(TwoHosts::kFirst);
  const auto there = apart.observer(TwoHosts::kSecond);
  dds::Writer<msg::SceneDescription> scene(*there, dds::Topic::kDescription);
  dds::Reader<msg::SceneDescription> scenes(*here, dds::Topic::kDescription);
  msg::SceneDescription description;
  description.name("said once");
  ASSERT_TRUE(scene.write(description));
  ASSERT_TRUE(eventually([&] { return scenes.take(description); }));

  apart.hosts.run_on(TwoHosts::kFirst, [&] { here->drop(here->peers().at(0)); });
  EXPECT_TRUE(eventually([&] { return here->rejoin_count() > 0; }));

  EXPECT_TRUE(eventually([&] { return scenes.take(description); }));
  EXPECT_EQ(there->rejoin_count(), 0u);
}

/// Two members of a session that find each other by the network alone, each on its host.
struct Members {
  std::unique_ptr<dds::Participant> first;
  std::unique_ptr<dds::Participant> second;
};

Members members(const TwoHosts& hosts, const std::function<void(dds::Network&)>& change) {
  Members members;
  for (const TwoHosts::Host host : {TwoHosts::kFirst, TwoHosts::kSecond}) {
    hosts.run_on(host, [&] {
      dds::ParticipantConfig config{kDomain, "apart", "member " + std::to_string(host)};
      config.network.address = TwoHosts::address(host);
      change(config.network);
      (host == TwoHosts::kFirst ? members.first : members.second) =
          std::make_unique<dds::Participant>(config);
    });
  }
  return members;
}

bool receives(dds::Reader<msg::SceneDescription>& reader, const std::string& name) {
  msg::SceneDescription description;
  return eventually([&] { return reader.take(description) && description.name() == name; });
}

TEST_F(Network, MulticastFindsTheOtherHostWithoutItsAddress) {
  const TwoHosts hosts;
  const Members by_multicast =
      members(hosts, [](dds::Network& network) { network.multicast = true; });

  EXPECT_TRUE(eventually([&] {
    return by_multicast.first->has_peers_elsewhere() && by_multicast.second->has_peers_elsewhere();
  }));
}

TEST_F(Network, ADiscoveryServerMakesThemKnownToEachOther) {
  if (std::system("command -v fast-discovery-server >/dev/null") != 0)
    GTEST_SKIP() << "fast-discovery-server (package fastdds-tools) is not installed";
  Apart apart("realtime");
  const ChildProcess server(apart.hosts.on(
      TwoHosts::kSecond, {"fast-discovery-server", "-i", "0", "-l", "192.168.5.2", "-p", "11811"}));

  ChildProcess& part =
      apart.start(TwoHosts::kFirst,
                  {"run", apart.launch_file(), "--no-color",
                   "network={discovery_server: '192.168.5.2:11811'}", "--only", "sim,keyboard"});

  ASSERT_TRUE(part.wait_for_output("role mass in scene 'wall'", kPatience));
  const pid_t keyboard = process_of(part, "keyboard");
  ASSERT_NE(keyboard, 0);
  kill(keyboard, SIGKILL);
  EXPECT_TRUE(eventually([&] {
    const std::string output = part.output();
    return output.find("role mass", output.find("it starts again in")) != std::string::npos;
  })) << "it is found again";
}

/// Minutes long: tests/campaigns/network.sh runs it.
TEST_F(Network, DISABLED_AHostThatIsSilentForLongIsForgottenAndFoundAgain) {
  TwoHosts hosts;
  const Members both = members(hosts, [](dds::Network& network) {
    network.peers = {TwoHosts::address(TwoHosts::kFirst), TwoHosts::address(TwoHosts::kSecond)};
    std::erase(network.peers, network.address);
  });
  dds::Writer<msg::SceneDescription> scene(*both.first, dds::Topic::kDescription);
  dds::Reader<msg::SceneDescription> scenes(*both.second, dds::Topic::kDescription);
  msg::SceneDescription description;
  description.name("before");
  ASSERT_TRUE(scene.write(description));
  ASSERT_TRUE(receives(scenes, "before"));

  hosts.set({.is_cut = true});
  const auto cut = std::chrono::steady_clock::now();
  EXPECT_TRUE(
      eventually([&] { return both.first->peers().empty() && both.second->peers().empty(); }));
  EXPECT_GT(std::chrono::steady_clock::now() - cut, 50s) << "no short silence ends a session";
  description.name("meanwhile");
  EXPECT_TRUE(scene.write(description));
  hosts.set({});

  EXPECT_TRUE(receives(scenes, "meanwhile")) << "kept for late joiners";
  EXPECT_TRUE(both.first->has_peers_elsewhere());
  description.name("after");
  EXPECT_TRUE(scene.write(description));
  EXPECT_TRUE(receives(scenes, "after"));
}

TEST_F(Network, NoDatagramOfTheNetworkReachesASessionOfOneHost) {
  Apart apart("realtime");
  std::unique_ptr<dds::Participant> loopback;
  apart.hosts.run_on(TwoHosts::kFirst, [&] {
    loopback =
        std::make_unique<dds::Participant>(dds::ParticipantConfig{kDomain, "apart", "loopback"});
  });
  const auto there = apart.observer(TwoHosts::kSecond);
  // A whole RTPS header with a byte too many ends a process that receives it.
  const std::string fatal = std::string("RTPS\x02\x03\x01\x0f", 8) + std::string(12, '\1') + "x";

  apart.hosts.run_on(TwoHosts::kSecond, [&] {
    const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    for (int index = 0; index < 2 * dds::pair_count(true); ++index) {
      const sockaddr_in address =
          dds::udp_address(static_cast<std::uint16_t>(dds::discovery_port(kDomain, 0) + index),
                           dds::ipv4_of(TwoHosts::address(TwoHosts::kFirst)));
      sendto(file, fatal.data(), fatal.size(), 0, reinterpret_cast<const sockaddr*>(&address),
             sizeof address);
    }
    close(file);
  });
  ASSERT_TRUE(eventually([&] { return apart.hosts.passed() >= 2 * dds::pair_count(true); }));

  EXPECT_TRUE(loopback->peers().empty());
}

}  // namespace
}  // namespace cordis::test
