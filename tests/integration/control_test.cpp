// tests/integration/control_test.cpp -- a session is changed while it runs.
#include "idl/control.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "idl/gesture.h"
#include "idl/scene.h"
#include "node/config/name_hash.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/runtime_folder.h"
#include "node/session_registry.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

using namespace std::chrono_literals;

constexpr const char* kFreeScene = R"(cordis: 1
name: free
space: 1
step: {rate_hz: 1000}
matter:
  bob: {kind: mass, mass_kg: 1, at_m: 0}
)";

struct Outcome {
  int code;
  std::string output;
};

/// A session of sim and keyboard that runs, and `cordis ctl` for it.
class Control : public ::testing::TestWithParam<const char*> {
 protected:
  explicit Control(const std::string& clock = GetParam())
      : session_(clock, kSimAndKey), status_(session_.participant()) {
    session_.add_file("scene.yaml", wall_scene(200.0));
    session_.add_file("stiff.yaml", wall_scene(400.0));
    session_.add_file("bad.yaml", "cordis: 1\nspace: 7\n");
    std::string wide = wall_scene(200.0);
    session_.add_file("wide.yaml",
                      wide.insert(wide.find("at_m: [0]}\nlinks"), "needs: {travel_m: 0.05}, "));
    session_.add_file("key.yaml", steady_key(-0.01, 0.0));
  }

  void start() {
    session_.start("sim_node", "sim");
    session_.start("device_node", "keyboard");
    ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
    ASSERT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING));
  }

  Outcome ctl(const std::vector<std::string>& words, const std::string& timeout = "60s") {
    std::vector<std::string> command{program_path("cordis"), "ctl", session_.launch_file(),
                                     "--timeout", timeout};
    command.insert(command.end(), words.begin(), words.end());
    ChildProcess process(command);
    const int code = process.wait(kPatience);
    return {code, process.output()};
  }

  void expect_done(const std::vector<std::string>& words, const std::string& text) {
    const Outcome outcome = ctl(words);
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find(text), std::string::npos) << outcome.output;
  }

  void expect_refused(const std::vector<std::string>& words, const std::string& text) {
    const Outcome outcome = ctl(words);
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(text), std::string::npos) << outcome.output;
  }

  /// Single steps. A scene that takes longer than sim_node waits for its end is answered in
  /// between.
  void expect_steps(const std::vector<std::string>& words, std::uint64_t end) {
    const Outcome outcome = ctl(words);
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    const std::string done = "sim: paused at step " + std::to_string(end) + "\n";
    EXPECT_TRUE(outcome.output == done ||
                outcome.output.find(" begun at step ") != std::string::npos)
        << outcome.output;
    EXPECT_TRUE(eventually([&] { return step_shown() == end; }));
    EXPECT_EQ(step_shown(), end) << "no step more";
  }

  /// Waits until the key is given this force [N]. @param force  then the message that gave it
  static bool feels(double wanted, dds::Reader<msg::GestureForces>& forces,
                    msg::GestureForces& force) {
    return eventually(
        [&] { return forces.take(force) && std::abs(force.force_n()[0] - wanted) < 1e-9; });
  }

  /// The step of the newest frame from now on.
  std::uint64_t step_shown() {
    dds::Reader<msg::SceneFrame> frames(session_.participant(), dds::Topic::kFrame);
    msg::SceneFrame frame;
    EXPECT_TRUE(eventually([&] { return frames.take(frame); }));
    return frame.step();
  }

  LiveSession session_;
  StatusWatch status_;
};

TEST_P(Control, PausesStepsAndResumes) {
  start();
  expect_done({"pause"}, "sim: paused at step ");
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_PAUSED));
  const std::uint64_t step = step_shown();
  EXPECT_EQ(step_shown(), step) << "views go on, the scene does not";

  expect_steps({"step"}, step + 1);
  expect_steps({"step", "7"}, step + 8);

  expect_done({"resume"}, "goes on at step " + std::to_string(step + 8));
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
  EXPECT_TRUE(status_.wait_for(
      "sim", [&](const msg::NodeStatus& status) { return status.step() > step + 1000; }));
}

TEST_P(Control, TheMeanRateCountsNoPause) {
  start();
  ASSERT_TRUE(
      status_.wait_for("sim", [](const msg::NodeStatus& status) { return status.ticks() > 500; }));
  expect_done({"pause"}, "paused");
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_PAUSED));
  const double mean_hz = status_.of("sim").mean_rate_hz();
  const std::int64_t paused_nsec = status_.of("sim").time_nsec();

  const std::int64_t until_nsec = paused_nsec + 3'000'000'000;
  ASSERT_TRUE(status_.wait_for(
      "sim", [&](const msg::NodeStatus& status) { return status.time_nsec() > until_nsec; }));
  EXPECT_NEAR(status_.of("sim").mean_rate_hz(), mean_hz, 1e-9 * mean_hz);
}

