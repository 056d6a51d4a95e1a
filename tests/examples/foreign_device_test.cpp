// tests/examples/foreign_device_test.cpp -- the programs of examples/foreign_device before real
// nodes.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "tests/integration/live_session.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

constexpr const char* kSimAlone = "  sim: {node: sim_node, scene: scene.yaml}\n";

constexpr const char* kExample = CORDIS_SOURCE_DIR "/examples/foreign_device/";

std::string mass_scene() {
  std::ifstream file(std::string(kExample) + "scene.yaml");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A scene like it, with a key of role liaison.
std::string liaison_scene() {
  const std::string role = "role: mass, coupling: direct";
  std::string scene = mass_scene();
  return scene.replace(scene.find(role), role.size(), "role: liaison, mass_kg: 0.1");
}

/// The hand of examples/foreign_device/device.c, for device_node.
constexpr const char* kSameHand = R"(cordis: 1
axes: 1
travel_m: 0.04
rest: top
rate_hz: 1000
driver: script
script:
  interpolation: linear
  positions:
    - {at_s: 0, m: 0}
    - {at_s: 0.2, m: -0.005}
  forces:
    - {at_s: 0, n: 0}
    - {at_s: 0.2, n: -1}
)";

const std::map<std::string, std::string> kLoopback{
    {"CYCLONEDDS_URI", "file://" CORDIS_SOURCE_DIR "/idl/cyclonedds.xml"}};

/// A program of the example in the session of a test.
std::unique_ptr<ChildProcess> start_foreign(const std::string& program,
                                            const std::vector<std::string>& words,
                                            const std::string& session = "test") {
  std::vector<std::string> command{program_path(program), std::to_string(own_domain()), session};
  command.insert(command.end(), words.begin(), words.end());
  return std::make_unique<ChildProcess>(command, kLoopback);
}

int end(ChildProcess& program) {
  program.signal(SIGTERM);
  return program.wait(kPatience);
}

std::string match_in(const std::string& text, const std::string& pattern) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : std::string();
}

double number_in(const std::string& text, const std::string& pattern) {
  const std::string number = match_in(text, pattern);
  return number.empty() ? std::nan("") : std::stod(number);
}

std::string hash_of_a_run(const std::string& scene, bool foreign) {
  const char* kDevice = "  keyboard: {node: device_node, device: key.yaml}\n";
  LiveSession session("lockstep", std::string(kSimAlone) + (foreign ? "" : kDevice));
  session.add_file("scene.yaml", scene);
  session.add_file("key.yaml", kSameHand);
  ChildProcess& launcher = session.start_launcher({"--duration", "1s"});
  std::unique_ptr<ChildProcess> device;
  if (foreign) device = start_foreign("foreign_device", {"keyboard", "--lockstep"});
  EXPECT_EQ(launcher.wait(kPatience), 0);
  EXPECT_TRUE(!foreign || end(*device) == 0);
  return match_in(launcher.output(), "(state hash [0-9a-f]{16} after 4000 steps)");
}

TEST(ForeignDevice, GivesTheStateOfOurOwnDeviceInLockstep) {
  for (const std::string& scene : {mass_scene(), liaison_scene()}) {
    const std::string own = hash_of_a_run(scene, false);
    EXPECT_NE(own, "");
    EXPECT_EQ(hash_of_a_run(scene, true), own);
  }
}

TEST(ForeignDevice, FeelsTheSpringThatItPressesInTheSessionOfTheExample) {
  dds::Participant observer({.domain = own_domain(), .session = "foreign", .node = "observer"});
  dds::Reader<msg::GestureForces> forces(observer, dds::Topic::kForces);
  ChildProcess launcher({program_path("cordis"), "run", std::string(kExample) + "launch.yaml",
                         "domain=" + std::to_string(own_domain())});
  const auto device = start_foreign("foreign_device", {"keyboard"}, "foreign");

  // Two springs of 200 N/m in series, pressed by 5 mm.
  msg::GestureForces force;
  EXPECT_TRUE(eventually([&] {
    return forces.take(force) && std::abs(force.force_n()[0] - 0.5) < 1e-6;
  })) << force.force_n()[0];
  EXPECT_EQ(end(*device), 0);
  EXPECT_EQ(end(launcher), 0);
  const double largest = number_in(device->output(), "largest force (\\S+) N");
  EXPECT_GT(largest, 0.4);
  EXPECT_LE(largest, 10.0) << "its limit";
}

