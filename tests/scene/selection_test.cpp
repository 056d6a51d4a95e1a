// tests/scene/selection_test.cpp
#include "sim_node/scene/selection.h"

#include <gtest/gtest.h>

#include "node/config/yaml_reader.h"
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

/// The names of a scene with a wall in three parts, a row of three copies of a wheel, and a string.
class Selections : public testing::Test {
 protected:
  Selections() {
    add("string", 0, 5);
    add("string.links", 0, 4, Named::kLinks);
    add("wall", 5, 6);
    add("wall.left", 5, 1);
    add("wall.right", 6, 2);
    add("wall.right.links", 4, 1, Named::kLinks);
    add("wall.back", 8, 3);
    names_.add({"row", Named::kMatter, 11, 9, true, {}, 3}, problems_);
    for (std::uint32_t copy = 0; copy < 3; ++copy) {
      const std::string name = "row[" + std::to_string(copy) + "]";
      add(name, 11 + 3 * copy, 3);
      add(name + ".hub", 11 + 3 * copy, 1);
      add(name + ".rim", 12 + 3 * copy, 2);
    }
    add("port", 20, 1, Named::kPort);
    names_.add({"broken", Named::kMatter, 21, 0, false, {}}, problems_);
  }

  void add(const std::string& name, std::uint32_t first, std::uint32_t count,
           Named kind = Named::kMatter) {
    names_.add({name, kind, first, count, true, {}}, problems_);
  }

  /// The indices, or the message.
  std::string picked(const std::string& yaml, bool with_links = false) {
    config::Problems problems;
    const config::Value value = config::load_text(yaml, "t", problems);
    const std::optional<Selection> selection = select(value, "it", with_links, names_, problems);
    if (!selection) {
      std::string report;
      for (const config::Problem& problem : problems.all())
        report += problem.message + (problem.hint.empty() ? "" : "; " + problem.hint) + "\n";
      return report;
    }
    std::string indices;
    for (const std::uint32_t index : selection->indices) indices += std::to_string(index) + " ";
    return indices;
  }

  Names names_;
  config::Problems problems_;
};

TEST_F(Selections, PickByNameIndexAndRange) {
  EXPECT_EQ(picked("string"), "0 1 2 3 4 ");
  EXPECT_EQ(picked("string[3]"), "3 ");
  EXPECT_EQ(picked("string[1..3]"), "1 2 3 ");
  EXPECT_EQ(picked("port"), "20 ");
  EXPECT_EQ(picked("string.links[2]", true), "2 ");
}

TEST_F(Selections, ReachIntoParts) {
  EXPECT_EQ(picked("wall"), "5 6 7 8 9 10 ");
  EXPECT_EQ(picked("wall[1]"), "6 ");
  EXPECT_EQ(picked("wall.right[1]"), "7 ");
  EXPECT_EQ(picked("wall.*"), "5 6 7 8 9 10 ");
  EXPECT_EQ(picked("wall.right.links", true), "4 ");
}

TEST_F(Selections, CountTheCopiesOfARepeatedPart) {
  EXPECT_EQ(picked("row[1]"), "14 15 16 ");
  EXPECT_EQ(picked("row[1..2]"), "14 15 16 17 18 19 ");
  EXPECT_EQ(picked("row[1].rim[1]"), "16 ");
  EXPECT_EQ(picked("row[0..1].hub"), "11 14 ");
  EXPECT_EQ(picked("row.hub"), "11 14 17 ");
  EXPECT_EQ(picked("row[2].*"), "17 18 19 ");
}

TEST_F(Selections, AreJoinedByAList) {
  EXPECT_EQ(picked("['string[0]', port, wall.left]"), "0 20 5 ");
  EXPECT_EQ(picked("'wall.*'"), picked("[wall.left, wall.right, wall.back]"));
}

TEST_F(Selections, ReportWhatIsWrong) {
  EXPECT_EQ(picked("sting"), "no matter or port is named 'sting'; did you mean 'string'?\n");
  EXPECT_EQ(picked("string[5]"), "'string' has the MATs 0 to 4, got 5\n");
  EXPECT_EQ(picked("string.links[4]", true), "'string.links' has the links 0 to 3, got 4\n");
  EXPECT_EQ(picked("row[3].rim"), "'row' has the copies 0 to 2, got 3\n");
  EXPECT_EQ(picked("row[1].rin"),
            "no matter or port is named 'row[1].rin'; did you mean 'row[1].rim'?\n");
  EXPECT_EQ(picked("wall[0].left"), "'wall' is not repeated; write it without an index\n");
  EXPECT_EQ(picked("string.*"),
            "'string' is no part: it has no names in it; write string for all its MATs\n");
  EXPECT_EQ(picked("string.links"), "it must be MATs, and 'string.links' are links\n");
  EXPECT_EQ(picked("[port, string.links]", true), "it must be MATs or links, not both\n");
  EXPECT_EQ(picked("[wall, wall.right]"), "'wall.right[0]' is picked twice\n");
  EXPECT_EQ(picked("[]"), "it must not be an empty list\n");
  for (const char* text : {"string[", "string[a]", "string[2..1]", "string[-1]", "string..x", ".x",
                           "string[1]x", "*[1]", ""}) {
    const std::string word = text;
    const std::string quoted = '"' + word + '"';
    EXPECT_EQ(picked(quoted),
              "it must be name, name[3], name[2..5] or name.*, got '" + word + "'\n");
  }
  EXPECT_EQ(picked("{a: b}"), "it must be name, name[3], name[2..5] or name.*, got a mapping\n");
}

TEST_F(Selections, OfABrokenPartSayNothingMore) {
  EXPECT_EQ(picked("broken"), "");
  EXPECT_EQ(picked("broken.rim[3]"), "");
  EXPECT_EQ(picked("broken.*"), "");
  EXPECT_EQ(picked("broken[3].x"), "");
}

TEST_F(Selections, InThePartItselfNeedNoNameOfIt) {
  const Names::Scope scope(names_, "row[1]");
  EXPECT_EQ(picked("rim"), "15 16 ");
  EXPECT_EQ(picked("'*'"), "14 15 16 ");
  EXPECT_EQ(picked("string"), "no matter or port is named 'string'\n");
  EXPECT_EQ(names_.word_of(16, false), "rim[1]");
}

}  // namespace
}  // namespace cordis::scene
