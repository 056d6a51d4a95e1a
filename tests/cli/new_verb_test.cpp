// tests/cli/new_verb_test.cpp
#include "cli/new/new_verb.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/exit_code.h"
#include "cli/verbs.h"
#include "tests/cli/captured_run.h"
#include "tests/support/filled.h"

namespace cordis::cli {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The program in a folder of its own.
class Beginnings : public testing::Test {
 protected:
  Beginnings() { std::filesystem::create_directories(folder_); }
  ~Beginnings() override { std::filesystem::remove_all(folder_); }

  int run(const std::vector<std::string>& words) {
    CommandLine line("cordis", "", "1");
    add_verbs(line);
    return run_captured(line, words, out_, error_);
  }

  std::filesystem::path folder_ = testing::TempDir() + "new_verb_test." + std::to_string(getpid());
  std::string out_;
  std::string error_;
};

TEST_F(Beginnings, OfALaunchFileChecksAndRunsAtOnce) {
  const std::string launch = folder_ / "first.yaml";

  ASSERT_EQ(run({"new", "launch", folder_ / "first"}), kSuccess) << error_;

  EXPECT_EQ(out_, launch + "\n" + (folder_ / "first_scene.yaml").string() + "\n" +
                      (folder_ / "first_device.yaml").string() + "\n");
  EXPECT_EQ(run({"check", launch, "--plan"}), kSuccess) << out_ << error_;
  EXPECT_EQ(error_, "");
  EXPECT_EQ(run({"simulate", launch, "--duration", "1s", "--csv", folder_ / "out.csv"}), kSuccess)
      << error_;
}

TEST_F(Beginnings, OfASceneIsStableAndShowsItsSignals) {
  const std::string scene = folder_ / "second.yaml";

  ASSERT_EQ(run({"new", "scene", scene}), kSuccess) << error_;
  EXPECT_EQ(run({"check", scene, "--plan"}), kSuccess) << error_;

  EXPECT_NE(out_.find("scene       second ("), std::string::npos) << out_;
  EXPECT_NE(out_.find("stable in every pose and state"), std::string::npos) << out_;
}

TEST_F(Beginnings, NameTheirSchemaInTheFirstLine) {
  for (const std::string sort : {"scene", "launch", "device"}) {
    ASSERT_EQ(run({"new", sort, folder_ / ("a_" + sort)}), kSuccess) << error_;
    const std::string text = text_of(folder_ / ("a_" + sort + ".yaml"));

    const std::string beginning = "# yaml-language-server: $schema=";
    ASSERT_TRUE(text.starts_with(beginning)) << text;
    const std::string line = text.substr(0, text.find('\n'));
    EXPECT_TRUE(line.ends_with(sort + ".schema.json")) << line;
    for (const char* word : {"TITLE", "NAME.yaml", "SCENE\n", "DEVICE\n"})
      EXPECT_EQ(text.find(word), std::string::npos) << word;
  }
}

TEST_F(Beginnings, KeepTheirNameWhateverItHolds) {
  for (const std::string name : {"MY_SCENE", "DEVICE_SCENE", "TITLE_2", "A-TITLE-SCENE-NAME"}) {
    ASSERT_EQ(run({"new", "launch", folder_ / name}), kSuccess) << error_;
    const std::string text = text_of(folder_ / (name + ".yaml"));

    EXPECT_NE(text.find("session: " + name + "\n"), std::string::npos) << text;
    EXPECT_NE(text.find("scene: " + name + "_scene.yaml}"), std::string::npos) << text;
    EXPECT_NE(text.find("device: " + name + "_device.yaml}"), std::string::npos) << text;
    EXPECT_NE(text.find("cordis run " + (folder_ / (name + ".yaml")).string() + "\n"),
              std::string::npos)
        << text;
  }
}

TEST_F(Beginnings, NeverOverwriteAFile) {
  const std::filesystem::path scene = folder_ / "mine.yaml";
  std::ofstream(scene) << "mine\n";

  EXPECT_EQ(run({"new", "scene", folder_ / "mine"}), kBadInput);

  EXPECT_NE(error_.find("mine.yaml: it already exists, and is never overwritten"),
            std::string::npos)
      << error_;
  EXPECT_EQ(text_of(scene), "mine\n");
}

TEST_F(Beginnings, OfALaunchFileKeepTheSceneThatIsThere) {
  const std::filesystem::path scene = folder_ / "first_scene.yaml";
  std::ofstream(scene) << "mine\n";

  EXPECT_EQ(run({"new", "launch", folder_ / "first"}), kSuccess) << error_;

  EXPECT_EQ(text_of(scene), "mine\n");
  EXPECT_EQ(out_.find("first_scene"), std::string::npos) << out_;
}

TEST_F(Beginnings, RefuseWordsThatAreNoSortAndNamesThatAreNone) {
  EXPECT_EQ(run({"new", "secne", folder_ / "x"}), kBadInput);
  EXPECT_NE(error_.find("did you mean 'scene'?"), std::string::npos) << error_;
  EXPECT_EQ(run({"new", "scene", folder_ / "a b"}), kBadInput);
  EXPECT_NE(error_.find("1 to 64 letters"), std::string::npos) << error_;
  EXPECT_EQ(run({"new", "scene", folder_ / "none" / "x"}), kBadInput);
  EXPECT_NE(error_.find("No such file or directory"), std::string::npos) << error_;
}

TEST_F(Beginnings, SchemaIsTheFileThatShips) {
  for (const std::string sort : {"scene", "launch", "device"}) {
    ASSERT_EQ(run({"schema", sort}), kSuccess) << error_;
    EXPECT_TRUE(out_ == text_of(std::string(CORDIS_SOURCE_DIR "/launch_configs/schemas/") + sort +
                                ".schema.json"))
        << sort;
  }
  EXPECT_EQ(run({"schema", "parts"}), kBadInput);
}

/// Several files of one `cordis check`.
class ManyChecked : public Beginnings {
 protected:
  ManyChecked() {
    EXPECT_EQ(run({"new", "scene", folder_ / "good"}), kSuccess);
    std::ofstream(folder_ / "bad.yaml") << R"(cordis: 1
space: 2
step: {rate_hz: 1000}
mater: {}
)";
  }
};