TEST(ForeignDevice, IsLedByTheMassThatItPushesInRealtime) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", liaison_scene());
  dds::Reader<msg::GesturePositions> positions(session.participant(), dds::Topic::kPositions);
  session.start("sim_node", "sim");
  const auto device = start_foreign("foreign_device", {"keyboard"});

  // The device runs at ordinary priority. Where the machine stops it for 20 ms again and again, it
  // lets go each time: it is led then, but the mass does not come to rest.
  const auto has_let_go = [&] { return device->output().find("no force") != std::string::npos; };
  msg::GesturePositions position;
  int at_rest = 0;  // positions in a row, for it swings through the place at first
  EXPECT_TRUE(eventually([&] {
    if (!positions.take(position)) return false;
    at_rest = std::abs(position.position_m()[0] + 0.01) < 1e-6 ? at_rest + 1 : 0;
    return at_rest > 100 || (has_let_go() && position.position_m()[0] < -0.002);
  })) << position.position_m()[0];
  EXPECT_EQ(end(*device), 0);
  const double last_m = number_in(device->output(), "last position (\\S+) m");
  if (has_let_go()) {
    EXPECT_LT(last_m, 0.0);
  } else {
    EXPECT_NEAR(last_m, -0.01, 1e-5);
  }
}

class ForeignClock : public ::testing::TestWithParam<const char*> {
 protected:
  static std::vector<std::string> words() {
    if (GetParam() == std::string("lockstep")) return {"keyboard", "--lockstep"};
    return {"keyboard"};
  }
};

