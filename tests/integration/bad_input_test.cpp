// tests/integration/bad_input_test.cpp -- bad input ends in one clear message and leaves nothing
// running.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "idl/gesture.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"

namespace cordis::test {
namespace {

using namespace std::chrono_literals;

/// The whole launcher against a scene and a key; what it says, and its exit code.
struct Outcome {
  int code;
  std::string output;
};

/// `cordis check` refuses what a run refuses, with the same words, and nothing else.
void expect_same_judgement(const Outcome& of_run, const std::string& launch_file,
                           std::vector<std::string> words) {
  words.insert(words.begin(), {program_path("cordis"), "check", launch_file});
  ChildProcess process(words);
  const int code = process.wait(kPatience);
  EXPECT_EQ(code == 2, of_run.code == 2) << process.output() << of_run.output;
  std::istringstream lines(process.output());
  for (std::string line; std::getline(lines, line);) {
    if (line.find(": error: ") == std::string::npos) continue;
    EXPECT_NE(of_run.output.find(line), std::string::npos) << line << "\nin\n" << of_run.output;
  }
}

Outcome run(const std::string& scene, const std::string& key,
            const std::vector<std::string>& words = {}) {
  LiveSession session("lockstep", kSimAndKey);
  session.add_file("scene.yaml", scene);
  session.add_file("key.yaml", key);
  ChildProcess& launcher = session.start_launcher(words);
  const int code = launcher.wait(kPatience);
  expect_same_judgement({code, launcher.output()}, session.launch_file(), words);
  return {code, launcher.output()};
}

std::string with(std::string scene, const std::string& old_text, const std::string& new_text) {
  const std::size_t position = scene.find(old_text);
  EXPECT_NE(position, std::string::npos) << old_text;
  return scene.replace(position, old_text.size(), new_text);
}

void expect_bad_file(const Outcome& outcome, const std::string& place, const std::string& what) {
  EXPECT_EQ(outcome.code, 2) << outcome.output;
  EXPECT_NE(outcome.output.find(place), std::string::npos) << "wanted " << place << " in\n"
                                                           << outcome.output;
  EXPECT_NE(outcome.output.find(what), std::string::npos) << "wanted " << what << " in\n"
                                                          << outcome.output;
  EXPECT_EQ(outcome.output.find("terminate called"), std::string::npos) << outcome.output;
}

TEST(BadInput, WrongYamlIsReportedWithItsPlace) {
  expect_bad_file(run(with(wall_scene(1), "[key, ground]", "[key, ground"), steady_key(0, 0)),
                  "scene.yaml:", "error");
}

TEST(BadInput, AnUnknownFileIsReportedByName) {
  LiveSession session("lockstep", kSimAndKey);
  session.add_file("key.yaml", steady_key(0, 0));
  ChildProcess& launcher = session.start_launcher();
  EXPECT_EQ(launcher.wait(kPatience), 2);
  EXPECT_NE(launcher.output().find("scene.yaml"), std::string::npos) << launcher.output();
}

TEST(BadInput, AMissingSceneOfThePageIsReportedWhereItIsListed) {
  const std::string view = "  view: {node: viz_node, port: 0, scenes: [scene.yaml, none.yaml]}\n";
  LiveSession session("lockstep", kSimAndKey + view);
  session.add_file("scene.yaml", wall_scene(1));
  session.add_file("key.yaml", steady_key(0, 0));
  ChildProcess& launcher = session.start_launcher();
  const Outcome outcome{launcher.wait(kPatience), launcher.output()};

  expect_same_judgement(outcome, session.launch_file(), {});
  expect_bad_file(outcome, ":" + std::to_string(view.find("none.yaml") + 1) + ": error:",
                  "none.yaml': No such file");
}

TEST(BadInput, ADomainOutOfRangeIsRefused) {
  expect_bad_file(run(wall_scene(1), steady_key(0, 0), {"domain=233"}), "domain", "101");
}

TEST(BadInput, ADeviceWithTooFewAxesIsReportedAtThePort) {
  expect_bad_file(run(with(wall_scene(1), "axes: [0]", "axes: [3]"), steady_key(0, 0)),
                  "scene.yaml:11:", "wants axis 3 of the device 'keyboard', which has 1 axis");
}

/// What the port needs stands in a line of its own: the twelfth.
std::string demanding(const std::string& scene, const std::string& needs) {
  return with(scene, "at_m: [0]}\nlinks", "at_m: [0],\n    needs: {" + needs + "}}\nlinks");
}

TEST(BadInput, ADeviceWithoutWhatAPortNeedsIsReportedThereWithBothNumbers) {
  const Outcome outcome =
      run(demanding(wall_scene(1), "travel_m: 0.05, force_n: 25"), steady_key(0, 0));
  expect_bad_file(outcome, "scene.yaml:12:12: error:",
                  "needs a travel of 0.05 m, and axis 0 of the device 'keyboard' has 0.04 m");
  expect_bad_file(outcome, "scene.yaml:12:12: error:",
                  "needs a force of 25 N, and axis 0 of the device 'keyboard' has 20 N");
}

TEST(BadInput, ASceneWithoutMatterIsRefused) {
  expect_bad_file(run(R"(cordis: 1
name: empty
space: 1
step: {rate_hz: 1000, integrator: cordis}
)",
                      steady_key(0, 0)),
                  "scene.yaml", "matter");
}

TEST(BadInput, NumbersThatAreNotFiniteAreRefused) {
  for (const std::string bad : {".nan", "nan", ".inf", "1e999"}) {
    expect_bad_file(
        run(with(wall_scene(1), "mass_kg: 1,", "mass_kg: " + bad + ","), steady_key(0, 0)),
        "scene.yaml:9:", "mass_kg");
  }
}

TEST(BadInput, ProblemsOfTheLaunchFileItsSceneAndAllNodesAreReportedAtOnceAndOnce) {
  LiveSession session("lockstep", R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, driver: mouse, travel_cm: 3}
  view: {node: viz_node, port: 80800}
  tape: {node: record_nod}
)",
                      "two words");
  session.add_file("scene.yaml", with(with(wall_scene(1), "mass_kg: 1,", "mass_kg: -1,"),
                                      "kind: spring", "kind: sprung"));
  const std::vector<std::string> wanted{
      "the name of a session is 1 to 64 letters",
      "'node' in node 'tape' must be one of",
      "missing key 'device' in device_node 'keyboard'",
      "must be one of mock, script, replay",
      "unknown key 'travel_cm' in device 'keyboard'",
      "'port' in viz_node 'view' must be between 0 and 65535, got 80800",
      "must be one of spring,",
      "must be > 0, got -1"};
  for (const std::string verb : {"run", "check"}) {
    ChildProcess process({program_path("cordis"), verb, session.launch_file()});
    EXPECT_EQ(process.wait(kPatience), 2) << verb;
    const std::string said = process.output();
    for (const std::string& sentence : wanted) {
      const std::size_t first = said.find(sentence);
      ASSERT_NE(first, std::string::npos) << verb << ": " << sentence << "\nin\n" << said;
      EXPECT_EQ(said.find(sentence, first + 1), std::string::npos) << verb << "\n" << said;
    }
  }
}