TEST_P(Control, ResetBeginsTheSceneAnewUnderANewVersion) {
  start();
  dds::Reader<msg::SceneDescription> descriptions(session_.participant(), dds::Topic::kDescription);
  msg::SceneDescription description;
  ASSERT_TRUE(eventually([&] { return descriptions.take(description); }));
  EXPECT_EQ(description.version(), 1u);
  ASSERT_TRUE(
      status_.wait_for("sim", [](const msg::NodeStatus& status) { return status.step() > 2000; }));
  expect_done({"pause"}, "paused");
  expect_done({"reset"}, "'wall' restarts, paused");

  ASSERT_TRUE(eventually([&] { return descriptions.take(description); }));
  EXPECT_EQ(description.version(), 2u);
  EXPECT_EQ(step_shown(), 0u);
  expect_done({"resume"}, "goes on at step 0");
  ASSERT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING));
}

TEST_P(Control, LoadPlaysAnotherSceneAndTheKeyFeelsIt) {
  start();
  dds::Reader<msg::GestureForces> forces(session_.participant(), dds::Topic::kForces);
  msg::GestureForces force;
  ASSERT_TRUE(feels(2.0, forces, force));
  const std::uint64_t before = force.sample();

  expect_done({"load", "stiff.yaml"}, "'wall' begins; the scene before ended at step ");

  ASSERT_TRUE(feels(4.0, forces, force));
  EXPECT_GT(force.sample(), before) << "the numbers of the answers go on";
  EXPECT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING));
}

TEST_P(Control, SetChangesAParameterAndTheKeyFeelsIt) {
  session_.add_file("key.yaml", steady_key(-0.01, 0.0) + "stiffness_limit_n_per_m: 1000\n");
  start();
  dds::Reader<msg::GestureForces> forces(session_.participant(), dds::Topic::kForces);
  msg::GestureForces force;
  ASSERT_TRUE(feels(2.0, forces, force));
  expect_done({"set", "wall.stiffness_n_per_m=350"}, "sim: wall.stiffness_n_per_m = 350 at step ");
  ASSERT_TRUE(feels(3.5, forces, force));

  expect_refused({"set", "wal.stiffness_n_per_m=1"}, "did you mean 'wall'?");
  expect_refused({"set", "wall.stifness_n_per_m=1"}, "has no parameter 'stifness_n_per_m'");
  expect_refused({"set", "wall.stiffness_n_per_m=-1"}, "must be >= 0, got -1");
  expect_refused({"set", "wall.stiffness_n_per_m=soft"}, "must be a number, got 'soft'");
  expect_refused({"set", "wall.stiffness_n_per_m=20000"},
                 "the device 'keyboard' supports 1000 N/m");
  expect_refused({"state", "wall", "broken"}, "'wall' has no states");
  ASSERT_TRUE(feels(3.5, forces, force));
}

TEST_P(Control, GetSaysWhatParametersAreNow) {
  start();
  const auto get = [&](const std::string& name) -> Outcome {
    ChildProcess process(
        {program_path("cordis"), "get", session_.launch_file(), name, "--timeout", "60s"});
    const int code = process.wait(kPatience);
    return {code, process.output()};
  };
  for (const std::string name : {"wall", "wall.stiffness_n_per_m"}) {
    const Outcome before = get(name);
    EXPECT_EQ(before.code, 0);
    EXPECT_EQ(before.output, "wall.stiffness_n_per_m = 200\n");
  }
  expect_done({"set", "wall.stiffness_n_per_m=350"}, "sim: wall.stiffness_n_per_m = 350 at step ");
  EXPECT_EQ(get("wall").output, "wall.stiffness_n_per_m = 350\n");
  expect_done({"load", "stiff.yaml"}, "sim: ");
  EXPECT_EQ(get("wall").output, "wall.stiffness_n_per_m = 400\n");

  ChildProcess all({program_path("cordis"), "get", session_.launch_file(), "--timeout", "60s"});
  EXPECT_EQ(all.wait(kPatience), 0);
  EXPECT_NE(all.output().find("wall.stiffness_n_per_m = 400\n"), std::string::npos) << all.output();
  EXPECT_NE(all.output().find("world."), std::string::npos) << all.output();

  const Outcome mistyped = get("wal");
  EXPECT_EQ(mistyped.code, 2);
  EXPECT_NE(mistyped.output.find("did you mean 'wall'?"), std::string::npos) << mistyped.output;
}

