// tests/cli/test_words_test.cpp -- the words of `cordis test`.
#include "cli/test/test_words.h"

#include <gtest/gtest.h>

#include "cli/command_line.h"

namespace cordis::cli {
namespace {

using Words = std::vector<std::string>;

TEST(TestWords, AreThoseOfCtest) {
  const TestWords asked = test_words({"-R", "a b", "--repeat", "until-pass:2"});
  EXPECT_EQ(asked.ctest, (Words{"-R", "a b", "--repeat", "until-pass:2"}));
  EXPECT_EQ(asked.soak_s, 0.0);
}

TEST(TestWords, LongAreTheCampaignsAlone) {
  const TestWords asked = test_words({"-R", "Soak", "--long"});
  EXPECT_EQ(asked.ctest, (Words{"-C", "Long", "-L", "campaign", "-j1", "-R", "Soak"}));
  EXPECT_EQ(asked.soak_s, 1800.0);
  EXPECT_EQ(test_words({"--long", "--hours", "8"}).soak_s, 28800.0);
}

TEST(TestWords, RefuseHoursThatMeanNothing) {
  for (const Words& words : {Words{"--hours", "8"}, Words{"--long", "--hours"},
                             Words{"--long", "--hours", "0"}, Words{"--long", "--hours", "soon"}}) {
    EXPECT_THROW(test_words(words), UsageError);
  }
}

}  // namespace
}  // namespace cordis::cli
