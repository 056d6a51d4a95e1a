// tests/sim/command_executor_test.cpp
#include "sim_node/run/command_executor.h"

#include <atomic>
#include <functional>
#include <future>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/checks/stability_check.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/run/runner.h"
#include "tests/sim/loaded_scenes.h"

namespace cordis::sim {
namespace {

/// The wall holds the bob by two springs that are merged.
std::string merged_text() {
  return R"(cordis: 1
name: merged
space: 1
step: {rate_hz: 4000}
reduce: [parallel]
liaisons:
  spring: {kind: spring, stiffness_n_per_m: 100}
  rubber: {kind: spring_damper, stiffness_n_per_m: 7, viscosity_n_s_per_m: 0.1}
matter:
  wall: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 0.1, at_m: 0.01}
links:
  - {liaison: spring, between: [wall, bob], rest_m: 0}
  - {liaison: rubber, between: [wall, bob], rest_m: 0}
)";
}

/// A director and a loop in another thread that plays for it as fast as it can.
class CommandExecutorTest : public ::testing::Test {
 protected:
  CommandExecutorTest()
      : runner_(loaded_scene_of(swing_text()), false),
        executor_(
            mailbox_, runner_.simulation().shared_scene(), kEpochOfSim,
            [this](const std::string& path, config::Problems& problems) {
              if (path == "merged.yaml") {
                return plan::reduce(scene::load_scene_text(merged_text(), path, problems),
                                    problems);
              }
              if (path == "slow.yaml") {
                may_read_.get_future().wait();
                return scene::load_scene_text(swing_text("slow"), path, problems);
              }
              return scene::load_scene_text(
                  path == "other.yaml" ? swing_text("other") : "cordis: 2", path, problems);
            },
            [](const scene::Scene& scene, config::Problems& problems) {
              check_stability(scene, false, problems);
            },
            [this](const scene::Scene& scene, std::uint64_t version) {
              published_.push_back(scene.name + " " + std::to_string(version));
            }),
        loop_([this] { play(); }) {}

  ~CommandExecutorTest() override { end_loop(); }

  void end_loop() {
    ending_ = true;
    if (loop_.joinable()) loop_.join();
  }

  node::Answer execute(msg::ControlVerb verb, const std::string& argument = "") {
    msg::ControlCommand command;
    command.verb(verb);
    command.argument(argument);
    return executor_.execute(command);
  }

  void play() {
    while (!ending_) {
      if (Request* request = mailbox_.waiting()) {
        runner_.execute(*request);
        mailbox_.report_steps_left(runner_.steps_left());
        mailbox_.executed();
      }
      runner_.advance();
      mailbox_.report_steps_left(runner_.steps_left());
    }
    mailbox_.close();
  }

  std::promise<void> may_read_;  // slow.yaml
  RequestMailbox mailbox_;
  Runner runner_;
  std::vector<std::string> published_;
  CommandExecutor executor_;
  std::atomic<bool> ending_{false};
  std::thread loop_;
};

TEST_F(CommandExecutorTest, PausesAndResumes) {
  const node::Answer paused = execute(msg::VERB_PAUSE);
  EXPECT_TRUE(paused.accepted);
  EXPECT_EQ(paused.text.find("paused at step "), 0u) << paused.text;
  EXPECT_EQ(execute(msg::VERB_PAUSE).text.find("was paused already at step "), 0u);
  EXPECT_EQ(execute(msg::VERB_RESUME).text.find("goes on at step "), 0u);
  EXPECT_EQ(execute(msg::VERB_RESUME).text.find("was running already at step "), 0u);
}

TEST_F(CommandExecutorTest, AnswersWhenTheSingleStepsAreDone) {
  execute(msg::VERB_PAUSE);
  execute(msg::VERB_RESET);
  EXPECT_EQ(execute(msg::VERB_STEP).text, "paused at step 1");
  EXPECT_EQ(execute(msg::VERB_STEP, "9").text, "paused at step 10");
  end_loop();
  EXPECT_EQ(runner_.simulation().world().step_count(), 10u);
}

TEST_F(CommandExecutorTest, SaysThatAPauseEndsSingleSteps) {
  EXPECT_NE(execute(msg::VERB_STEP, "1000000000").text.find(" begun at step "), std::string::npos);
  const node::Answer paused = execute(msg::VERB_PAUSE);
  EXPECT_EQ(paused.text.find("stopped at step "), 0u) << paused.text;
  EXPECT_NE(paused.text.find(" single steps to go"), std::string::npos) << paused.text;
  EXPECT_EQ(execute(msg::VERB_PAUSE).text.find("was paused already at step "), 0u);
}