/// A link of a liaison with states, put into its other state by hand.
TEST(ControlOfStates, StatePutsALinkIntoAStateAndAnEventReports) {
  LiveSession session("asap", "  sim: {node: sim_node, scene: scene.yaml}\n");
  session.add_file("scene.yaml",
                   R"(cordis: 1
name: fuse
space: 1
step: {rate_hz: 1000}
liaisons:
  fuse:
    start: whole
    states:
      whole: {stiffness_n_per_m: 10, exits: [{to: broken, when: "elongation_m > 1"}]}
      broken: {exits: [{to: whole, when: "elongation_m < -1"}]}
matter:
  wall: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 1, at_m: 0.1}
links:
  - {name: joint, liaison: fuse, between: [wall, bob]}
)");
  dds::Reader<msg::SceneEvents> events(session.participant(), dds::Topic::kEvents);
  StatusWatch status(session.participant());
  session.start("sim_node", "sim");
  ASSERT_TRUE(status.wait_for_phase("sim", msg::PHASE_RUNNING));
  ASSERT_TRUE(eventually([&] { return events.matched_count() == 1; }));

  ChildProcess process({program_path("cordis"), "ctl", session.launch_file(), "state", "joint",
                        "broken", "--timeout", "60s"});
  ASSERT_EQ(process.wait(kPatience), 0) << process.output();
  EXPECT_NE(process.output().find("sim: 1 link put into 'broken' at step "), std::string::npos)
      << process.output();
  msg::SceneEvents batch;
  ASSERT_TRUE(eventually([&] { return events.take(batch); }));
  ASSERT_EQ(batch.event().size(), 1u);
  EXPECT_EQ(batch.event()[0].link(), 0u);
  EXPECT_EQ(batch.event()[0].from_state(), 0u);
  EXPECT_EQ(batch.event()[0].to_state(), 1u);
  EXPECT_EQ(batch.event()[0].quantity(), msg::QUANTITY_NONE);
  EXPECT_TRUE(status.wait_for("sim", [](const msg::NodeStatus& now) {
    return now.changes().size() == 1 && now.changes()[0].liaison() == "fuse" &&
           now.changes()[0].changes() == 1;
  }));
}

TEST_P(Control, ASceneWithErrorsIsRefusedWithThemAllAndTheOldOneGoesOn) {
  start();
  expect_refused({"load", "bad.yaml"}, "bad.yaml:2:8: error: something is wrong here\n");
  // `cordis ctl` itself says it where it can read the file.
  expect_refused({"load", (session_.folder() / "bad.yaml").string()},
                 "bad.yaml:2:8: error: 'space' in scene must be between 1 and 3, got 7");
  expect_refused({"load", "nowhere.yaml"}, "cannot be read");
  expect_refused({"load", "nowhere/scene.yaml"},
                 "error: there is no such file, neither where `cordis ctl` was called nor in '");
  expect_refused({"load", "wide.yaml"},
                 "wide.yaml:11:75: error: port 'key' needs a travel of 0.05 m, and axis 0 of the "
                 "device 'keyboard' has 0.04 m");
  EXPECT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
  EXPECT_TRUE(
      status_.wait_for("sim", [](const msg::NodeStatus& status) { return status.step() > 1000; }));
}

INSTANTIATE_TEST_SUITE_P(Clocks, Control, ::testing::Values("realtime", "lockstep"),
                         [](const auto& instance) { return std::string(instance.param); });

class ControlWithoutDevices : public Control {
 protected:
  ControlWithoutDevices() : Control("asap") { session_.add_file("scene.yaml", kFreeScene); }
};

TEST_F(ControlWithoutDevices, ASceneAsFastAsPossibleExecutesThemTheSame) {
  session_.start("sim_node", "sim");
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
  expect_done({"pause"}, "sim: paused at step ");
  expect_done({"reset"}, "'free' restarts, paused");
  EXPECT_EQ(step_shown(), 0u);
  expect_steps({"step", "100000"}, 100000);
  expect_done({"load", "scene.yaml"}, "'free' begins, paused");
  expect_done({"resume"}, "goes on at step 0");
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
}

class ControlInRealtime : public Control {
 protected:
  ControlInRealtime() : Control("realtime") {}

  void runs_at(double rate_hz) {
    for (const char* node : {"sim", "keyboard"}) {
      EXPECT_TRUE(status_.wait_for(node, [&](const msg::NodeStatus& now) {
        return std::abs(now.target_rate_hz() - rate_hz) < 1e-6 && now.phase() == msg::PHASE_RUNNING;
      })) << node;
    }
  }
};