TEST(BadInput, AllProblemsOfAllNodesAreReportedAtOnce) {
  const Outcome outcome =
      run(with(wall_scene(1), "kind: spring", "kind: sprung"), "cordis: 1\naxes: 99\n");
  expect_bad_file(outcome, "scene.yaml:6:", "spring");
  expect_bad_file(outcome, "key.yaml:2:", "axes");
}

TEST(BadInput, AProgramReadsWhatTheOtherNodesObjectTo) {
  LiveSession session("lockstep", kSimAndKey);
  session.add_file("scene.yaml", wall_scene(1));
  ChildProcess check({program_path("cordis"), "check", session.launch_file(), "--json", "-"});
  EXPECT_EQ(check.wait(kPatience), 2);
  check.wait_for_end_of_output(kPatience);
  const std::string said = check.output();
  const std::size_t problems = said.find("\"problems\": [");
  ASSERT_NE(problems, std::string::npos) << said;
  const std::size_t sentence = said.find("\"message\": \"cannot be read: ", problems);
  EXPECT_LT(sentence, said.find(']', problems)) << said;
}

/// The lines that name a problem, in order.
std::vector<std::string> problems_in(const std::string& output) {
  std::vector<std::string> problems;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    const bool is_problem = line.find(": error: ") != std::string::npos ||
                            line.find(": warning: ") != std::string::npos;
    if (is_problem) problems.push_back(line);
  }
  std::sort(problems.begin(), problems.end());
  return problems;
}