TEST_P(ForeignClock, TakesTheForceAwayWhenTheSceneDiesAndGoesOnWithTheNextOne) {
  LiveSession session(GetParam(), kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  session.start("sim_node", "sim");
  const auto device = start_foreign("foreign_device", words());
  ASSERT_TRUE(device->wait_for_output("answers come\n", kPatience));

  session.node("sim").signal(SIGKILL);
  EXPECT_TRUE(device->wait_for_output("no answer for 20 ms: no force\n", kPatience));
  EXPECT_EQ(session.node("sim").wait(kPatience), 128 + SIGKILL);

  session.start("sim_node", "sim");
  EXPECT_TRUE(eventually([&] {
    const std::string output = device->output();
    return output.rfind("answers come\n") > output.rfind("no force\n");
  }));
  EXPECT_EQ(end(*device), 0);
}

TEST_P(ForeignClock, TakesTheRoleOfTheNextScene) {
  LiveSession session(GetParam(), kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  session.add_file("next.yaml", liaison_scene());
  session.start("sim_node", "sim");
  const auto device = start_foreign("foreign_device", words());
  ASSERT_TRUE(device->wait_for_output("answers come\n", kPatience));

  const auto command =
      start_foreign("foreign_command", {"sim", "load", (session.folder() / "next.yaml").string()});
  EXPECT_EQ(command->wait(kPatience), 0) << command->output();
  EXPECT_TRUE(device->wait_for_output("in role liaison\nanswers come\n", kPatience));
  EXPECT_EQ(end(*device), 0);
}

TEST_P(ForeignClock, OfTheOtherClockEndsAndSaysSo) {
  LiveSession session(GetParam(), kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  session.start("sim_node", "sim");
  const bool lockstep = GetParam() == std::string("lockstep");
  const auto device = start_foreign("foreign_device",
                                    lockstep ? std::vector<std::string>{"keyboard"}
                                             : std::vector<std::string>{"keyboard", "--lockstep"});
  EXPECT_EQ(device->wait(kPatience), 1);
  EXPECT_NE(device->output().find("error: the session runs in " + std::string(GetParam()) +
                                  ": start this device " + (lockstep ? "with" : "without") +
                                  " --lockstep"),
            std::string::npos)
      << device->output();
}

INSTANTIATE_TEST_SUITE_P(Clocks, ForeignClock, ::testing::Values("realtime", "lockstep"),
                         [](const auto& clock) { return std::string(clock.param); });

TEST(ForeignDevice, BesideAHotStandbyEndsAndSaysSo) {
  LiveSession session("realtime", std::string(kSimAlone) +
                                      R"(  keyboard: {node: device_node, device: key.yaml}
  spare: {node: device_node, device: key.yaml, standby_for: keyboard}
)");
  session.add_file("scene.yaml", mass_scene());
  session.add_file("key.yaml", kSameHand);
  session.start("sim_node", "sim");
  const auto device = start_foreign("foreign_device", {"keyboard"});
  EXPECT_EQ(device->wait(kPatience), 1);
  EXPECT_NE(device->output().find("error: the session has a hot standby"), std::string::npos)
      << device->output();
}

/// Answers every sample of the device with this force, as if it were the scene.
class HostileScene {
 public:
  explicit HostileScene(dds::Participant& participant)
      : samples_(participant, dds::Topic::kPositions), forces_(participant, dds::Topic::kForces) {}

  /// @param later_nsec  added to the time of the sample that is answered
  void answer(double force_n, std::int64_t later_nsec = 0) {
    msg::GesturePositions sample;
    while (samples_.take(sample)) {
      msg::GestureForces forces;
      forces.device_id(sample.device_id());
      forces.epoch(1);
      forces.sample(++sample_);
      forces.time_nsec(sample.time_nsec());
      forces.answered_epoch(sample.epoch());
      forces.answered_sample(sample.sample());
      forces.answered_time_nsec(later_nsec < 0 ? std::numeric_limits<std::int64_t>::min()
                                               : sample.time_nsec() + later_nsec);
      forces.axis_count(1);
      forces.force_n().fill(force_n);
      static_cast<void>(forces_.write(forces));
    }
  }

 private:
  dds::Reader<msg::GesturePositions> samples_;
  dds::Writer<msg::GestureForces> forces_;
  std::uint64_t sample_ = 0;
};

TEST(ForeignDevice, GivesNoForceBeyondItsLimitAndNoneForAnAnswerThatIsNoNumber) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  session.start("sim_node", "sim");
  const auto device = start_foreign("foreign_device", {"keyboard"});
  ASSERT_TRUE(device->wait_for_output("answers come\n", kPatience));
  HostileScene hostile(session.participant());
  session.node("sim").signal(SIGSTOP);
  ASSERT_TRUE(device->wait_for_output("no force\n", kPatience));

  const auto count_of = [&](const std::string& line) {
    const std::string output = device->output();
    std::size_t count = 0;
    for (auto position = output.find(line); position != std::string::npos;
         position = output.find(line, position + 1))
      ++count;
    return count;
  };
  // Times of no clock and no numbers are worth no force.
  const auto begun = std::chrono::steady_clock::now();
  const std::size_t before = count_of("answers come\n");
  EXPECT_TRUE(eventually([&] {
    hostile.answer(1.0, 3'600'000'000'000);
    return std::chrono::steady_clock::now() - begun > std::chrono::milliseconds(300);
  }));
  EXPECT_TRUE(eventually([&] {
    hostile.answer(1.0, -1);
    return std::chrono::steady_clock::now() - begun > std::chrono::milliseconds(600);
  }));
  EXPECT_TRUE(eventually([&] {
    hostile.answer(std::nan(""));
    return std::chrono::steady_clock::now() - begun > std::chrono::milliseconds(900);
  }));
  EXPECT_EQ(count_of("answers come\n"), before) << device->output();

  EXPECT_TRUE(eventually([&] {
    hostile.answer(1e300);
    return count_of("answers come\n") > before;
  })) << "the hostile scene is received";
  const auto pushed = std::chrono::steady_clock::now();
  EXPECT_TRUE(eventually([&] {
    hostile.answer(1e300);
    return std::chrono::steady_clock::now() - pushed > std::chrono::milliseconds(500);
  }));
  EXPECT_EQ(end(*device), 0);
  session.node("sim").signal(SIGCONT);
  EXPECT_EQ(number_in(device->output(), "largest force (\\S+) N"), 10.0) << device->output();
}

TEST(ForeignDevice, RaisesItsForceNoFasterThanItsSlewLimit) {
  constexpr double kLargestRise = 5.0;  // 5000 N/s for 1 ms [N]
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  session.start("sim_node", "sim");
  const auto device = start_foreign("foreign_device", {"keyboard"});
  ASSERT_TRUE(device->wait_for_output("answers come\n", kPatience));
  HostileScene hostile(session.participant());
  session.node("sim").signal(SIGSTOP);
  ASSERT_TRUE(device->wait_for_output("no force\n", kPatience));
  const std::string before = device->output();

  // From no force to 8 N in one answer.
  EXPECT_TRUE(eventually([&] {
    hostile.answer(8.0);
    return device->output().find("answers come\n", before.size()) != std::string::npos;
  }));
  EXPECT_EQ(end(*device), 0);
  session.node("sim").signal(SIGCONT);
  EXPECT_NEAR(number_in(device->output(), "raised by (\\S+) N a period"), kLargestRise, 1e-5)
      << device->output();
}

TEST(ForeignDevice, IsInATakeThatIsComputedAgain) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", liaison_scene());
  const std::string take = (session.folder() / "take.mcap").string();
  ChildProcess& launcher = session.start_launcher({"--duration", "2s", "--record", take});
  const auto device = start_foreign("foreign_device", {"keyboard"});
  EXPECT_EQ(launcher.wait(kPatience), 0);
  EXPECT_EQ(end(*device), 0);
  EXPECT_GT(number_in(device->output(), "(\\d+) samples answered"), 0.0);

  ChildProcess resim({program_path("cordis"), "resim", take});
  EXPECT_EQ(resim.wait(kPatience), 0) << resim.output();
}

TEST(ForeignDevice, WaitsForASceneThatPlaysIt) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  session.start("sim_node", "sim");
  const auto pedal = start_foreign("foreign_device", {"pedal"});
  const auto elsewhere = start_foreign("foreign_device", {"keyboard"}, "tset");
  EXPECT_TRUE(pedal->wait_for_output("scene 'spring' has no port for 'pedal'", kPatience));
  EXPECT_TRUE(elsewhere->wait_for_output("warning: no scene for 5 s: `cordis list`", kPatience));
  EXPECT_EQ(end(*pedal), 0);
  EXPECT_EQ(end(*elsewhere), 0);
}