TEST_F(ControlInRealtime, TheKeyFeelsNothingWhileTheScenePausesAndComesBackGradually) {
  start();
  dds::Reader<msg::GestureForces> forces(session_.participant(), dds::Topic::kForces);
  msg::GestureForces force;
  ASSERT_TRUE(feels(2.0, forces, force));

  expect_done({"pause"}, "paused");
  ASSERT_TRUE(feels(0.0, forces, force));
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(eventually([&] { return forces.take(force); }));
    EXPECT_EQ(force.force_n()[0], 0.0);
  }
  EXPECT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING))
      << "it is answered all the time";

  expect_done({"resume"}, "goes on");
  double before = 0.0;
  std::uint64_t sample = force.sample();
  ASSERT_TRUE(eventually([&] {
    while (forces.take(force)) {
      // 100 equal parts of the force in 100 answers, of which some may be lost on the way.
      const auto answers = static_cast<double>(force.sample() - sample);
      EXPECT_LE(force.force_n()[0] - before, answers * 2.0 / 99.0);
      before = force.force_n()[0];
      sample = force.sample();
    }
    return std::abs(before - 2.0) < 1e-9;
  }));
}

/// Steps per second of a sim_node, between two of its statuses.
double pace_between(const msg::NodeStatus& begin, const msg::NodeStatus& end) {
  return static_cast<double>(end.step() - begin.step()) /
         static_cast<double>(end.time_nsec() - begin.time_nsec());
}

/// The pace of the slow one is compared with that of the same session before, whatever the machine.
TEST_F(ControlInRealtime, SlowMotionIsFollowedByTheKeyAndSilencesNobody) {
  start();
  const auto pace = [&](std::uint64_t steps) {
    const msg::NodeStatus begin = status_.of("sim");
    EXPECT_TRUE(status_.wait_for(
        "sim", [&](const msg::NodeStatus& now) { return now.step() > begin.step() + steps; }));
    return pace_between(begin, status_.of("sim"));
  };
  runs_at(1000.0);
  const double full = pace(8000);

  expect_done({"rate", "0.1"}, "sim: plays 0.1 times as fast as in real time");
  runs_at(100.0);
  EXPECT_NEAR(pace(800) / full, 0.1, 0.05);
  dds::Reader<msg::GestureForces> forces(session_.participant(), dds::Topic::kForces);
  msg::GestureForces force;
  EXPECT_TRUE(feels(2.0, forces, force));

  // Its periods are longer than the watchdogs of both sides.
  expect_done({"rate", "0.01"}, "plays 0.01 times");
  runs_at(10.0);
  const msg::NodeStatus sim = status_.of("sim");
  const msg::NodeStatus key = status_.of("keyboard");
  EXPECT_NEAR(pace(80) / full, 0.01, 0.005);
  EXPECT_TRUE(feels(2.0, forces, force)) << "it grows again after a stall of the machine";
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(eventually([&] { return forces.take(force); }));
    EXPECT_NEAR(force.force_n()[0], 2.0, 1e-9);
  }
  runs_at(10.0);
  EXPECT_EQ(status_.of("sim").silent_ticks(), sim.silent_ticks());
  EXPECT_EQ(status_.of("keyboard").silent_ticks(), key.silent_ticks());

  expect_done({"pause"}, "paused at step ");
  expect_done({"resume"}, "goes on at step ");
  expect_done({"rate", "1"}, "plays in real time");
  runs_at(1000.0);
  EXPECT_TRUE(feels(2.0, forces, force));
  EXPECT_NEAR(pace(8000) / full, 1.0, 0.5);

  expect_refused({"rate", "2"}, "the rate of a simulation must be between 0.01 and 1, got 2");
  expect_done({"rate", "0.5"}, "plays 0.5 times");
  expect_done({"load", "stiff.yaml"}, "'wall' begins");
  runs_at(1000.0);
}

/// Steps of the scene and ticks of the key are counted over the same time, whatever that is.
TEST_F(ControlInRealtime, ADeviceThatRestartsInSlowMotionComesBackAtTheSlowPace) {
  start();
  expect_done({"rate", "0.1"}, "sim: plays 0.1 times as fast as in real time");
  runs_at(100.0);
  const std::uint64_t old_epoch = status_.of("keyboard").epoch();
  session_.node("keyboard").signal(SIGKILL);
  ASSERT_EQ(session_.node("keyboard").wait(kPatience), 128 + SIGKILL);
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_WAITING));

  session_.start("device_node", "keyboard");
  ASSERT_TRUE(status_.wait_for("keyboard", [&](const msg::NodeStatus& now) {
    return now.epoch() != old_epoch && now.phase() == msg::PHASE_RUNNING;
  }));
  runs_at(100.0);
  dds::Reader<msg::GestureForces> forces(session_.participant(), dds::Topic::kForces);
  msg::GestureForces force;
  EXPECT_TRUE(feels(2.0, forces, force));

  const std::uint64_t step = status_.of("sim").step();
  const std::uint64_t ticks = status_.of("keyboard").ticks();
  ASSERT_TRUE(status_.wait_for(
      "keyboard", [&](const msg::NodeStatus& now) { return now.ticks() > ticks + 500; }));
  EXPECT_GT(status_.of("sim").step(), step + 250) << "a key at full pace is ten times as fast";
}