TEST_F(CommandExecutorTest, SaysEveryParameterOfTheSceneWhenNoneIsNamed) {
  execute(msg::VERB_SET, "{spring.stiffness_n_per_m: 101}");
  const node::Answer answer = execute(msg::VERB_GET);
  EXPECT_TRUE(answer.accepted);
  EXPECT_EQ(answer.text,
            execute(msg::VERB_GET, "spring").text + '\n' + execute(msg::VERB_GET, "world").text);
  EXPECT_NE(answer.text.find("spring.stiffness_n_per_m = 101"), std::string::npos) << answer.text;
}

TEST_F(CommandExecutorTest, PausesWhileAnotherThreadReadsAScene) {
  msg::ControlCommand load;
  load.verb(msg::VERB_LOAD);
  load.argument("slow.yaml");
  const node::Work work = executor_.work_of(load);
  ASSERT_TRUE(work);
  std::future<node::Finish> reading = std::async(std::launch::async, work);

  EXPECT_EQ(execute(msg::VERB_PAUSE).text.find("paused at step "), 0u);
  EXPECT_EQ(execute(msg::VERB_SET, "{spring.stiffness_n_per_m: 101}").accepted, true);
  EXPECT_TRUE(published_.empty());

  may_read_.set_value();
  const node::Answer answer = reading.get()();
  EXPECT_EQ(answer.text.find("'slow' begins, paused; the scene before ended at step "), 0u)
      << answer.text;
  EXPECT_EQ(published_, std::vector<std::string>{"slow 2"});
  load.verb(msg::VERB_PAUSE);
  EXPECT_FALSE(executor_.work_of(load)) << "not long";
}

TEST_F(CommandExecutorTest, BeginsTheSceneAnew) {
  execute(msg::VERB_PAUSE);
  const node::Answer answer = execute(msg::VERB_RESET);
  EXPECT_TRUE(answer.accepted);
  EXPECT_EQ(answer.text.find("'swing' restarts, paused; the scene before ended at step "), 0u)
      << answer.text;
  end_loop();
  EXPECT_EQ(runner_.simulation().world().step_count(), 0u);
  EXPECT_EQ(published_, std::vector<std::string>{"swing 2"});
}

TEST_F(CommandExecutorTest, LoadsAnotherSceneAndPublishesIt) {
  const node::Answer answer = execute(msg::VERB_LOAD, "other.yaml");
  EXPECT_TRUE(answer.accepted);
  EXPECT_EQ(answer.text.find("'other' begins; the scene before ended at step "), 0u) << answer.text;
  execute(msg::VERB_RESET);
  end_loop();
  EXPECT_EQ(runner_.simulation().scene().name, "other");
  EXPECT_EQ(runner_.loaded_scene().frames.shape().version, 3u);
  EXPECT_EQ(published_, (std::vector<std::string>{"other 2", "other 3"}));
}

TEST_F(CommandExecutorTest, SetsParametersOfALiaisonWhoseLinksAreMergedWithOthers) {
  ASSERT_TRUE(execute(msg::VERB_LOAD, "merged.yaml").accepted);

  const node::Answer answer = execute(msg::VERB_SET, "{rubber.stiffness_n_per_m: 11}");

  EXPECT_TRUE(answer.accepted) << answer.text;
  EXPECT_TRUE(execute(msg::VERB_SET, "{spring.stiffness_n_per_m: 90}").accepted);
  end_loop();
  const engine::NetworkDescription& network = runner_.simulation().scene().network;
  ASSERT_EQ(network.links.size(), 1u);
  EXPECT_EQ(network.links[0].stiffness, 101.0);
  EXPECT_EQ(network.links[0].viscosity, 0.1);
  EXPECT_GT(runner_.simulation().world().step_count(), 0u);
}

TEST_F(CommandExecutorTest, SetsParametersOfALiaisonInTheRunningScene) {
  const node::Answer answer =
      execute(msg::VERB_SET, "{spring.stiffness_n_per_m: 250, spring.viscosity_n_s_per_m: 0.5}");
  EXPECT_TRUE(answer.accepted) << answer.text;
  EXPECT_EQ(
      answer.text.find("spring.stiffness_n_per_m = 250, spring.viscosity_n_s_per_m = 0.5 at step "),
      0u)
      << answer.text;
  execute(msg::VERB_SET, "{spring.stiffness_n_per_m: 300}");
  end_loop();
  for (const engine::Link& link : runner_.simulation().world().network().description().links) {
    EXPECT_EQ(link.stiffness, 300.0);
    EXPECT_EQ(link.viscosity, 0.5) << "set before, and kept";
  }
  EXPECT_GT(runner_.simulation().world().step_count(), 0u);
  EXPECT_EQ(runner_.loaded_scene().frames.shape().version, 1u) << "it is the same scene";
  EXPECT_TRUE(published_.empty());
}

