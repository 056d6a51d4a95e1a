// tests/resim/resim_session_test.cpp -- sessions of real processes, recorded and computed again.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "cli/resim/resim.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"
#include "tests/resim/take_recorder.h"

namespace cordis::test {
namespace {

namespace fs = std::filesystem;

const std::string kLaunches = CORDIS_SOURCE_DIR "/launch_configs/";

std::string sim_of(const std::string& scene, const std::string& more = "") {
  return "  sim: {node: sim_node, scene: '" + scene + "'" + more + "}\n";
}

std::string kneading_thimbles() {
  return "  thimbles: {node: device_node, device: '" + kLaunches +
         "devices/two_thimbles.yaml', driver: mock, mock: {hand: {gesture: {kind: knead, open_m: "
         "0.015, grip_m: -0.06, in_s: 0.7, stay_s: 0.3}}}}\n";
}

/// A session that is recorded from its start to its end.
class RecordedSession {
 public:
  RecordedSession(const std::string& clock, const std::string& nodes)
      : session_(clock, nodes),
        status_(session_.participant()),
        take_(session_.folder() / "take.mcap"),
        recorder_(std::make_unique<TakeRecorder>(session_.participant(), take_)) {}

  LiveSession& live() { return session_; }
  StatusWatch& status() { return status_; }

  std::string ctl(const std::vector<std::string>& words) {
    std::vector<std::string> command{program_path("cordis"), "ctl", session_.launch_file(),
                                     "--timeout", "60s"};
    command.insert(command.end(), words.begin(), words.end());
    ChildProcess process(command);
    EXPECT_EQ(process.wait(kPatience), 0) << process.output();
    return process.output();
  }

  void end() {
    session_.node("sim").signal(SIGTERM);
    wait();
  }
  void wait() {
    EXPECT_EQ(session_.node("sim").wait(kPatience), 0);
    recorder_->finish();
    const char* keep = std::getenv("CORDIS_KEEP_TAKES");
    if (keep == nullptr) return;
    fs::create_directories(keep);
    std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::ranges::replace(name, '/', '_');
    fs::copy_file(take_, fs::path(keep) / (name + ".mcap"), fs::copy_options::overwrite_existing);
  }

  cli::ResimResult resim(const std::vector<std::string>& words = {}) const {
    cli::ResimOptions options;
    options.take = take_.string();
    options.words = words;
    cli::ResimResult result = cli::resimulate(options);
    std::printf("%s", cli::text_of(result, options).c_str());
    return result;
  }