/// A process that describes the keyboard as one that moves something real, as long as this lives.
class RealKeyboard {
 public:
  explicit RealKeyboard(dds::ParticipantConfig config)
      : participant_((config.node = "real", std::move(config))),
        writer_(participant_, dds::Topic::kDevice) {
    msg::DeviceDescription description;
    description.device_id(config::name_hash("keyboard"));
    description.device("keyboard");
    description.driver("kfb1");
    description.epoch(1);
    description.coordinate_count(1);
    description.rate_hz(1000.0);
    description.moving_mass_kg(0.05);
    description.force_n()[0] = 20.0;
    EXPECT_TRUE(writer_.write(description));
  }

 private:
  dds::Participant participant_;
  dds::Writer<msg::DeviceDescription> writer_;
};

/// Statuses come 0.5 s apart; one that says at once that the pace is another comes earlier.
TEST_F(ControlInRealtime, ARealDeviceEndsSlowMotionAndTheStatusSaysSoAtOnce) {
  start();
  bool is_at_once = false;
  for (int times = 0; !is_at_once && times < 5; ++times) {
    ASSERT_TRUE(eventually([&] { return ctl({"rate", "0.5"}).code == 0; })) << "the last one left";
    ASSERT_TRUE(status_.wait_for("sim", [](const msg::NodeStatus& now) {
      return now.target_rate_hz() == 500.0 &&
             now.text().ends_with("plays 0.5 times as fast as in real time");
    }));
    std::vector<std::int64_t> sent_nsec;
    const RealKeyboard real(session_.participant().config());
    ASSERT_TRUE(status_.wait_for("sim", [&](const msg::NodeStatus& now) {
      sent_nsec.push_back(now.time_nsec());
      return now.target_rate_hz() == 1000.0 && now.text().find("plays 0.5") == std::string::npos;
    }));
    std::erase(sent_nsec, sent_nsec.back());
    ASSERT_FALSE(sent_nsec.empty());
    is_at_once = status_.of("sim").time_nsec() - sent_nsec.back() < 500'000'000;
  }
  EXPECT_TRUE(is_at_once);
}

TEST_P(Control, SlowMotionIsOfRealtimeSessionsAlone) {
  start();
  if (GetParam() == std::string("realtime")) {
    expect_done({"rate", "0.5"}, "plays 0.5 times as fast as in real time");
  } else {
    expect_refused({"rate", "0.5"}, "'rate' is for realtime sessions, and this one is not");
  }
}

/// Sends a command again and again, and counts the replies of each node.
class Asking {
 public:
  explicit Asking(dds::Participant& participant)
      : commands_(participant, dds::Topic::kCommand), replies_(participant, dds::Topic::kReply) {}

  /// Until both nodes have answered once more: a node that has not found this participant yet
  /// misses a command, or its reply is lost.
  ::testing::AssertionResult ask(msg::ControlCommand& command) {
    std::map<std::string, int> before = answers_;
    const auto have_answered = [&] {
      take_all(command.command_id());
      return answers_["sim"] > before["sim"] && answers_["keyboard"] > before["keyboard"];
    };
    for (int i = 0; i < 200 && !have_answered(); ++i) {
      EXPECT_TRUE(commands_.write(command));
      ++sent_;
      const auto next = std::chrono::steady_clock::now() + 600ms;
      while (!have_answered() && std::chrono::steady_clock::now() < next) replies_.wait(5ms);
    }
    if (!have_answered()) return ::testing::AssertionFailure() << "a node does not answer";
    return ::testing::AssertionSuccess();
  }

  int sent() const { return sent_; }
  const std::map<std::string, int>& answers() const { return answers_; }
  const std::string& text_of(const std::string& node) { return texts_[node]; }

 private:
  void take_all(std::uint64_t id) {
    for (msg::ControlReply reply; replies_.take(reply);) {
      EXPECT_EQ(reply.command_id(), id);
      ++answers_[reply.node()];
      texts_[reply.node()] = reply.text();
    }
  }

  dds::Writer<msg::ControlCommand> commands_;
  dds::Reader<msg::ControlReply> replies_;
  int sent_ = 0;
  std::map<std::string, int> answers_;
  std::map<std::string, std::string> texts_;
};

