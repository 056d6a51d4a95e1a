// tests/cli/run_plan_test.cpp
#include "cli/run/run_plan.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "cli/command_line.h"
#include "node/config/yaml_reader.h"

namespace cordis::cli {
namespace {

using Words = std::vector<std::string>;

config::Launch launch_of(config::Clock clock) {
  config::Launch launch;
  launch.file = "dir/l.yaml";
  launch.clock = clock;
  const std::vector<std::pair<std::string, std::string>> nodes{
      {"view", "viz_node"}, {"left", "device_node"}, {"right", "device_node"}, {"sim", "sim_node"}};
  for (const auto& [name, program] : nodes) {
    config::LaunchNode node;
    node.name = name;
    node.program = program;
    node.required = program != "viz_node";
    launch.nodes.push_back(node);
  }
  return launch;
}

TEST(RunPlan, StartsSimDevicesDisplaysInThisOrder) {
  const RunPlan plan = plan_run(launch_of(config::Clock::kRealtime), {}, "/bin dir");

  EXPECT_EQ(names_of(plan), (Words{"sim", "left", "right", "view"}));
  EXPECT_EQ(plan.nodes[1].command.words,
            (Words{"/bin dir/device_node", "dir/l.yaml", "--name", "left"}));
  EXPECT_TRUE(plan.nodes[0].required);
  EXPECT_FALSE(plan.nodes[3].required);
}

TEST(RunPlan, StopsDevicesFirstThenDisplaysThenSim) {
  const RunPlan plan = plan_run(launch_of(config::Clock::kRealtime), {}, "/bin");

  const auto stage = [&](std::size_t i) { return plan.nodes[i].command.stop_stage; };
  EXPECT_EQ(stage(1), stage(2));  // left, right
  EXPECT_LT(stage(1), stage(3));  // devices, view
  EXPECT_LT(stage(3), stage(0));  // view, sim
}

TEST(RunPlan, GivesEveryNodeTheSameOverrides) {
  RunOptions options;
  options.overrides = {"left.driver=script", "domain=7"};

  for (const PlannedNode& node :
       plan_run(launch_of(config::Clock::kRealtime), options, "/bin").nodes) {
    EXPECT_EQ(Words(node.command.words.begin() + 4, node.command.words.end()), options.overrides)
        << node.name;
  }
}

TEST(RunPlan, MeasuresADurationInWallTimeInARealtimeSession) {
  RunOptions options;
  options.duration = std::chrono::seconds(10);

  const RunPlan plan = plan_run(launch_of(config::Clock::kRealtime), options, "/bin");

  EXPECT_EQ(plan.wall_duration, options.duration);
  EXPECT_EQ(plan.nodes[0].command.words.size(), 4u);
}

TEST(RunPlan, LeavesADurationOfSimulatedTimeToTheSimulation) {
  RunOptions options;
  options.duration = std::chrono::milliseconds(2500);
  for (const config::Clock clock : {config::Clock::kLockstep, config::Clock::kAsap}) {
    const RunPlan plan = plan_run(launch_of(clock), options, "/bin");

    EXPECT_FALSE(plan.wall_duration);
    for (const PlannedNode& node : plan.nodes) {
      EXPECT_EQ(node.command.words.back(), "sim.duration_s=2.5") << node.name;
    }
  }
}

config::LaunchNode recorder_named(const std::string& name, const std::string& text) {
  config::LaunchNode node;
  node.name = name;
  node.program = "record_node";
  config::Problems problems;
  node.section = config::load_text(text, "l.yaml", problems);
  return node;
}

TEST(RunPlan, LetsASceneWithoutRealTimeBeginWhenItsRecordersRead) {
  for (const config::Clock clock :
       {config::Clock::kLockstep, config::Clock::kAsap, config::Clock::kRealtime}) {
    config::Launch launch = launch_of(clock);
    launch.nodes.push_back(recorder_named("tape", "{out: a.mcap}"));
    launch.nodes.push_back(recorder_named("frames", "{out: b.mcap, topics: scene/frame}"));
    launch.nodes.push_back(recorder_named("no_answers", "{out: c.mcap, exclude: gesture/*}"));
    launch.nodes.push_back(recorder_named("disk", "{out: d.mcap, topics: [scene/*, gesture/*]}"));

    const Words words = plan_run(launch, {}, "/bin").nodes.back().command.words;
    const bool waits = std::ranges::find(words, "sim.recorded_by=[tape,disk]") != words.end();
    EXPECT_EQ(waits, clock != config::Clock::kRealtime);

    RunOptions some;
    some.only = {"sim", "left"};
    EXPECT_EQ(plan_run(launch, some, "/bin").nodes.back().command.words.size(), 4u);
  }
}

TEST(RunPlan, EndsWithTheSimulationThatHasADurationEvenIfItIsNotRequired) {
  config::Launch launch = launch_of(config::Clock::kAsap);
  for (config::LaunchNode& node : launch.nodes) node.required = false;
  RunOptions options;
  options.duration = std::chrono::seconds(1);

  EXPECT_TRUE(plan_run(launch, options, "/bin").nodes[0].required);
}

TEST(RunPlan, MeasuresWallTimeWhenTheSimulationIsNotAmongTheNodes) {
  RunOptions options;
  options.duration = std::chrono::seconds(1);
  options.only = {"left"};

  const RunPlan plan = plan_run(launch_of(config::Clock::kLockstep), options, "/bin");

  EXPECT_EQ(plan.wall_duration, options.duration);
}

TEST(RunPlan, KeepsToTheNodesAskedFor) {
  RunOptions options;
  options.only = {"view", "sim"};

  EXPECT_EQ(names_of(plan_run(launch_of(config::Clock::kRealtime), options, "/bin")),
            (Words{"sim", "view"}));
}

TEST(RunPlan, RefusesANodeThatTheLaunchDoesNotHave) {
  RunOptions options;
  options.only = {"sim", "veiw"};
  try {
    plan_run(launch_of(config::Clock::kRealtime), options, "/bin");
    FAIL() << "a node that does not exist was taken";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "--only: dir/l.yaml has no node 'veiw', did you mean 'view'?");
  }
}

TEST(ShellLine, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(shell_line({"/a/b", "x.y=[1,2]", "it's", "", "plain-1.5"}),
            "/a/b 'x.y=[1,2]' 'it'\\''s' '' plain-1.5");
}

}  // namespace
}  // namespace cordis::cli
