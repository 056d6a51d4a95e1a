// tests/config/problem_test.cpp
#include "node/config/problem.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "node/config/name_hash.h"
#include "node/config/nearest_word.h"
#include "node/config/value.h"

namespace cordis::config {
namespace {

Problems problems_of_demo() {
  Problems problems;
  problems.remember_source("demo.yaml", "a: 1\nnodes:\n  - x\n  - y\r\n    arg: [--dt, 0.001]\n");
  return problems;
}

TEST(Problem, ShowsPlaceLineCaretAndHint) {
  Problems problems = problems_of_demo();

  problems.error({"demo.yaml", 5, 5}, "unknown key 'arg' in node", "did you mean 'args'?");

  EXPECT_EQ(problems.text(),
            R"(demo.yaml:5:5: error: unknown key 'arg' in node
    arg: [--dt, 0.001]
    ^
  hint: did you mean 'args'?)");
}

TEST(Problem, IsReadAgainFromItsText) {
  Problems problems;
  problems.remember_source("c:1:2.yaml", "a.yaml: error: in the file\nb\n");
  problems.error({"c:1:2.yaml", 1, 9}, "a name: error: twice", "write it once");
  problems.warning({"c:1:2.yaml", 2, 1}, "warning: is a word");
  problems.warning({"no line", 0, 0}, "is old");
  problems.error({}, "nothing works");

  const std::vector<Problem> read = problems_in("starting\n" + problems.text() + "\nends\n");

  ASSERT_EQ(read.size(), problems.all().size());
  for (const Problem& known : problems.in_order()) {
    const auto same = [&known](const Problem& one) {
      return one.severity == known.severity && one.place == known.place &&
             one.message == known.message && one.hint == known.hint;
    };
    EXPECT_TRUE(std::any_of(read.begin(), read.end(), same)) << known.text();
  }
}

TEST(Problem, WithoutALineIsOneLine) {
  Problems problems;

  problems.warning({"demo.yaml", 0, 0}, "is old");
  problems.error({}, "nothing works");

  EXPECT_EQ(problems.text(), "demo.yaml: warning: is old\nerror: nothing works");
}

TEST(Problem, PutsTheCaretUnderTheCharacterAlsoBehindTabsAndUmlauts) {
  Problem problem;
  problem.place = {"f", 1, 4};
  problem.message = "m";
  problem.source_line = "\t\xc3\xa4\xc3\xb6!";  // tab, a and o with dots, the mark

  EXPECT_EQ(problem.text(), "f:1:4: error: m\n\t\xc3\xa4\xc3\xb6!\n\t  ^");
}

TEST(Problem, ShowsOnlyTheNeighbourhoodInALongLine) {
  Problem problem;
  problem.place = {"f", 1, 5001};
  problem.message = "m";
  problem.source_line = std::string(5000, 'a') + '!' + std::string(5000, 'b');

  const std::string text = problem.text();

  EXPECT_LT(text.size(), 400u);
  const std::string below = text.substr(text.rfind('\n') + 1);
  const std::string line = text.substr(text.find('\n') + 1);
  EXPECT_EQ(line[below.find('^')], '!');
}

TEST(Problem, NeverSendsControlCharactersToTheTerminal) {
  Problem problem;
  problem.place = {"f\x1b", 1, 1};
  problem.message = "unknown key '\x1b[31m'";
  problem.hint = "a\nb";
  problem.source_line = "\x1b[31m";

  for (const char c : problem.text()) EXPECT_TRUE(c == '\n' || c >= ' ') << static_cast<int>(c);
}

TEST(Problems, AreThrownTogetherInTheOrderOfTheirPlaces) {
  Problems problems = problems_of_demo();
  problems.error({"demo.yaml", 3, 5}, "third");
  problems.error({"other.yaml", 1, 1}, "last");
  problems.warning({"demo.yaml", 1, 4}, "second");
  problems.error({"demo.yaml", 1, 1}, "first");

  try {
    problems.throw_if_any();
    FAIL() << "nothing was thrown";
  } catch (const ConfigError& error) {
    ASSERT_EQ(error.problems().size(), 4u);
    EXPECT_EQ(error.problems()[0].message, "first");
    EXPECT_EQ(error.problems()[1].message, "second");
    EXPECT_EQ(error.problems()[2].message, "third");
    EXPECT_EQ(error.problems()[3].message, "last");
    EXPECT_NE(std::string(error.what()).find(R"(demo.yaml:3:5: error: third
  - x
    ^)"),
              std::string::npos);
  }
}

TEST(Problems, WarningsAloneThrowNothing) {
  Problems problems;
  problems.warning({"f", 1, 1}, "odd");

  EXPECT_NO_THROW(problems.throw_if_any());
  EXPECT_FALSE(problems.has_errors());
}

TEST(Problems, AreKeptOnceEach) {
  Problems problems;
  problems.error({"f", 1, 1}, "wrong");
  problems.error({"f", 1, 1}, "wrong");
  problems.error({"f", 1, 2}, "wrong");

  EXPECT_EQ(problems.all().size(), 2u);
  EXPECT_EQ(problems.error_count(), 3u);
}

TEST(Problems, BeyondAHundredAreOnlyCounted) {
  Problems problems;
  for (int line = 1; line <= 150; ++line) problems.error({"f", line, 1}, "wrong");

  EXPECT_EQ(problems.all().size(), 100u);
  EXPECT_NE(problems.text().find("50 more problems are not shown"), std::string::npos);
}

TEST(NearestWord, FindsSlipsOfTheHand) {
  const std::vector<std::string> keys{"args", "stiffness_n_per_m", "mass_kg", "rate_hz", "ends"};
  EXPECT_EQ(nearest_word("arg", keys), "args");
  EXPECT_EQ(nearest_word("agrs", keys), "args");
  EXPECT_EQ(nearest_word("Mass_kg", keys), "mass_kg");
  EXPECT_EQ(nearest_word("stifness_n_per_m", keys), "stiffness_n_per_m");
}

TEST(NearestWord, FindsTheKeyBehindAWrongOrMissingUnit) {
  const std::vector<std::string> keys{"stiffness_n_per_m", "viscosity_n_s_per_m", "mass_kg", "at_m",
                                      "rate_hz"};
  EXPECT_EQ(nearest_word("mass_g", keys), "mass_kg");
  EXPECT_EQ(nearest_word("mass", keys), "mass_kg");
  EXPECT_EQ(nearest_word("stiffness", keys), "stiffness_n_per_m");
  EXPECT_EQ(nearest_word("viscosity_kg_per_s", keys), "viscosity_n_s_per_m");
  EXPECT_EQ(nearest_word("at_mm", keys), "at_m");
  EXPECT_EQ(nearest_word("rate_khz", keys), "rate_hz");
}

TEST(NearestWord, IsSilentWhenNothingIsNear) {
  EXPECT_EQ(nearest_word("colour", {"mass_kg", "at_m", "kind"}), "");
  EXPECT_EQ(nearest_word("x", {"y", "z"}), "");
  EXPECT_EQ(nearest_word("", {"a"}), "");
  EXPECT_EQ(nearest_word("a", {}), "");
  EXPECT_EQ(nearest_word(std::string(1'000'000, 'a'), {"a"}), "");
}

TEST(NameHash, IsFnv1aOf32Bits) {
  // published test values of FNV-1a
  EXPECT_EQ(name_hash(""), 0x811c9dc5u);
  EXPECT_EQ(name_hash("a"), 0xe40c292cu);
  EXPECT_EQ(name_hash("foobar"), 0xbf9cf968u);
}

}  // namespace
}  // namespace cordis::config