TEST_F(ControlInRealtime, EveryNodeAnswersACommandForAllJustOnce) {
  start();
  Asking asking(session_.participant());
  msg::ControlCommand command;
  command.sender("test");
  command.target("*");
  command.verb(msg::VERB_PAUSE);
  command.command_id(1);
  ASSERT_TRUE(asking.ask(command));
  EXPECT_EQ(asking.answers().size(), 2u);

  // Sent again, it is answered again and not executed again.
  command.verb(msg::VERB_RESUME);
  ASSERT_TRUE(asking.ask(command));
  EXPECT_EQ(asking.text_of("sim").find("goes on"), std::string::npos);
  for (const auto& [node, count] : asking.answers()) EXPECT_LE(count, asking.sent()) << node;
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_PAUSED));
}

TEST_F(ControlInRealtime, WhoHasNothingToDoSaysSo) {
  start();
  expect_refused({"pause", "--node", "keyboard"},
                 "keyboard: a device_node has nothing to do at 'pause'");
  expect_done({"pause", "--node", "*"}, "sim: paused at step ");
}

TEST_F(ControlInRealtime, WithoutASimulationTheCommandEndsInOneClearMessage) {
  Outcome outcome = ctl({"pause"}, "1s");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(
      outcome.output.find("no node is in session 'test' of domain " + std::to_string(own_domain())),
      std::string::npos)
      << outcome.output;

  session_.start("device_node", "keyboard");
  ASSERT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_WAITING));
  EXPECT_TRUE(eventually([&] {
    outcome = ctl({"pause"}, "5s");
    EXPECT_EQ(outcome.code, 1);
    return outcome.output.find("no sim_node is in session 'test'") != std::string::npos &&
           outcome.output.find("only 'keyboard'") != std::string::npos;
  })) << outcome.output;
}

TEST(ControlByName, FindsTheSessionInWhicheverDomainItRuns) {
  const std::string name = "by-name-" + std::to_string(getpid());
  LiveSession session("asap", "  sim: {node: sim_node, scene: scene.yaml}\n", name);
  session.add_file("scene.yaml", kFreeScene);
  StatusWatch status(session.participant());
  session.start("sim_node", "sim");
  ASSERT_TRUE(status.wait_for_phase("sim", msg::PHASE_RUNNING));

  ChildProcess process({program_path("cordis"), "ctl", name, "pause", "--timeout", "60s"});

  EXPECT_EQ(process.wait(kPatience), 0) << process.output();
  ASSERT_TRUE(status.wait_for_phase("sim", msg::PHASE_PAUSED));
}

/// Another session of a name, as the registry of this host records it.
std::unique_ptr<node::SessionRegistration> register_twin(const std::string& session,
                                                         const std::string& launch_file) {
  constexpr int kFirstOfTests = 10;
  for (int domain = 0; domain < kFirstOfTests; ++domain) {
    try {
      return std::make_unique<node::SessionRegistration>(
          node::runtime_folder(),
          node::SessionRequest{session, domain, launch_file, {"sim-of-the-twin"}});
    } catch (const std::runtime_error&) {  // the domain is taken
    }
  }
  return nullptr;
}

TEST_F(ControlInRealtime, OfTwoSessionsOfOneNameTheLaunchFileSaysWhich) {
  start();
  const auto twin = register_twin("test", "/elsewhere/launch.yaml");
  ASSERT_TRUE(twin);

  expect_done({"pause"}, "sim: paused at step ");

  ChildProcess by_name({program_path("cordis"), "ctl", "test", "pause"});
  EXPECT_EQ(by_name.wait(kPatience), 1);
  EXPECT_NE(by_name.output().find("session 'test' runs in domains "), std::string::npos)
      << by_name.output();
}

TEST_F(ControlInRealtime, BadWordsAreRefusedBeforeAnythingIsSent) {
  expect_refused({"paws"}, "there is no command 'paws', did you mean 'pause'?");
  expect_refused({"load"}, "write: load SCENE");
  expect_refused({"pause", "--timeout", "soon"}, "soon");
  expect_refused({"pause", "--domain", "500"}, "domain");
}

/// Whoever takes part in a session may send `load`: the reply says nothing of files that are not
/// scenes below the folder of the launch file.
class ControlOfFiles : public ControlInRealtime {
 protected:
  ControlOfFiles() {
    std::filesystem::create_directory(elsewhere_);
    std::ofstream(elsewhere_ / "scene.yaml") << wall_scene(400.0);
    std::ofstream(elsewhere_ / "secret") << "password swordfish\n";
  }
  ~ControlOfFiles() override { std::filesystem::remove_all(elsewhere_); }