TEST(ForeignDevice, RefusesAPortWithMoreAxesThanItHas) {
  LiveSession session("realtime", kSimAlone);
  std::string scene = mass_scene();
  scene.replace(scene.find("axes: [0]"), 9, "axes: [1]");
  session.add_file("scene.yaml", scene);
  session.start("sim_node", "sim");
  const auto device = start_foreign("foreign_device", {"keyboard"});
  EXPECT_TRUE(device->wait_for_output("error: port 'key' wants other axes than axis 0", kPatience));
  EXPECT_EQ(end(*device), 0);
}

TEST(ForeignPrograms, OfAnotherVersionOfTheWireEndAndSaySo) {
  const std::uint32_t version = msg::WIRE_VERSION + 1;
  const dds::Participant other(
      {.domain = own_domain(), .session = "test", .node = "sim", .wire_version = version});
  for (const auto& [program, words] :
       std::map<std::string, std::vector<std::string>>{{"foreign_device", {"keyboard"}},
                                                       {"foreign_listen", {"signals"}},
                                                       {"foreign_command", {"sim", "pause"}}}) {
    const auto foreign = start_foreign(program, words);
    EXPECT_EQ(foreign->wait(kPatience), 1);
    EXPECT_NE(foreign->output().find("error: the session speaks version " +
                                     std::to_string(version) + " of the messages"),
              std::string::npos)
        << foreign->output();
  }
}

TEST(ForeignPrograms, GoOnBesideASessionOfAnotherVersion) {
  const dds::Participant other({.domain = own_domain(),
                                .session = "test-of-old",
                                .node = "sim",
                                .wire_version = msg::WIRE_VERSION + 1});
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  session.start("sim_node", "sim");
  const auto pause = start_foreign("foreign_command", {"sim", "pause"});
  EXPECT_EQ(pause->wait(kPatience), 0) << pause->output();
}

