// tests/integration/missing_board_test.cpp -- `cordis run` with a device whose board is not there.
#include <csignal>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/device/kfb1_board.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/support/filled.h"

namespace cordis::test {
namespace {

const char* const kNodes =
    R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
)";
const char* const kNodesWithStandby =
    R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
  standby_node: {node: device_node, device: key.yaml, driver: script, standby_for: keyboard}
)";

/// A session whose device of one axis is at the serial line `tty` of its folder.
class BoardSession {
 public:
  explicit BoardSession(const char* nodes) : session_("realtime", nodes) {
    session_.add_file("scene.yaml", wall_scene(/*stiffness_n_per_m=*/200.0));
    session_.add_file("key.yaml", filled(R"(cordis: 1
axes: 1
force_limit_n: 5
driver: kfb1
kfb1: {port: <line>, lost_after_s: 0.2}
script: {positions: [{at_s: 0, m: 0}]}
)",
                                         {{"line", line()}}));
  }

  std::string line() const { return (session_.folder() / "tty").string(); }

  /// Runs the session until the launcher has printed `text`. @return its exit code
  int run_until(const std::string& text) {
    ChildProcess& run = session_.start_launcher({"--summary", summary_file()});
    EXPECT_TRUE(run.wait_for_output(text, kPatience));
    run.signal(SIGINT);
    const int code = run.wait(kPatience);
    run.wait_for_end_of_output(kPatience);
    output_ = run.output();
    return code;
  }

  bool says(const std::string& text) const { return output_.find(text) != std::string::npos; }
  const std::string& output() const { return output_; }

  nlohmann::json summary() const {
    std::ifstream file(summary_file());
    return nlohmann::json::parse(file);
  }

 private:
  std::string summary_file() const { return (session_.folder() / "summary.json").string(); }

  LiveSession session_;
  std::string output_;
};

TEST(MissingBoard, EndsTheRunWithOneAndASentence) {
  BoardSession session(kNodes);
  const std::string driver = "driver kfb1 at " + session.line() + ": the device ";

  EXPECT_EQ(session.run_until(driver + "does not answer; trying again"), 1);

  EXPECT_TRUE(session.says("\nkeyboard failed: " + driver + "was never connected\n"));
  const nlohmann::json summary = session.summary();
  EXPECT_EQ(summary["complete"], false);
  EXPECT_EQ(summary["nodes"]["sim"]["phase"], "stopped");
  EXPECT_EQ(summary["nodes"]["keyboard"]["node"], "device_node");
  EXPECT_EQ(summary["nodes"]["keyboard"]["phase"], "failed");
  EXPECT_EQ(summary["nodes"]["keyboard"]["reason"], driver + "was never connected");
}

TEST(MissingBoard, IsNoFailureWhereAHotStandbyPlays) {
  BoardSession session(kNodesWithStandby);

  EXPECT_EQ(session.run_until(": the device does not answer; trying again"), 0);

  EXPECT_TRUE(session.says("\nkeyboard: driver kfb1 at " + session.line() +
                           ": the device was never connected; another node played it\n"));
  EXPECT_EQ(session.summary()["complete"], true);
  EXPECT_EQ(session.summary()["nodes"]["keyboard"]["phase"], "stopped");
}

TEST(MissingBoard, ABoardOfAnotherNumberOfKeysIsOne) {
  BoardSession session(kNodes);
  Kfb1Board board(/*keys=*/2);
  board.plug.into_serial_line(session.line());

  EXPECT_EQ(session.run_until("the device has 2 keys"), 1);

  EXPECT_TRUE(session.says(": the device was never connected\n"));
}

TEST(MissingBoard, ABoardThatIsThereStartsWithoutAWarning) {
  BoardSession session(kNodes);
  Kfb1Board board(/*keys=*/1);
  board.plug.into_serial_line(session.line());

  EXPECT_EQ(session.run_until("info plays 'keyboard'\n"), 0);

  EXPECT_FALSE(session.says("does not answer")) << session.output();
  EXPECT_FALSE(session.says("plays again")) << session.output();
  EXPECT_FALSE(session.says("never connected")) << session.output();
  EXPECT_EQ(session.summary()["nodes"]["keyboard"]["phase"], "stopped");
}

}  // namespace
}  // namespace cordis::test
