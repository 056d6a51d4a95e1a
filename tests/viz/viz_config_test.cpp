// tests/viz/viz_config_test.cpp
#include "viz_node/viz_config.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "node/config/yaml_reader.h"

namespace cordis::viz {
namespace {

VizConfig read(const std::string& section, config::Problems& problems) {
  config::LaunchNode node;
  node.name = "view";
  node.program = "viz_node";
  node.section = config::load_text(section, "launch.yaml", problems);
  return read_viz_config(node, problems);
}

TEST(VizConfig, ServesThisMachineAloneUnlessSetOtherwise) {
  config::Problems problems;
  const VizConfig viz = read("{}", problems);

  EXPECT_FALSE(problems.has_errors());
  EXPECT_EQ(viz.address, "127.0.0.1");
  EXPECT_EQ(viz.port, 8080);
  EXPECT_EQ(viz.rate_hz, 25.0);
  EXPECT_FALSE(viz.rights.parameters);
  EXPECT_FALSE(viz.foxglove);
  EXPECT_TRUE(viz.rights.scenes.empty());
}

TEST(VizConfig, ReadsItsKeys) {
  config::Problems problems;
  const VizConfig viz = read(R"(address: '::1'
port: 0
rate_hz: 50
scenes: [a.yaml, b.yaml]
parameters: true
foxglove: true
)",
                             problems);

  EXPECT_FALSE(problems.has_errors());
  EXPECT_EQ(viz.address, "::1");
  EXPECT_EQ(viz.port, 0);
  EXPECT_EQ(viz.rate_hz, 50.0);
  EXPECT_TRUE(viz.rights.parameters);
  EXPECT_TRUE(viz.foxglove);
  EXPECT_EQ(viz.rights.scenes, (std::vector<std::string>{"a.yaml", "b.yaml"}));
}

TEST(VizConfig, RefusesAnAddressThatThisMachineDoesNotHave) {
  for (const std::string here : {"127.0.0.1", "0.0.0.0", "127.8.8.8"}) {
    config::Problems problems;
    check_address(read("address: " + here, problems), problems);
    EXPECT_FALSE(problems.has_errors()) << problems.text();
  }
  config::Problems problems;
  check_address(read("address: 192.0.2.77", problems), problems);  // of documents alone
  ASSERT_EQ(problems.all().size(), 1u);
  EXPECT_EQ(problems.all().front().place.column, 10);
  EXPECT_EQ(problems.all().front().message, "this machine has no address 192.0.2.77");
}

TEST(VizConfig, WarnsOfAMissingSceneWhereSimNodeMayRunOnAnotherHost) {
  for (const bool has_network : {false, true}) {
    config::Problems problems;
    config::Launch launch;
    launch.directory = CORDIS_SOURCE_DIR "/launch_configs/scenes";
    if (has_network) launch.network.emplace();
    const VizConfig viz = read("scenes: [membrane.yaml, none.yaml]", problems);

    check_scene_files(launch, viz, problems);

    ASSERT_EQ(problems.all().size(), 1u);
    const config::Problem& problem = problems.all().front();
    EXPECT_EQ(problem.place.line, 1);
    EXPECT_EQ(problem.place.column, 25);
    EXPECT_NE(problem.message.find("/none.yaml': No such file"), std::string::npos)
        << problem.message;
    EXPECT_EQ(problems.has_errors(), !has_network);
  }
}

TEST(VizConfig, RefusesScenesOutsideTheFolderOfTheLaunchFile) {
  config::Problems problems;
  config::Launch launch;
  launch.directory = std::filesystem::canonical(CORDIS_SOURCE_DIR "/launch_configs/devices");
  const VizConfig viz = read("scenes: [../scenes/membrane.yaml]", problems);

  check_scene_files(launch, viz, problems);

  ASSERT_EQ(problems.all().size(), 1u);
  EXPECT_EQ(problems.all().front().place.column, 10);
  EXPECT_NE(problems.all().front().message.find("is not below '" + launch.directory.string() + "'"),
            std::string::npos)
      << problems.all().front().message;
}

TEST(VizConfig, FindsAllThatIsWrongAtOnceAndWhere) {
  config::Problems problems;
  read(R"(address: lab
port: 65536
rate_hz: 0.5
prot: 1
scenes: [[a]]
)",
       problems);

  ASSERT_EQ(problems.all().size(), 5u);
  for (const auto& problem : problems.all()) {
    EXPECT_EQ(problem.place.file, "launch.yaml");
    EXPECT_GE(problem.place.line, 1);
  }
}

}  // namespace
}  // namespace cordis::viz