  /// As another program of the session sends it, whatever `cordis ctl` makes of a path.
  std::string answer_to_load(const std::string& path) {
    dds::Writer<msg::ControlCommand> commands(session_.participant(), dds::Topic::kCommand);
    dds::Reader<msg::ControlReply> replies(session_.participant(), dds::Topic::kReply);
    EXPECT_TRUE(
        eventually([&] { return commands.matched_count() == 2 && replies.matched_count() == 2; }));
    msg::ControlCommand command;
    command.sender("test");
    command.target("sim_node");
    command.verb(msg::VERB_LOAD);
    command.argument("'" + path + "'");
    command.command_id(++commands_);
    // sim_node may know of this reader later than this reader of sim_node: until then no reply comes.
    msg::ControlReply reply;
    auto next = std::chrono::steady_clock::now();
    EXPECT_TRUE(eventually([&] {
      if (std::chrono::steady_clock::now() >= next) {
        EXPECT_TRUE(commands.write(command));
        next += std::chrono::seconds(1);
      }
      return replies.take(reply) && reply.command_id() == command.command_id();
    })) << path;
    EXPECT_FALSE(reply.accepted()) << path;
    EXPECT_EQ(reply.text().find("swordfish"), std::string::npos) << reply.text();
    EXPECT_EQ(reply.text().find("password"), std::string::npos) << reply.text();
    return reply.text();
  }

  std::filesystem::path elsewhere_ = session_.folder().string() + "-elsewhere";
  std::uint64_t commands_ = 0;
};

TEST_F(ControlOfFiles, AreLoadedFromBelowTheFolderOfTheLaunchFileAlone) {
  start();
  const std::filesystem::path folder = session_.folder();
  std::filesystem::create_directory_symlink(elsewhere_, folder / "link");
  std::filesystem::create_symlink(elsewhere_ / "scene.yaml", folder / "linked.yaml");
  const std::string name = elsewhere_.filename().string();
  for (const std::string& path :
       {(elsewhere_ / "scene.yaml").string(), (elsewhere_ / "secret").string(),
        "../" + name + "/scene.yaml", "../" + name + "/secret", std::string("link/scene.yaml"),
        std::string("linked.yaml"), std::string("/etc/passwd"), std::string("/dev/zero"),
        std::string("/etc/no_such_file"), folder.string(), std::string("..")}) {
    EXPECT_NE(answer_to_load(path).find("the folder of the launch file, from where alone scenes"),
              std::string::npos)
        << path;
  }
  std::filesystem::create_directory(folder / "more");
  session_.add_file("more/stiff.yaml", wall_scene(400.0));
  std::filesystem::create_symlink(folder / "more" / "stiff.yaml", folder / "inside.yaml");
  expect_done({"load", "more/../inside.yaml"}, "'wall' begins");
}

TEST_F(ControlOfFiles, ThatAreNoScenesAreNotQuoted) {
  start();
  session_.add_file("secret", "password swordfish\n");
  session_.add_file("secret.yaml", "password: swordfish\nspace: [swordfish\n");
  session_.add_file("broken.yaml", R"(cordis: 1
space: [1, 2
name: not_quoted
)");
  for (const char* path : {"secret", "secret.yaml"}) {
    EXPECT_NE(answer_to_load(path).find("this is no scene: it has no line that begins with"),
              std::string::npos)
        << path;
  }
  const std::string text = answer_to_load("broken.yaml");
  EXPECT_NE(text.find("broken.yaml:3:"), std::string::npos) << "the place is reported: " << text;
  EXPECT_EQ(text.find("not_quoted"), std::string::npos) << text;
}

/// A scene that names the other files it is made of in its last lines.
std::string wall_scene_with(const std::string& lines) {
  return wall_scene(400.0) + lines;
}

TEST_F(ControlOfFiles, ThatASceneNamesLieBelowTheFolderToo) {
  start();
  const std::string name = elsewhere_.filename().string();
  std::ofstream(elsewhere_ / "liaisons.yaml") << R"(cordis: 1
liaisons:
  swordfish: {kind: spring, stiffness_n_per_m: 1}
)";
  std::filesystem::create_symlink(elsewhere_ / "secret", session_.folder() / "linked");
  std::filesystem::create_symlink(elsewhere_, session_.folder() / "link");
  for (const std::string& file :
       {(elsewhere_ / "secret").string(), "../" + name + "/secret", std::string("linked"),
        "../" + name + "/liaisons.yaml", std::string("link/liaisons.yaml"),
        std::string("/etc/passwd"), std::string("/etc/no_such_file")}) {
    for (const std::string& lines :
         {"start_state: " + file + "\n", "parts: {include: '" + file + "'}\n"}) {
      session_.add_file("names.yaml", wall_scene_with(lines));
      const std::string text = answer_to_load("names.yaml");
      EXPECT_NE(text.find(": error: a file named here is not below the folder of the launch file, "
                          "from where alone files are loaded"),
                std::string::npos)
          << lines << text;
      EXPECT_EQ(text.find("root"), std::string::npos) << text;
    }
  }
}

