// tests/integration/determinism_test.cpp -- a lockstep run gives the same state, bit for bit.
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/support/filled.h"

namespace cordis::test {
namespace {

std::string state_hash_of(LiveSession& session, const std::string& duration) {
  ChildProcess& launcher = session.start_launcher({"--duration", duration});
  EXPECT_EQ(launcher.wait(kPatience), 0);
  const std::string output = launcher.output();
  std::smatch match;
  EXPECT_TRUE(std::regex_search(output, match,
                                std::regex("state hash ([0-9a-f]{16}) after ([0-9]+) steps")))
      << output;
  return match.str();
}

std::string state_hash_of_a_run(const std::string& driver) {
  const std::string configs = CORDIS_SOURCE_DIR "/launch_configs/";
  LiveSession session(
      "lockstep", filled(R"(  sim: {node: sim_node, scene: '<configs>scenes/plucked_string.yaml'}
  keyboard: {node: device_node, device: '<configs>devices/keyboard.yaml', driver: <driver>}
)",
                         {{"configs", configs}, {"driver", driver}}));
  return state_hash_of(session, "2s");
}

TEST(Determinism, ALockstepRunGivesTheSameStateHashThreeTimes) {
  for (const std::string driver : {"mock", "script"}) {
    std::set<std::string> hashes;
    for (int run = 0; run < 3; ++run) hashes.insert(state_hash_of_a_run(driver));
    EXPECT_EQ(hashes.size(), 1u) << *hashes.begin() << " and " << *hashes.rbegin();
  }
}

TEST(Determinism, ALockstepRunGivesTheSameStateHashByAnyNumberOfThreads) {
  std::set<std::string> hashes;
  for (const std::string threads : {"1", "2", "3"}) {
    LiveSession session("lockstep",
                        "  sim: {node: sim_node, scene: scene.yaml, threads: " + threads + R"(}
  keyboard: {node: device_node, device: key.yaml}
)");
    session.add_file("scene.yaml", large_net_scene());
    session.add_file("key.yaml", steady_key(-0.01, 0.0));
    hashes.insert(state_hash_of(session, "400ms"));
    const std::string line = "a step is shared by " + threads + " threads";
    EXPECT_EQ(session.node("cordis").output().find(line) != std::string::npos, threads != "1");
  }
  EXPECT_EQ(hashes.size(), 1u) << *hashes.begin() << " and " << *hashes.rbegin();
}

TEST(Determinism, AnotherGestureGivesAnotherState) {
  EXPECT_NE(state_hash_of_a_run("mock"), state_hash_of_a_run("script"));
}

}  // namespace
}  // namespace cordis::test
