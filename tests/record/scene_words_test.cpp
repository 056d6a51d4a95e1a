// tests/record/scene_words_test.cpp -- what a take says of its scenes and seeds.
#include "record_node/scene_words.h"

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "idl/topics.h"
#include "node/dds/payload.h"
#include "record_node/record_config.h"
#include "tests/mcap/take_folder.h"

namespace cordis::record {
namespace {

using Words = std::map<std::string, std::string>;

template <class Message>
std::vector<mcap::Metadata> read(SceneWords& words, const std::string& topic, Message message) {
  return words.read(topic, dds::encode(message));
}

TEST(SceneWords, AreThoseOfADescriptionUntilAnotherSceneComes) {
  SceneWords words;
  msg::SceneDescription scene;
  scene.name("anvil");
  scene.version(1);
  scene.space(2);
  scene.step_rate_hz(44100.0);
  scene.gesture_rate_hz(1000.0);
  scene.frame_rate_hz(25.0);
  scene.mat_kind({0, 0, 1});
  scene.link_ends({0, 1, 1, 2});
  const auto first = read(words, msg::TOPIC_DESCRIPTION, scene);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].name, "cordis.scene");
  EXPECT_EQ(first[0].values, (Words{{"name", "anvil"},
                                    {"scene_file", ""},
                                    {"space", "2"},
                                    {"mats", "3"},
                                    {"links", "2"},
                                    {"step_rate_hz", "44100"},
                                    {"gesture_rate_hz", "1000"},
                                    {"frame_rate_hz", "25"}}));
  scene.version(2);  // a reset
  EXPECT_TRUE(read(words, msg::TOPIC_DESCRIPTION, scene).empty());
  EXPECT_TRUE(read(words, msg::TOPIC_FRAME, scene).empty());
  scene.step_rate_hz(4000.0);
  EXPECT_EQ(read(words, msg::TOPIC_DESCRIPTION, scene).size(), 1u);
  const std::vector<std::byte> no_message(7);
  EXPECT_TRUE(words.read(msg::TOPIC_DESCRIPTION, no_message).empty());
}

TEST(SceneWords, NameThePlanOfEachSceneThatBegins) {
  SceneWords words;
  msg::SceneInputs batch;
  batch.wire_version(msg::WIRE_VERSION);
  batch.clock(msg::PACE_LOCKSTEP);
  batch.engine_version("1.2");
  batch.hash_version(3);
  EXPECT_TRUE(read(words, msg::TOPIC_INPUTS, batch).empty());
  batch.scene().resize(2);
  batch.scene()[0].integrator("leapfrog");
  batch.scene()[0].step_rate_hz(2000.0);
  batch.scene()[1].integrator("cordis");
  const auto plans = read(words, msg::TOPIC_INPUTS, batch);
  ASSERT_EQ(plans.size(), 2u);
  EXPECT_EQ(plans[0].name, "cordis.plan");
  EXPECT_EQ(plans[0].values, (Words{{"scene_file", ""},
                                    {"integrator", "leapfrog"},
                                    {"step_rate_hz", "2000"},
                                    {"clock", "lockstep"},
                                    {"engine_version", "1.2"},
                                    {"hash_version", "3"}}));
  EXPECT_EQ(plans[1].values.at("integrator"), "cordis");
}

TEST(AboutSession, NamesEachSeedThatAFileOrAWordSets) {
  const mcap::TakeFolder folder;
  std::ofstream(folder / "launch.yaml") << R"(cordis: 1
nodes:
  sim: {node: sim_node, scene: gravel.yaml}
  hand: {node: device_node, device: hand.yaml}
)";
  std::ofstream(folder / "gravel.yaml") << R"(cordis: 1
name: gravel
matter:
  grains: {kind: pack, seed: 7}
  dust: {kind: pack}
events: [{seed: 3}, {seed: 4}]
)";
  std::ofstream(folder / "hand.yaml") << "cordis: 1\nmock: {seed: 5}\n";
  config::Problems problems;
  const config::Launch launch =
      config::load_launch((folder / "launch.yaml").string(), {"hand.mock.seed=9"}, problems);
  ASSERT_FALSE(problems.has_errors()) << problems.text();
  const Words about = about_session(launch, files_of(launch));
  EXPECT_EQ(about.at("seed"), "1");
  EXPECT_EQ(about.at("seed gravel.yaml: matter.grains.seed"), "7");
  EXPECT_EQ(about.at("seed gravel.yaml: events[0].seed"), "3");
  EXPECT_EQ(about.at("seed gravel.yaml: events[1].seed"), "4");
  EXPECT_EQ(about.at("seed hand.yaml: mock.seed"), "5");
  EXPECT_EQ(about.at("seed hand.mock.seed"), "9");
  EXPECT_FALSE(about.contains("seed gravel.yaml: matter.dust.seed"));
}

}  // namespace
}  // namespace cordis::record