TEST_F(ControlOfFiles, OfCordisAreNotQuotedEither) {
  start();
  session_.add_file("private.yaml", R"(cordis: 1
password: swordfish
space: swordfish
)");
  session_.add_file("list", "password swordfish\n");
  session_.add_file("state", wall_scene_with("start_state: list\n"));
  session_.add_file("part", wall_scene_with("parts: {include: list}\n"));
  session_.add_file("missing", wall_scene_with("parts: {include: swordfish}\n"));
  for (const char* file : {"private.yaml", "state", "part", "missing"}) {
    const std::string text = answer_to_load(file);
    EXPECT_NE(text.find(": error: something is wrong here\n"), std::string::npos) << text;
    EXPECT_NE(text.find("`cordis check` of the file, and the log of this node, say what is wrong"),
              std::string::npos)
        << text;
  }
  EXPECT_TRUE(session_.node("sim").wait_for_output("unknown key 'password' in scene", kPatience));
}

TEST_F(ControlOfFiles, ThatNobodyWritesToDoNotHoldUpTheNode) {
  start();
  const std::filesystem::path fifo = session_.folder() / "fifo.yaml";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_NE(answer_to_load("fifo.yaml").find("it is a FIFO, and a regular file is wanted"),
            std::string::npos);
  expect_done({"pause"}, "paused");
  session_.node("sim").signal(SIGTERM);
  EXPECT_EQ(session_.node("sim").wait(kPatience), 0);
}

/// A scene whose reading takes seconds: dense balls without order.
constexpr const char* kSlowToRead = R"(cordis: 1
name: slow_to_read
space: 3
step: {rate_hz: 1000}
matter:
  a: {kind: pack, ball: {mass_kg: 0.001, radius_m: 0.001}, region: {from_m: [0, 0, 0], to_m: [0.05, 0.05, 0.05]}, fill: 0.58}
)";

TEST_F(ControlInRealtime, APauseOvertakesALoadThatIsBeingRead) {
  session_.add_file("slow.yaml", kSlowToRead);
  start();
  dds::Writer<msg::ControlCommand> commands(session_.participant(), dds::Topic::kCommand);
  dds::Reader<msg::ControlReply> replies(session_.participant(), dds::Topic::kReply);
  ASSERT_TRUE(
      eventually([&] { return commands.matched_count() == 2 && replies.matched_count() == 2; }));
  const auto send = [&](std::uint64_t id, msg::ControlVerb verb, const std::string& argument) {
    msg::ControlCommand command;
    command.sender("test");
    command.target("sim_node");
    command.command_id(id);
    command.verb(verb);
    command.argument(argument);
    EXPECT_TRUE(commands.write(command));
  };
  constexpr std::uint64_t kLoad = 1;
  constexpr std::uint64_t kSecondLoad = 2;
  constexpr std::uint64_t kPause = 3;
  send(kLoad, msg::VERB_LOAD, "'slow.yaml'");
  send(kSecondLoad, msg::VERB_LOAD, "'stiff.yaml'");
  send(kPause, msg::VERB_PAUSE, "");
  std::vector<msg::ControlReply> answers;
  ASSERT_TRUE(eventually([&] {
    msg::ControlReply reply;
    if (replies.take(reply)) answers.push_back(reply);
    return answers.size() == 3;
  }));
  EXPECT_EQ(answers[0].command_id(), kSecondLoad) << answers[0].text();
  EXPECT_FALSE(answers[0].accepted()) << answers[0].text();
  EXPECT_NE(answers[0].text().find("is still under way"), std::string::npos) << answers[0].text();
  EXPECT_EQ(answers[1].command_id(), kPause) << answers[1].text();
  EXPECT_EQ(answers[1].text().find("paused at step "), 0u) << answers[1].text();
  EXPECT_EQ(answers[2].command_id(), kLoad) << answers[2].text();
  EXPECT_NE(answers[2].text().find("'slow_to_read' begins, paused"), std::string::npos)
      << answers[2].text();
}

TEST_F(ControlInRealtime, AStopEndsAPausedScene) {
  start();
  expect_done({"pause"}, "paused");
  session_.node("sim").signal(SIGTERM);
  EXPECT_EQ(session_.node("sim").wait(kPatience), 0);
}

}  // namespace
}  // namespace cordis::test
