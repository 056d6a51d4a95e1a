// tests/scene/liaison_test.cpp
#include "sim_node/scene/liaisons/liaison.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

/// A folder of files that lives as long as the test.
class Include : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder / "more"); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  }
  /// A scene with two bobs joined by liaison `used`.
  std::string scene_file(const std::string& liaisons, const std::string& used) {
    return write("scene.yaml", scene_head(2) + "liaisons:\n" + liaisons +
                                   R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
links:
  - {liaison: )" + used + ", between: [\"a[0]\", \"a[1]\"]}\n");
  }
  std::string problems_of(const std::string& file) {
    config::Problems problems;
    load_scene(file, problems);
    return problems.text();
  }

  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("cordis_include_") + std::to_string(getpid()) + "_" +
       testing::UnitTest::GetInstance()->current_test_info()->name());
};

constexpr const char* kSoft =
    R"(cordis: 1
liaisons:
  soft: {kind: spring, stiffness_n_per_m: 3}
)";

TEST_F(Include, BringsTheLiaisonsOfAFileBesideTheScene) {
  write("more/soft.yaml", kSoft);
  config::Problems problems;

  const Scene scene = load_scene(scene_file("  include: [more/soft.yaml]\n", "soft"), problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(scene.network.links.at(0).stiffness, 3.0);
}

TEST_F(Include, GoesOnRelativeToTheIncludedFile) {
  write("more/soft.yaml", kSoft);
  write("more/all.yaml", R"(cordis: 1
liaisons:
  include: soft.yaml
)");
  EXPECT_EQ(problems_of(scene_file("  include: more/all.yaml\n", "soft")), "");
}

TEST_F(Include, TakesAFileOnceThoughTwoNameIt) {
  write("more/soft.yaml", kSoft);
  write("more/a.yaml", R"(cordis: 1
liaisons:
  include: soft.yaml
)");
  write("more/b.yaml", R"(cordis: 1
liaisons:
  include: ../more/soft.yaml
)");
  EXPECT_EQ(problems_of(scene_file("  include: [more/a.yaml, more/b.yaml]\n", "soft")), "");
}

TEST_F(Include, OfItselfIsAProblem) {
  write("more/a.yaml", R"(cordis: 1
liaisons:
  include: b.yaml
)");
  const std::string b = write("more/b.yaml",
                              R"(cordis: 1
liaisons:
  include: a.yaml
  soft: {kind: spring, stiffness_n_per_m: 3}
)");

  const std::string problems = problems_of(scene_file("  include: more/a.yaml\n", "soft"));

  EXPECT_EQ(problems, b + R"(:3:12: error: 'a.yaml' includes itself
  include: a.yaml
           ^)");
  write("scene_of_itself.yaml", scene_head(2) +
                                    R"(liaisons: {include: scene_of_itself.yaml}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)");
  EXPECT_NE(problems_of((folder / "scene_of_itself.yaml").string()).find("includes itself"),
            std::string::npos);
}

TEST_F(Include, OfAMissingFileIsAProblemOfItsPlace) {
  write("soft.yaml", kSoft);
  const std::string file =
      scene_file("  include: [sofd.yaml]\n  own: {kind: spring, stiffness_n_per_m: 1}\n", "own");
  EXPECT_EQ(problems_of(file), file + ":5:13: error: cannot read '" +
                                   (folder / "sofd.yaml").string() +
                                   R"(': No such file or directory
  include: [sofd.yaml]
            ^
  hint: did you mean 'soft.yaml'?)");
}

TEST_F(Include, ReportsProblemsInTheIncludedFile) {
  const std::string soft = write("soft.yaml",
                                 R"(cordis: 1
liaisons:
  soft: {kind: spring, stiffness_n_per_m: -3}
matter: {}
)");

  const std::string problems = problems_of(scene_file("  include: soft.yaml\n", "soft"));

  EXPECT_NE(problems.find(
                soft + ":3:43: error: 'stiffness_n_per_m' in liaison 'soft' must be >= 0, got -3"),
            std::string::npos)
      << problems;
  EXPECT_NE(problems.find(soft + ":4:1: error: unknown key 'matter' in file of liaisons"),
            std::string::npos)
      << problems;
}

TEST_F(Include, RefusesASecondLiaisonOfTheSameName) {
  const std::string soft = write("soft.yaml", kSoft);
  const std::string file =
      scene_file("  include: soft.yaml\n  soft: {kind: spring, stiffness_n_per_m: 1}\n", "soft");
  EXPECT_EQ(problems_of(file), file +
                                   R"(:6:3: error: the liaison 'soft' is defined twice
  soft: {kind: spring, stiffness_n_per_m: 1}
  ^
)" + "  hint: first defined at " + soft +
                                   ":3");
}

}  // namespace
}  // namespace cordis::scene
