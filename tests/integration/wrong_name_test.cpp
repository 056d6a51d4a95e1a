// tests/integration/wrong_name_test.cpp -- a device that a port names and no node has.
#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"

namespace cordis::test {
namespace {

using namespace std::chrono_literals;

const std::string kSim = "  sim: {node: sim_node, scene: scene.yaml}\n";
const std::string kMisspelt = kSim + "  keybord: {node: device_node, device: key.yaml}\n";

/// A session whose port wants the device `keyboard`.
class WrongName : public testing::TestWithParam<const char*> {
 protected:
  static void add_files(const LiveSession& session) {
    session.add_file("scene.yaml", wall_scene(100.0));
    session.add_file("key.yaml", steady_key(-0.01, 0.0));
  }
};
INSTANTIATE_TEST_SUITE_P(, WrongName, testing::Values("realtime", "lockstep"),
                         [](const auto& clock) { return std::string(clock.param); });

TEST_P(WrongName, IsRefusedBeforeASessionBegins) {
  LiveSession session(GetParam(), kMisspelt);
  add_files(session);

  ChildProcess& run = session.start_launcher({"--duration", "100ms"});
  ChildProcess check({program_path("cordis"), "check", session.launch_file()});

  for (ChildProcess* verb : {&run, &check}) {
    EXPECT_EQ(verb->wait(kPatience), 2);
    verb->wait_for_end_of_output(kPatience);
    EXPECT_NE(verb->output().find("scene.yaml:11:3: error: port 'key' wants the device 'keyboard'"),
              std::string::npos)
        << verb->output();
    EXPECT_NE(verb->output().find("did you mean 'keybord'?"), std::string::npos) << verb->output();
  }
}

TEST_P(WrongName, OfADeviceThatNeverComesEndsTheRunAtItsDurationAsAFailure) {
  LiveSession session(GetParam(), kSim);
  add_files(session);
  const auto begun = std::chrono::steady_clock::now();

  ChildProcess& run = session.start_launcher({"--duration", "1s"});

  EXPECT_EQ(run.wait(kPatience), 1);
  run.wait_for_end_of_output(kPatience);
  const std::string sentence = GetParam() == std::string("lockstep")
                                   ? "no device 'keyboard' has joined for 5 s, and no node of "
                                   : "no device has joined that a port of the scene plays";
  EXPECT_NE(run.output().find(sentence), std::string::npos) << run.output();
  EXPECT_NE(run.output().find("warning: port 'key' wants the device 'keyboard'"), std::string::npos)
      << run.output();
  EXPECT_GT(std::chrono::steady_clock::now() - begun, 1s);
}

}  // namespace
}  // namespace cordis::test
