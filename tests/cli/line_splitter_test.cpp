// tests/cli/line_splitter_test.cpp
#include "cli/run/line_splitter.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::cli {
namespace {

using Lines = std::vector<std::string>;

struct Collected {
  LineSplitter splitter;
  Lines lines;

  void feed(std::string_view bytes) {
    splitter.feed(bytes, [this](std::string_view line) { lines.emplace_back(line); });
  }
  void finish() {
    splitter.finish([this](std::string_view line) { lines.emplace_back(line); });
  }
};

TEST(LineSplitter, HandsOnWholeLinesHoweverTheBytesArrive) {
  const std::string text = "first\n\nthird line\nlast\n";
  for (std::size_t block = 1; block <= text.size(); ++block) {
    Collected collected;
    for (std::size_t begin = 0; begin < text.size(); begin += block)
      collected.feed(text.substr(begin, block));
    EXPECT_EQ(collected.lines, (Lines{"first", "", "third line", "last"})) << "blocks of " << block;
  }
}

TEST(LineSplitter, KeepsAnUnfinishedLineUntilItEnds) {
  Collected collected;
  collected.feed("begun");
  EXPECT_TRUE(collected.lines.empty());
  collected.finish();
  collected.finish();
  EXPECT_EQ(collected.lines, Lines{"begun"});
}

TEST(LineSplitter, CutsALineThatIsTooLongWithoutLosingAByte) {
  const std::size_t longest = LineSplitter::kLongestLine;
  const std::string text(2 * longest + 3, 'x');
  for (const std::size_t block : {std::size_t{1}, longest - 1, longest, longest + 1, text.size()}) {
    Collected collected;
    for (std::size_t begin = 0; begin < text.size(); begin += block)
      collected.feed(text.substr(begin, block));
    collected.feed("\nnext\n");
    EXPECT_EQ(collected.lines,
              (Lines{std::string(longest, 'x'), std::string(longest, 'x'), "xxx", "next"}))
        << "blocks of " << block;
  }
}

TEST(LineSplitter, DoesNotAddAnEmptyLineToOneOfTheLargestLength) {
  Collected collected;
  collected.feed(std::string(LineSplitter::kLongestLine, 'x'));
  collected.feed("\nnext\n");
  EXPECT_EQ(collected.lines, (Lines{std::string(LineSplitter::kLongestLine, 'x'), "next"}));
}

}  // namespace
}  // namespace cordis::cli