 private:
  LiveSession session_;
  StatusWatch status_;
  fs::path take_;
  std::unique_ptr<TakeRecorder> recorder_;
};

void expect_equal(const cli::ResimResult& result, std::uint64_t frames) {
  EXPECT_EQ(result.by, cli::FrameCheck::By::kHash);
  EXPECT_TRUE(result.is_equal());
  EXPECT_EQ(result.loss, "");
  EXPECT_GE(result.findings.frames, frames);
}

TEST(ResimSession, AHandOnAKeyInRealtime) {
  RecordedSession session("realtime",
                          sim_of(kLaunches + "scenes/plucked_string.yaml", ", duration_s: 2") +
                              "  keyboard: {node: device_node, device: '" + kLaunches +
                              "devices/keyboard.yaml', driver: mock}\n");
  session.live().start("device_node", "keyboard");
  session.live().start("sim_node", "sim");
  session.wait();
  const cli::ResimResult result = session.resim();
  expect_equal(result, 10);
  EXPECT_GT(result.samples, 100u);
}

TEST(ResimSession, TwoThimblesOfRoleMassInLockstep) {
  RecordedSession session(
      "lockstep",
      sim_of(kLaunches + "scenes/plasticine.yaml", ", duration_s: 1") + kneading_thimbles());
  session.live().start("device_node", "thimbles");
  session.live().start("sim_node", "sim");
  session.wait();
  expect_equal(session.resim(), 10);
}

/// 3 s of it, or as many as CORDIS_RESIM_S says: 60 is the long form.
TEST(ResimSession, PlasticineThatIsKneadedInRealtime) {
  const char* longer = std::getenv("CORDIS_RESIM_S");
  const int seconds = longer == nullptr ? 3 : std::atoi(longer);
  ASSERT_GT(seconds, 0);
  RecordedSession session("realtime", sim_of(kLaunches + "scenes/plasticine.yaml",
                                             ", duration_s: " + std::to_string(seconds)) +
                                          kneading_thimbles());
  session.live().start("device_node", "thimbles");
  session.live().start("sim_node", "sim");
  session.wait();
  const cli::ResimResult result = session.resim();
  expect_equal(result, static_cast<std::uint64_t>(2 * seconds));
  EXPECT_GE(result.played_s, seconds - 0.001);
  EXPECT_GT(result.samples, 100u);
}

/// The port follows its device, so another spring changes its force alone: 10 mm are 2 N of 200 N/m.
TEST(ResimSession, AStifferSpringBehindADirectPortChangesForcesAlone) {
  RecordedSession session("lockstep", sim_of("scene.yaml", ", duration_s: 1") +
                                          "  keyboard: {node: device_node, device: key.yaml}\n");
  session.live().add_file("scene.yaml", wall_scene(200.0));
  session.live().add_file("key.yaml", std::string(kScriptedKey) + R"(    - {at_s: 0, m: 0}
    - {at_s: 0.3, m: -0.01}
)");
  session.live().start("device_node", "keyboard");
  session.live().start("sim_node", "sim");
  session.wait();

  const cli::ResimResult same = session.resim({"wall.stiffness_n_per_m=200"});
  ASSERT_TRUE(same.findings.force);
  EXPECT_EQ(same.findings.force->largest_n, 0.0);
  const cli::ResimResult stiffer = session.resim({"wall.stiffness_n_per_m=300"});
  EXPECT_EQ(stiffer.findings.largest->largest_m, 0.0);
  ASSERT_TRUE(stiffer.findings.force);
  EXPECT_EQ(stiffer.findings.force->port, "key");
  EXPECT_NEAR(stiffer.findings.force->taken_n, 2.0, 1e-6);  // a frame has 24 bits
  EXPECT_NEAR(stiffer.findings.force->now_n, 3.0, 1e-6);
}

class ResimRole : public ::testing::TestWithParam<const char*> {};

TEST_P(ResimRole, AKeyThatPushes) {
  RecordedSession session(GetParam(), sim_of("scene.yaml", ", duration_s: 2") +
                                          "  keyboard: {node: device_node, device: key.yaml}\n");
  session.live().add_file("scene.yaml", pushed_mass_scene());
  session.live().add_file("key.yaml", steady_key(0.0, 1.0));
  session.live().start("device_node", "keyboard");
  session.live().start("sim_node", "sim");
  session.wait();
  expect_equal(session.resim(), 10);
}

INSTANTIATE_TEST_SUITE_P(Clocks, ResimRole, ::testing::Values("realtime", "lockstep"));

class ResimCommands : public ::testing::TestWithParam<const char*> {};

/// Whatever is commanded, in whatever order.
TEST_P(ResimCommands, AtAnyTimeAreRepeated) {
  const bool has_devices = std::string(GetParam()) != "asap";
  const std::string clock = GetParam();
  RecordedSession session(
      clock, sim_of("scene.yaml") +
                 (has_devices ? "  keyboard: {node: device_node, device: key.yaml}\n" : ""));
  std::string touched = wall_scene(200.0);
  touched.insert(
      touched.find("matter:"),
      "  hook: {start: held, states: {held: {stiffness_n_per_m: 50, viscosity_n_s_per_m: "
      "0.5, exits: [{to: free, when: elongation_m > 10}]}, free: {}}}\n");
  touched += "  - {liaison: hook, between: [key, bob], rest_m: 0, name: hooks}\n";
  session.live().add_file("scene.yaml", touched);
  session.live().add_file("other.yaml", wall_scene(300.0));
  session.live().add_file("key.yaml", std::string(kScriptedKey) +
                                          R"(    - {at_s: 0, m: 0}
    - {at_s: 0.3, m: -0.01}
    - {at_s: 0.6, m: -0.002}
)");
  if (has_devices) session.live().start("device_node", "keyboard");
  session.live().start("sim_node", "sim");
  ASSERT_TRUE(session.status().wait_for_phase("sim", msg::PHASE_RUNNING));
  std::mt19937 random(7);
  bool is_first_scene = true;
  session.ctl({"set", "wall.stiffness_n_per_m=210"});
  session.ctl({"state", "hooks", "free"});
  for (int i = 0; i < 8; ++i) {
    switch (random() % 6) {
      case 0:
        session.ctl({"pause"});
        break;
      case 1:
        session.ctl({"step", std::to_string(1 + random() % 11)});
        break;
      case 2:
        session.ctl({"set", "wall.stiffness_n_per_m=" + std::to_string(150 + random() % 200)});
        break;
      case 3:
        session.ctl({"reset"});
        break;
      case 4:
        session.ctl({"load", is_first_scene ? "other.yaml" : "scene.yaml"});
        is_first_scene = !is_first_scene;
        break;
      default:
        session.ctl({"resume"});
    }
  }
  session.ctl({"resume"});
  session.end();
  const cli::ResimResult result = session.resim();
  expect_equal(result, 5);
  EXPECT_GE(result.commands, 11u);
}

INSTANTIATE_TEST_SUITE_P(Clocks, ResimCommands, ::testing::Values("realtime", "lockstep", "asap"));

}  // namespace
}  // namespace cordis::test