TEST_F(CommandExecutorTest, SetsTheWorldOfTheRunningScene) {
  const node::Answer answer =
      execute(msg::VERB_SET, "{world.gravity_m_per_s2: -9.8, world.viscosity_n_s_per_m: 0.2}");
  EXPECT_TRUE(answer.accepted) << answer.text;
  EXPECT_EQ(execute(msg::VERB_GET, "world").text,
            "world.gravity_m_per_s2 = -9.8\nworld.viscosity_n_s_per_m = 0.2");
  execute(msg::VERB_SET, "{spring.stiffness_n_per_m: 300}");
  end_loop();
  const engine::NetworkDescription& network = runner_.simulation().world().network().description();
  EXPECT_EQ(network.gravity.x(), -9.8) << "set before, and kept";
  EXPECT_EQ(network.medium_viscosity, 0.2);
  EXPECT_EQ(runner_.loaded_scene().frames.shape().version, 1u) << "it is the same scene";
}

TEST_F(CommandExecutorTest, SetsAllOrNothing) {
  const node::Answer answer =
      execute(msg::VERB_SET, "{spring.stiffness_n_per_m: 250, sprig.mass_kg: 1}");
  EXPECT_FALSE(answer.accepted);
  EXPECT_NE(answer.text.find("did you mean 'spring'?"), std::string::npos) << answer.text;
  EXPECT_FALSE(execute(msg::VERB_SET, "{spring.stifness_n_per_m: 250}").accepted);
  EXPECT_FALSE(execute(msg::VERB_SET, "{spring.stiffness_n_per_m: -5}").accepted);
  EXPECT_TRUE(execute(msg::VERB_SET, "{spring.viscosity_n_s_per_m: 0.2}").accepted);
  end_loop();
  EXPECT_EQ(runner_.simulation().world().network().description().links[0].stiffness, 100.0);
}

TEST_F(CommandExecutorTest, RefusesAValueWithWhichTheSceneDiverges) {
  const node::Answer answer = execute(msg::VERB_SET, "{spring.stiffness_n_per_m: 1.0e+9}");
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(answer.text.find("the values stay as they are\n"), 0u) << answer.text;
  EXPECT_NE(answer.text.find("at 4000 Hz the scene is unstable"), std::string::npos) << answer.text;
  EXPECT_TRUE(execute(msg::VERB_SET, "{spring.viscosity_n_s_per_m: 0.2}").accepted);
  end_loop();
  EXPECT_EQ(runner_.simulation().world().network().description().links[0].stiffness, 100.0);
}

TEST_F(CommandExecutorTest, RefusesToForceWhatHasNoStates) {
  EXPECT_EQ(execute(msg::VERB_STATE, "[spring, broken]").text, "'spring' has no states");
}

TEST_F(CommandExecutorTest, RefusesASceneWithErrorsAndGoesOn) {
  const node::Answer answer = execute(msg::VERB_LOAD, "bad.yaml");
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(answer.text.find("'bad.yaml' cannot be played ("), 0u) << answer.text;
  EXPECT_NE(answer.text.find("bad.yaml:1:9: error"), std::string::npos) << answer.text;
  end_loop();
  EXPECT_EQ(runner_.simulation().scene().name, "swing");
  EXPECT_TRUE(published_.empty());
}

TEST_F(CommandExecutorTest, RefusesWhatItDoesNotUnderstand) {
  EXPECT_FALSE(execute(static_cast<msg::ControlVerb>(99)).accepted);
  EXPECT_FALSE(execute(msg::VERB_STEP, "-1").accepted);
}

TEST_F(CommandExecutorTest, SaysSoWhenTheLoopHasEnded) {
  end_loop();
  for (const msg::ControlVerb verb : {msg::VERB_PAUSE, msg::VERB_STEP, msg::VERB_RESET}) {
    const node::Answer answer = execute(verb);
    EXPECT_FALSE(answer.accepted) << verb;
    EXPECT_EQ(answer.text, "too late, the simulation is ending") << verb;
  }
}

}  // namespace
}  // namespace cordis::sim