TEST(BadInput, WhatIsPlayedIsCheckedWithTheWordsOfTheRun) {
  // `cordis run` asks each node in this way before it starts one.
  const auto problem_count = [](const std::string& name) {
    const std::string file = std::string(CORDIS_SOURCE_DIR) + "/launch_configs/" + name + ".yaml";
    ChildProcess check({program_path("cordis"), "check", file});
    EXPECT_EQ(check.wait(kPatience), 0) << check.output();
    ChildProcess sim({program_path("sim_node"), file, "--name", "sim", "--check"});
    EXPECT_EQ(sim.wait(kPatience), 0) << sim.output();
    const std::vector<std::string> problems = problems_in(check.output());
    EXPECT_EQ(problems, problems_in(sim.output()));
    return problems.size();
  };
  EXPECT_EQ(problem_count("plasticine"), 0U);
  EXPECT_EQ(problem_count("hourglass"), 1U) << "not certain";
  EXPECT_EQ(problem_count("bodies_meeting"), 1U) << "too stiff for its hand";
}

TEST(BadInput, ASecondSimOfASessionEndsAndTheFirstGoesOn) {
  LiveSession session("realtime", kSimAndKey);
  session.add_file("scene.yaml", wall_scene(200.0));
  session.add_file("key.yaml", steady_key(0, 0));
  StatusWatch status(session.participant());
  session.start("sim_node", "sim");
  ASSERT_TRUE(status.wait_for(
      "sim", [](const auto& status_message) { return status_message.ticks() > 0; }));

  ChildProcess second({program_path("sim_node"), session.launch_file()});
  EXPECT_EQ(second.wait(kPatience), 1);
  const std::string said = second.output();
  EXPECT_NE(said.find("session 'test' already runs in DDS domain"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_EQ(session.node("sim").wait(0ms), -1) << "the first still runs";
}

TEST(BadInput, ADeviceThatJoinsLateAndCannotBearTheSceneIsGivenNoForce) {
  LiveSession session("realtime", kSimAndKey);
  session.add_file("scene.yaml", demanding(wall_scene(200.0), "travel_m: 0.04, force_n: 20"));
  session.add_file("key.yaml", steady_key(-0.01, 0.0));
  StatusWatch status(session.participant());
  dds::Reader<msg::GestureForces> forces(session.participant(), dds::Topic::kForces);
  session.start("sim_node", "sim");
  ASSERT_TRUE(status.wait_for(
      "sim", [](const auto& status_message) { return status_message.ticks() > 0; }));
  session.add_file("key.yaml", with(steady_key(-0.01, 0.0), "travel_m: 0.04", "travel_m: 0.03") +
                                   "force_limit_n: 15\nstiffness_limit_n_per_m: 150\n");
  session.start("device_node", "keyboard");

  const auto says = [&](const std::string& reason) {
    return status.wait_for("sim", [&](const auto& status_message) {
      return status_message.text().find(reason) != std::string::npos;
    });
  };
  ASSERT_TRUE(says("as stiff as 200 N/m, and the device 'keyboard' supports 150 N/m"));
  EXPECT_TRUE(says("needs a travel of 0.04 m, and axis 0 of the device 'keyboard' has 0.03 m"));
  EXPECT_TRUE(says("needs a force of 20 N, and axis 0 of the device 'keyboard' has 15 N"));
  msg::GestureForces force;
  ASSERT_TRUE(eventually([&] { return forces.take(force) && force.answered_sample() > 500; }));
  EXPECT_EQ(force.force_n()[0], 0.0);
  session.node("keyboard").signal(SIGTERM);
  ASSERT_EQ(session.node("keyboard").wait(kPatience), 0);

  session.add_file("key.yaml", steady_key(-0.01, 0.0) + "stiffness_limit_n_per_m: 250\n");
  session.start("device_node", "keyboard");
  EXPECT_TRUE(
      eventually([&] { return forces.take(force) && std::abs(force.force_n()[0] - 2.0) < 1e-9; }));
}

/// A port of this machine that somebody else has.
class OccupiedPort {
 public:
  OccupiedPort() : listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listener_, 1), 0);
    socklen_t size = sizeof address;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    number_ = std::to_string(ntohs(address.sin_port));
  }
  ~OccupiedPort() { close(listener_); }
  OccupiedPort(const OccupiedPort&) = delete;
  OccupiedPort& operator=(const OccupiedPort&) = delete;

  const std::string& number() const noexcept { return number_; }

 private:
  int listener_;
  std::string number_;
};