TEST(ForeignPrograms, AnswerAMistakeOfTheCommandLineWithCodeTwo) {
  const std::string device = program_path("foreign_device");
  const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes{
      {{device}, "usage: foreign_device"},
      {{device, "1", "test", "keyboard", "--realtime"}, "usage: foreign_device"},
      {{device, "test", "1", "keyboard"}, "error: 'test' is no DDS domain"},
      {{device, "102", "test", "keyboard"}, "error: '102' is no DDS domain"},
      {{program_path("foreign_listen"), "1", "test", "sounds"}, "usage: foreign_listen"},
      {{program_path("foreign_command"), "1", "test", "sim", "stop"}, "usage: foreign_command"},
      {{"/usr/bin/env", "-u", "CYCLONEDDS_URI", device, "1", "test", "keyboard"},
       "error: set CYCLONEDDS_URI=file://"}};
  for (const auto& [words, sentence] : mistakes) {
    ChildProcess program(words, kLoopback);
    EXPECT_EQ(program.wait(kPatience), 2) << words[0];
    EXPECT_NE(program.output().find(sentence), std::string::npos) << program.output();
  }
}

TEST(ForeignCommand, IsAcceptedRefusedOrNotAnswered) {
  LiveSession session("realtime", kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  session.start("sim_node", "sim");
  const auto pause = start_foreign("foreign_command", {"sim", "pause"});
  EXPECT_EQ(pause->wait(kPatience), 0);
  EXPECT_NE(pause->output().find("sim accepted: "), std::string::npos) << pause->output();

  const auto load = start_foreign("foreign_command", {"sim", "load", "no_such_scene.yaml"});
  EXPECT_EQ(load->wait(kPatience), 1);
  EXPECT_NE(load->output().find("sim refused: "), std::string::npos) << load->output();

  const auto absent = start_foreign("foreign_command", {"simm", "pause"});
  EXPECT_EQ(absent->wait(kPatience), 1);
  EXPECT_NE(absent->output().find("error: no reply for 10 s: is 'simm' a node"), std::string::npos)
      << absent->output();
}

std::vector<std::string> lines_of(std::istream& text) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream fields(line);
  for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::stod(field));
  return numbers;
}

TEST(ForeignListener, PrintsTheSignalsThatCordisRunWrites) {
  LiveSession session("lockstep", kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  const auto listener = start_foreign("foreign_listen", {"signals"});
  const std::string table = (session.folder() / "signals.csv").string();
  ChildProcess& launcher = session.start_launcher({"--duration", "1s", "--signals", table});
  ASSERT_TRUE(listener->wait_for_output("time [s],", kPatience));
  const auto device = start_foreign("foreign_device", {"keyboard", "--lockstep"});
  EXPECT_EQ(launcher.wait(kPatience), 0);
  EXPECT_EQ(end(*device), 0);

  std::ifstream file(table);
  const std::vector<std::string> wanted = lines_of(file);
  ASSERT_EQ(wanted.size(), 1001u);
  const std::string last = "\n" + match_in(wanted.back(), "^([^,]*),");
  EXPECT_TRUE(listener->wait_for_output(last, kPatience));
  EXPECT_EQ(end(*listener), 0);
  std::istringstream output(listener->output());
  const std::vector<std::string> printed = lines_of(output);
  EXPECT_EQ(printed.front(), wanted.front());
  // Its reader may have been found after the first batches.
  const std::size_t missed = wanted.size() - printed.size();
  ASSERT_LT(missed, 500u);
  for (std::size_t row = 1; row < printed.size(); ++row)
    ASSERT_EQ(numbers_of(printed[row]), numbers_of(wanted[row + missed])) << printed[row];
}

TEST(ForeignListener, PrintsFramesThatShowWhereTheDeviceIs) {
  LiveSession session("lockstep", kSimAlone);
  session.add_file("scene.yaml", mass_scene());
  const auto listener = start_foreign("foreign_listen", {"frames"});
  ChildProcess& launcher = session.start_launcher({"--duration", "3s"});
  const auto device = start_foreign("foreign_device", {"keyboard", "--lockstep"});
  EXPECT_EQ(launcher.wait(kPatience), 0);
  EXPECT_TRUE(listener->wait_for_output("step 12000 hash ", kPatience));
  EXPECT_EQ(end(*device), 0);
  EXPECT_EQ(end(*listener), 0);
  EXPECT_NE(listener->output().rfind("-0.005, 0)"), std::string::npos) << listener->output();
}

}  // namespace
}  // namespace cordis::test
