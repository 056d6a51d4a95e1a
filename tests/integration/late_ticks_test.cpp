// tests/integration/late_ticks_test.cpp -- the table at the end of `cordis run` reports why ticks
// came late.
#include <chrono>
#include <csignal>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"
#include "tests/support/timer_control.h"

namespace cordis::test {
namespace {

/// A key and, beside it, a string whose steps take ten times longer than they last on a fast
/// machine.
std::string scene_that_is_too_slow() {
  std::string text = wall_scene(200.0);
  text.replace(text.find("rate_hz: 4000"), 13, "rate_hz: 40000");
  const std::string matter = "matter:\n";
  text.replace(text.find(matter), matter.size(),
               matter +
                   "  long: {kind: string, count: 100000, mass_kg: 100, from_m: [1], to_m: [2], "
                   "ends: fixed, "
                   "stiffness_n_per_m: 10, viscosity_n_s_per_m: 0.01}\n");
  return text;
}

/// `cordis run` of a scene with a key at 1 kHz.
class LateTicks : public testing::Test {
 protected:
  explicit LateTicks(const std::string& scene = wall_scene(200.0)) {
    session_.add_file("scene.yaml", scene);
    session_.add_file("key.yaml", steady_key(-0.01, 0.0));
    launcher_ = &session_.start_launcher();
  }

  bool both_run() {
    return status_.wait_for_phase("sim", msg::PHASE_RUNNING) &&
           status_.wait_for_phase("keyboard", msg::PHASE_RUNNING);
  }

  void signal(const std::string& node, int number) {
    const pid_t process = process_of(*launcher_, node);
    ASSERT_GT(process, 0) << node;
    ASSERT_EQ(kill(process, number), 0);
  }

  /// Ends the session. @return the line of a node in the table, from its overruns on
  std::string row_of(const std::string& node) {
    launcher_->signal(SIGINT);
    EXPECT_EQ(launcher_->wait(kPatience), 0);
    const std::string all = launcher_->output();
    std::istringstream table(all.substr(std::min(all.find("\nnode "), all.size())));
    for (std::string line; std::getline(table, line);) {
      if (line.starts_with(node + " ")) return line;
    }
    return "no line of " + node;
  }

  LiveSession session_{"realtime", kSimAndKey};
  StatusWatch status_{session_.participant()};
  ChildProcess* launcher_ = nullptr;
  const TimerControl timer_;
};

class LateTicksOfASlowScene : public LateTicks {
 protected:
  LateTicksOfASlowScene() : LateTicks(scene_that_is_too_slow()) {}
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(LateTicksOfASlowScene, AreTheScenesFault) {
  ASSERT_TRUE(status_.wait_for("sim", [](const msg::NodeStatus& status) {
    return status.late_by_work() >= 10 && status.late_by_work() > status.late_by_machine();
  }));
  const std::string row = row_of("sim");
  EXPECT_TRUE(contains(row, "scene too slow ")) << row;
  if (timer_.worst() < std::chrono::milliseconds(1)) {  // otherwise the machine is late as well
    EXPECT_FALSE(contains(launcher_->output(), "the machine itself")) << launcher_->output();
  }
}

TEST_F(LateTicks, OfASceneAreNotThoseInWhichItsDeviceIsSilent) {
  ASSERT_TRUE(both_run());

  signal("keyboard", SIGSTOP);
  ASSERT_TRUE(status_.wait_for(
      "sim", [](const msg::NodeStatus& status) { return status.silent_ticks() >= 50; }));
  signal("keyboard", SIGCONT);
  ASSERT_TRUE(status_.wait_for("keyboard", [](const msg::NodeStatus& status) {
    return status.phase() == msg::PHASE_RUNNING && status.late_by_machine() > 0;
  }));
  ASSERT_TRUE(status_.wait_for(
      "sim", [](const msg::NodeStatus& status) { return status.phase() == msg::PHASE_RUNNING; }));

  const std::string row = row_of("sim");
  EXPECT_TRUE(contains(row, "device silent ")) << row;
}

TEST_F(LateTicks, OfAProcessThatWasStoppedAreNoWorkOfItsOwn) {
  ASSERT_TRUE(both_run());
  const std::uint64_t before = status_.of("sim").late_by_machine();

  signal("sim", SIGSTOP);
  ASSERT_TRUE(status_.wait_for(
      "keyboard", [](const msg::NodeStatus& status) { return status.silent_ticks() >= 50; }));
  signal("sim", SIGCONT);
  ASSERT_TRUE(status_.wait_for(
      "sim", [&](const msg::NodeStatus& status) { return status.late_by_machine() > before; }));
  ASSERT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING));

  const std::string sim = row_of("sim");
  EXPECT_TRUE(contains(sim, "not woken ")) << sim;
  const std::string keyboard = row_of("keyboard");
  EXPECT_TRUE(contains(keyboard, "scene silent ")) << keyboard;
  EXPECT_FALSE(contains(keyboard, "device silent")) << keyboard;
}

}  // namespace
}  // namespace cordis::test