TEST(BadInput, AnOccupiedPortLeavesTheForceLoopAlone) {
  const OccupiedPort port;
  LiveSession session("realtime", std::string(kSimAndKey) +
                                      "  view: {node: viz_node, port: " + port.number() + "}\n");
  session.add_file("scene.yaml", wall_scene(200.0));
  session.add_file("key.yaml", steady_key(-0.01, 0.0));
  dds::Reader<msg::GestureForces> forces(session.participant(), dds::Topic::kForces);
  ChildProcess& launcher = session.start_launcher({"--no-color"});
  ASSERT_TRUE(launcher.wait_for_output(port.number(), kPatience)) << "it says so";

  msg::GestureForces force;
  EXPECT_TRUE(eventually([&] {
    return forces.take(force) && std::abs(force.force_n()[0] - 2.0) < 1e-9 &&
           force.answered_sample() > 3000;
  })) << "the key is felt for three seconds";
  launcher.signal(SIGINT);
  EXPECT_EQ(launcher.wait(kPatience), 0);
  EXPECT_NE(launcher.output().find("state hash"), std::string::npos) << "sim_node ended in order";
}

/// K' = 1e9 (1/4000)^2 / 1 = 62: far beyond the limit of 4.
std::string unstable_scene() {
  return with(with(wall_scene(1e9), "[key, ground]", "[bob, ground]"), "at_m: [0.1]",
              "at_m: [0.1], velocity_m_per_s: [1]");
}

TEST(BadInput, AnUnstableSceneIsRefusedAtTheLinkThatSetsItsLimit) {
  const Outcome outcome = run(unstable_scene(), steady_key(0, 0));
  expect_bad_file(outcome, "scene.yaml:13:", "unstable: wall at the mass bob sets the limit");
  expect_bad_file(outcome, "scene.yaml:13:", "sim_node");
}

TEST(BadInput, ADivergingSceneStopsWithTheReasonAndNoForce) {
  LiveSession session("lockstep",
                      R"(  sim: {node: sim_node, scene: scene.yaml, force: true}
  keyboard: {node: device_node, device: key.yaml}
)");
  session.add_file("scene.yaml", unstable_scene());
  session.add_file("key.yaml", steady_key(0, 0));
  session.start("device_node", "keyboard");
  ChildProcess& sim = session.start("sim_node", "sim");

  EXPECT_EQ(sim.wait(kPatience), 1) << sim.output();
  EXPECT_NE(sim.output().find("diverged"), std::string::npos) << sim.output();
  EXPECT_NE(sim.output().find("bob"), std::string::npos) << sim.output();
}

/// A bob on springs that harden with the cube of what they are stretched by, at rest; the key pulls
/// it out 2 cm, where K' is 7: no check can know that.
std::string hardening_scene() {
  return R"(cordis: 1
name: hardening
space: 1
step: {rate_hz: 4000}
liaisons:
  hardening: {elasticity: {kind: power, coefficient: 2.0e+9, exponent: 3}}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 0.01, at_m: [0]}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: [0]}
links:
  - {liaison: hardening, between: [key, bob]}
  - {liaison: hardening, between: [bob, ground]}
)";
}

/// Presses after 10,000 periods, when the reader of the test has long been found.
std::string late_key() {
  return std::string(kScriptedKey) + R"(    - {at_s: 0, m: 0}
    - {at_s: 10, m: 0}
    - {at_s: 10.2, m: -0.02}
)";
}

TEST(BadInput, ASceneThatDivergesAtRunTimeEndsTheSessionWithTheReasonAndNoForce) {
  LiveSession session("lockstep", kSimAndKey);
  session.add_file("scene.yaml", hardening_scene());
  session.add_file("key.yaml", late_key());
  dds::Reader<msg::GestureForces> forces(session.participant(), dds::Topic::kForces);
  ChildProcess& launcher = session.start_launcher({"--no-color"});

  double largest = 0.0;
  double last = 1.0;
  EXPECT_TRUE(eventually([&] {
    const bool ended = launcher.wait(0ms) == 1;
    for (msg::GestureForces force; forces.take(force);) {
      last = force.force_n()[0];
      largest = std::max(largest, std::abs(last));
    }
    return ended && last == 0.0;
  })) << "last force "
      << last;
  const std::string said = launcher.output();
  EXPECT_NE(said.find("the scene diverged at step"), std::string::npos) << said;
  EXPECT_NE(said.find("'bob'"), std::string::npos) << said;
  EXPECT_NE(said.find("its energy is no finite number below 1e100 J"), std::string::npos) << said;
  EXPECT_NE(said.find("hardening ("), std::string::npos) << said;
  EXPECT_NE(said.find("scene.yaml:1"), std::string::npos) << said;
  EXPECT_NE(said.find("sim failed: the scene diverged"), std::string::npos) << said;
  EXPECT_GT(largest, 0.0);
}

}  // namespace
}  // namespace cordis::test