TEST_F(ManyChecked, HaveOneReportEachAndTheHighestCode) {
  const std::string good = folder_ / "good.yaml";
  const std::string bad = folder_ / "bad.yaml";

  EXPECT_EQ(run({"check", good, good, "--plan"}), kSuccess) << error_;
  EXPECT_EQ(run({"check", bad, good, "--plan"}), kBadInput);

  EXPECT_NE(error_.find("unknown key 'mater' in scene"), std::string::npos) << error_;
  EXPECT_NE(out_.find("scene       good ("), std::string::npos) << out_;
}

TEST_F(ManyChecked, HaveOneListForAProgramAndASingleOneHasNone) {
  const std::string good = folder_ / "good.yaml";
  const std::string bad = folder_ / "bad.yaml";

  ASSERT_EQ(run({"check", good, bad, "--plan", "--json", "-"}), kBadInput);
  const nlohmann::json list = nlohmann::json::parse(out_);
  ASSERT_EQ(run({"check", good, "--plan", "--json", "-"}), kSuccess) << error_;
  const nlohmann::json single = nlohmann::json::parse(out_);

  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0], single);
  EXPECT_EQ(list[1]["file"], bad);
  EXPECT_NE(list[1]["error"].get<std::string>().find("unknown key 'mater'"), std::string::npos);
}

TEST_F(ManyChecked, OneMayStandOnStandardInput) {
  ASSERT_NE(std::freopen((folder_ / "good.yaml").c_str(), "r", stdin), nullptr);
  EXPECT_EQ(run({"check", "-", "--plan"}), kSuccess) << error_;
  EXPECT_NE(out_.find("scene       good (-)"), std::string::npos) << out_;
  ASSERT_NE(std::freopen((folder_ / "bad.yaml").c_str(), "r", stdin), nullptr);
  EXPECT_EQ(run({"check", folder_ / "good.yaml", "-", "--plan"}), kBadInput);
  EXPECT_NE(error_.find("-:4:1: error: unknown key 'mater' in scene"), std::string::npos) << error_;
  EXPECT_EQ(run({"check", "-", "-"}), kBadInput);
}

TEST_F(ManyChecked, ALaunchFileOnStandardInputSaysThatItsNodesAreNotAsked) {
  std::ofstream(folder_ / "launch.yaml") << test::filled(R"(cordis: 1
session: good
clock: realtime
nodes:
  sim: {node: sim_node, scene: <scene>}
)",
                                                         {{"scene", folder_ / "good.yaml"}});
  ASSERT_NE(std::freopen((folder_ / "launch.yaml").c_str(), "r", stdin), nullptr);
  EXPECT_EQ(run({"check", "-"}), kSuccess) << error_;
  EXPECT_NE(out_.find("\nnodes       not asked"), std::string::npos) << out_;
}

}  // namespace
}  // namespace cordis::cli
