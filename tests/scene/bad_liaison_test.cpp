#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

/// A scene of two MATs with these liaisons and these links.
std::string scene_of(const std::string& liaisons, const std::string& links = {}) {
  return "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0], [2, 0]]}\nliaisons:\n" +
         liaisons + (links.empty() ? "" : "links:\n" + links);
}

struct BadLiaison {
  std::string text;
  const char* message;
  const char* hint;
};
void PrintTo(const BadLiaison& bad, std::ostream* stream) {
  *stream << '\n' << bad.text;
}

class BadLiaisons : public testing::TestWithParam<BadLiaison> {};

TEST_P(BadLiaisons, HaveOneProblemAtItsPlace) {
  const BadLiaison& bad = GetParam();
  expect_only_problem({kHead2, bad.text.c_str(), bad.message, bad.hint});
}

/// A liaison with one condition.
std::string when(const std::string& condition) {
  return scene_of(
      "  l:\n    parameters: {hold_m: 1}\n    states:\n"
      "      x: {exits: [{to: y, when: " +
      condition + "}, {to: y, when: elongation_m > hold_m}]}\n      y: {}\n");
}

INSTANTIATE_TEST_SUITE_P(
    Conditions, BadLiaisons,
    testing::Values(
        BadLiaison{when("\"abs(^elongation) > 1\""),
                   "'when' in exit of state 'x' of liaison 'l' names 'elongation', which is no "
                   "quantity and no parameter",
                   "did you mean 'elongation_m'?"},
        BadLiaison{when("elongation_m > ^hold"),
                   "'when' in exit of state 'x' of liaison 'l' names 'hold', which is no quantity "
                   "and no parameter",
                   "did you mean 'hold_m'?"},
        BadLiaison{when("\"^absolute(elongation_m) > 1\""),
                   "'when' in exit of state 'x' of liaison 'l' knows no function 'absolute'",
                   "functions: abs, sqrt, min, max, rising, falling"},
        BadLiaison{when("\"elongation_m > 1 ^&& age_s > 1\""),
                   "'when' in exit of state 'x' of liaison 'l' has a '&&'", "write 'and'"},
        BadLiaison{when("\"0 < elongation_m ^< 1\""),
                   "'when' in exit of state 'x' of liaison 'l' compares three things at once",
                   "write a < b and b < c"},
        BadLiaison{when("\"elongation_m > 1 and ^age_s\""),
                   "'when' in exit of state 'x' of liaison 'l' gives 'and' a number, it wants a "
                   "comparison",
                   ""},
        BadLiaison{when("\"^(elongation_m > 1) + 1 > 2\""),
                   "'when' in exit of state 'x' of liaison 'l' gives '+' a comparison, it wants a "
                   "number",
                   ""},
        BadLiaison{when("\"^(elongation_m > 1\""),
                   "'when' in exit of state 'x' of liaison 'l' has a '(' that is never closed", ""},
        BadLiaison{when("\"elongation_m > 1^)\""),
                   "'when' in exit of state 'x' of liaison 'l' does not expect ')' here", ""},
        BadLiaison{
            when("\"elongation_m >^\""),
            "'when' in exit of state 'x' of liaison 'l' ends where a number or a name should "
            "follow",
            ""},
        BadLiaison{when("^elongation_m"),
                   "'when' in exit of state 'x' of liaison 'l' must be a condition, got a number",
                   "compare it: elongation_m > 0"},
        BadLiaison{when("\"elongation_m ^= 1\""),
                   "'when' in exit of state 'x' of liaison 'l' has a '='",
                   "to compare, write '=='"},
        BadLiaison{when("\"elongation_m > 2^m\""),
                   "'when' in exit of state 'x' of liaison 'l' has something right behind a number",
                   "to multiply, write '*'"},
        BadLiaison{when("\"elongation_m > 1 ^/ 0\""),
                   "'when' in exit of state 'x' of liaison 'l' has a part that is no finite number",
                   ""},
        BadLiaison{when("\"^min(elongation_m) > 1\""),
                   "'when' in exit of state 'x' of liaison 'l' gives 'min' 1 value",
                   "it wants at least two"},
        BadLiaison{when("\"^äö > 1\""),
                   "'when' in exit of state 'x' of liaison 'l' does not expect 'ä' here", ""}));

}  // namespace
}  // namespace cordis::scene
