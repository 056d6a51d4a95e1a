// tests/scene/bad_liaison_test.cpp
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

/// A scene of two MATs with these liaisons and these links.
std::string scene_of(const std::string& liaisons, const std::string& links = {}) {
  return R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0], [2, 0]]}
liaisons:
)" + liaisons +
         (links.empty() ? "" : "links:\n" + links);
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
      R"(  l:
    parameters: {hold_m: 1}
    states:
      x: {exits: [{to: y, when: )" +
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
        BadLiaison{
            when("\"^absolute(elongation_m) > 1\""),
            "'when' in exit of state 'x' of liaison 'l' knows no function 'absolute'",
            "functions: abs, sqrt, sign, exp, log, sin, cos, tanh, min, max, if, rising, falling"},
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
                   "to multiply, write '*'; a number has no unit, for names have the units"},
        BadLiaison{when("\"2 * force_n > 60 ^N\""),
                   "'when' in exit of state 'x' of liaison 'l' does not expect 'N' here",
                   "to multiply, write '*'; a number has no unit, for names have the units"},
        BadLiaison{when("\"elongation_m > ^$hold_m\""),
                   "'when' in exit of state 'x' of liaison 'l' has a '$'",
                   "$name is a whole value alone: write parameters: {name: $name}, and name in the "
                   "formula"},
        BadLiaison{when("\"elongation_m > 1 ^/ 0\""),
                   "'when' in exit of state 'x' of liaison 'l' has a part that is no finite number",
                   ""},
        BadLiaison{when("\"^min(elongation_m) > 1\""),
                   "'when' in exit of state 'x' of liaison 'l' gives 'min' 1 value",
                   "it wants at least two"},
        BadLiaison{when("\"^äö > 1\""),
                   "'when' in exit of state 'x' of liaison 'l' does not expect 'ä' here", ""}));

/// A liaison with these states.
std::string states(const std::string& text) {
  return scene_of(R"(  l:
    parameters: {hold_m: 1}
    states:
)" + text);
}

INSTANTIATE_TEST_SUITE_P(
    BendingWithoutItsKind, BadLiaisons,
    testing::Values(
        BadLiaison{
            states(
                "      x: {^stiffness_n_m_per_rad: 1, viscosity_n_m_s_per_rad: 0.1, exits: [{to: "
                "x, when: abs(bend_rad) > hold_m, rest: rest_rad + 0.1 * bend_rad}]}\n"),
            "'stiffness_n_m_per_rad' is a key of a bending liaison, and liaison 'l' is none",
            "write kind: bending in liaison 'l'"},
        BadLiaison{states("      x: {exits: []}\n      y: {^rest_rad: 0.1}\n"),
                   "'rest_rad' is a key of a bending liaison, and liaison 'l' is none",
                   "write kind: bending in liaison 'l'"},
        BadLiaison{scene_of("  l: {^stiffness_n_m_per_rad: 1}\n"),
                   "'stiffness_n_m_per_rad' is a key of a bending liaison, and liaison 'l' is none",
                   "write kind: bending in liaison 'l'"},
        BadLiaison{scene_of("  l: {kind: spring, ^stiffness_n_m_per_rad: 1}\n"),
                   "'stiffness_n_m_per_rad' is a key of a bending liaison, and liaison 'l' is none",
                   "write kind: bending in liaison 'l'"},
        BadLiaison{
            scene_of("  l: {kind: spring, stiffness_n_per_m: 1, ^stiffness_n_m_per_rad: 1}\n"),
            "unknown key 'stiffness_n_m_per_rad' in liaison 'l'",
            "did you mean 'stiffness_n_per_m'?"}));

INSTANTIATE_TEST_SUITE_P(
    States, BadLiaisons,
    testing::Values(
        BadLiaison{
            states("      x: {exits: [{to: ^z, when: elongation_m > hold_m}]}\n      yy: {}\n"),
            "'to' in exit of state 'x' of liaison 'l' must be one of x, yy, got 'z'", ""},
        BadLiaison{states("      x: {exits: [^{when: elongation_m > hold_m}]}\n"),
                   "missing key 'to' in exit of state 'x' of liaison 'l'", "one of x"},
        BadLiaison{states("      x: {exits: [^{to: x}]}\n"),
                   "missing key 'when' in exit of state 'x' of liaison 'l'", ""},
        BadLiaison{states("      x: {exits: [{to: x, when: elongation_m > hold_m, rest: "
                          "\"rest_m + ^elongation\"}]}\n"),
                   "'rest' in exit of state 'x' of liaison 'l' names 'elongation', which is no "
                   "quantity and no parameter",
                   "did you mean 'elongation_m'?"},
        BadLiaison{states("      x: {exits: [{to: x, when: elongation_m > hold_m, rest: ^rest_m > "
                          "1}]}\n"),
                   "'rest' in exit of state 'x' of liaison 'l' must be a length, got a comparison",
                   "rest: keep, here, or an expression such as rest_m + elongation_m"},
        BadLiaison{states("      x: {stiffness_n_per_m: ^-1}\n"),
                   "'stiffness_n_per_m' in state 'x' of liaison 'l' must be >= 0, got -1", ""},
        BadLiaison{states("      x: {stiffness_n_per_m: ^hold_m - 2}\n"),
                   "'stiffness_n_per_m' in state 'x' of liaison 'l' must be >= 0, got -1", ""},
        BadLiaison{states("      x: {stiffness_n_per_m: ^.nan}\n"),
                   "'stiffness_n_per_m' in state 'x' of liaison 'l' must be a finite number, got "
                   ".nan",
                   ""},
        BadLiaison{states("      x: {stiffness_n_per_m: 2 * ^elongation_m}\n"),
                   "'stiffness_n_per_m' in state 'x' of liaison 'l' is fixed before the run and "
                   "cannot ask for 'elongation_m'",
                   ""},
        BadLiaison{states("      x: {^stifness_n_per_m: 1}\n"),
                   "unknown key 'stifness_n_per_m' in state 'x' of liaison 'l'",
                   "did you mean 'stiffness_n_per_m'?"},
        BadLiaison{states("      x: {force_limit_n: ^0}\n"),
                   "'force_limit_n' in state 'x' of liaison 'l' must be > 0, got 0", ""},
        BadLiaison{scene_of(R"(  l:
    start: ^yy
    states: {x: {}}
)"),
                   "'start' in liaison 'l' must be one of x, got 'yy'", ""},
        BadLiaison{scene_of("  l: {states: ^{}}\n"), "'states' in liaison 'l' must not be empty",
                   ""},
        BadLiaison{states("      ^and: {}\n"), "'and' cannot be the name of a state", ""}));

INSTANTIATE_TEST_SUITE_P(
    Diagnostics, BadLiaisons,
    testing::Values(
        BadLiaison{states(R"(      x: {exits: [{to: x, when: elongation_m > hold_m, rest: here}]}
      ^yy: {}
)"),
                   "state 'yy' of liaison 'l' cannot be reached from its start, 'x'",
                   "give 'x' the exit {to: yy, when: ...}"},
        BadLiaison{states(R"(      x: {exits: [{to: yy, when: elongation_m > hold_m}]}
      yy: {stiffness_n_per_m: 1, exits: []}
      ^broken: {}
)"),
                   "state 'broken' of liaison 'l' cannot be reached from its start, 'x'",
                   "give 'yy' the exit {to: broken, when: ...}"},
        BadLiaison{states(R"(      x: {exits: [{to: yy, when: elongation_m > hold_m}]}
      ^yy: {stiffness_n_per_m: 1}
)"),
                   "no exit leads out of state 'yy' of liaison 'l'",
                   "if that is meant, write final: true"},
        BadLiaison{
            states(
                R"(      x: {exits: [{to: yy, when: ^1 > 2}, {to: yy, when: elongation_m > hold_m}]}
      yy: {}
)"),
            "this condition of liaison 'l' never holds", ""},
        BadLiaison{scene_of(R"(  l:
    parameters: {hold_m: ^1}
    states: {x: {}}
)"),
                   "parameter 'hold_m' of liaison 'l' is used nowhere", ""},
        // the bow of the paper: at the moment of release both ends still move alike
        BadLiaison{
            states(R"(      x: {exits: [{to: yy, when: abs(elongation_m) > hold_m}]}
      yy: {exits: [{to: x, when: ^abs(speed_m_per_s) < 0.01, rest: here}]}
)"),
            "this exit of state 'yy' of liaison 'l' holds already when the state is entered "
            "from 'x' by ends that move slowly: the link would change again in the next "
            "step, and what comes of it would depend on the length of a step",
            "let the state last: add 'and falling(...)' of the compared value, or 'and age_s "
            "> ...'"},
        BadLiaison{
            states(R"(      x: {exits: [{to: yy, when: elongation_m > hold_m}]}
      yy: {exits: [{to: x, when: ^elongation_m > hold_m / 2}]}
)"),
            "this exit of state 'yy' of liaison 'l' holds already when the state is entered "
            "from 'x' by ends that move slowly: the link would change again in the next "
            "step, and what comes of it would depend on the length of a step",
            "let the state last: add 'and falling(...)' of the compared value, or 'and age_s "
            "> ...'"}));

constexpr const char* kAnyPower =
    "an expression has any power, as \"3 * sign(elongation_m) * abs(elongation_m)^1.3\"; a "
    "dissipation asks for speed_m_per_s";

INSTANTIATE_TEST_SUITE_P(
    Laws, BadLiaisons,
    testing::Values(
        BadLiaison{
            scene_of("  l: {elasticity: {kind: table, at_m: [0, 2, ^1], force_n: [0, 1, 2]}}\n"),
            "'at_m' in elasticity of liaison 'l' must ascend, got 1 after 2", ""},
        BadLiaison{scene_of("  l: {elasticity: {kind: table, at_m: [0, ^0], force_n: [0, 1]}}\n"),
                   "'at_m' in elasticity of liaison 'l' must ascend, got 0 after 0", ""},
        BadLiaison{
            scene_of("  l: {elasticity: {kind: table, at_m: [0, 1], force_n: ^[0]}}\n"),
            "'force_n' in elasticity of liaison 'l' must have one number for each of 'at_m', "
            "2, got 1",
            ""},
        BadLiaison{scene_of("  l: {elasticity: {kind: table, at_m: ^[], force_n: []}}\n"),
                   "'at_m' in elasticity of liaison 'l' must not be empty", ""},
        BadLiaison{scene_of("  l: {elasticity: {kind: power, coefficient: 1, exponent: ^1.3}}\n"),
                   "'exponent' in elasticity of liaison 'l' must be a multiple of 0.5, got 1.3",
                   kAnyPower},
        BadLiaison{scene_of("  l: {elasticity: {kind: power, coefficient: 1, exponent: ^-2}}\n"),
                   "'exponent' in elasticity of liaison 'l' must be between 0 and 16, got -2",
                   kAnyPower},
        BadLiaison{
            scene_of("  l: {elasticity: {kind: lennard_jones, depth_j: ^-1, diameter_m: 1}}\n"),
            "'depth_j' in elasticity of liaison 'l' must be >= 0, got -1", ""},
        BadLiaison{
            scene_of("  l: {elasticity: {kind: rings, rings: [{stiffness_n_per_m: 1, radius_m: "
                     "^0}]}}\n"),
            "'radius_m' in ring of elasticity of liaison 'l' must be > 0, got 0", ""},
        BadLiaison{scene_of("  l: {dissipation: {kind: ^rings, rings: []}}\n"),
                   "'kind' in dissipation of liaison 'l' must be one of table, power, got 'rings'",
                   ""},
        BadLiaison{scene_of("  l: {elasticity: \"500 * ^elongation\"}\n"),
                   "elasticity of liaison 'l' names 'elongation', which is no quantity and no "
                   "parameter",
                   "did you mean 'elongation_m'?"},
        BadLiaison{scene_of("  l: {elasticity: \"500 * ^(elongation_m\"}\n"),
                   "elasticity of liaison 'l' has a '(' that is never closed", ""},
        BadLiaison{scene_of("  l: {elasticity: \"elongation_m ^= 3\"}\n"),
                   "elasticity of liaison 'l' has a '='", "to compare, write '=='"},
        BadLiaison{scene_of("  l: {elasticity: \"elongation_m ^** 3\"}\n"),
                   "elasticity of liaison 'l' has a '**'", "write '^'"},
        BadLiaison{scene_of("  l: {elasticity: \"distance_m > 2 ^? 1 : 0\"}\n"),
                   "elasticity of liaison 'l' has a '?'",
                   "write if(condition, value, other value)"},
        BadLiaison{scene_of("  l: {elasticity: \"if(speed_m_per_s > 1 ^|| distance_m > 2, 1, "
                            "0)\"}\n"),
                   "elasticity of liaison 'l' has a '||'", "write 'or'"},
        BadLiaison{scene_of("  l: {elasticity: \"^if(distance_m > 2, 1)\"}\n"),
                   "elasticity of liaison 'l' gives 'if' a wrong number of values",
                   "write if(condition, value, other value)"},
        BadLiaison{scene_of("  l: {elasticity: \"if(^distance_m, 1, 2)\"}\n"),
                   "elasticity of liaison 'l' gives 'if' a number, it wants a comparison", ""},
        BadLiaison{scene_of("  l: {elasticity: ^distance_m > 2}\n"),
                   "elasticity of liaison 'l' must be a number, got a comparison",
                   "write if(..., 1, 0)"},
        BadLiaison{scene_of("  l: {elasticity: 2 * ^force_n}\n"),
                   "elasticity of liaison 'l' cannot ask for 'force_n'",
                   "it may ask for distance_m, elongation_m, speed_m_per_s, mass_a_kg, mass_b_kg"},
        BadLiaison{scene_of("  l: {dissipation: \"if(^rising(distance_m), 1, 0)\"}\n"),
                   "dissipation of liaison 'l' cannot ask for 'rising' or 'falling'",
                   "it may ask for distance_m, elongation_m, speed_m_per_s, mass_a_kg, "
                   "mass_b_kg"}));

INSTANTIATE_TEST_SUITE_P(
    Circles, BadLiaisons,
    testing::Values(
        BadLiaison{scene_of("  a: {like: b}\n  b: {like: ^a}\n"), "the liaison 'b' is like itself",
                   "a -> b -> a"},
        BadLiaison{scene_of("  b: {like: ^b}\n"), "the liaison 'b' is like itself", "b -> b"},
        BadLiaison{scene_of("  b: {like: ^c}\n  cc: {kind: spring, stiffness_n_per_m: 1}\n"),
                   "no liaison is named 'c'", "did you mean 'cc'?"},
        BadLiaison{scene_of("  a: {parallel: [^a]}\n"),
                   "the liaison 'a' stands in parallel with itself", "a -> a"},
        BadLiaison{scene_of("  a: {parallel: ^[]}\n"),
                   "'parallel' in liaison 'a' must not be empty", ""},
        BadLiaison{scene_of(R"(  l:
    parameters: {a: 2 * b, b: c + 1, c: ^a}
    stiffness_n_per_m: a
    kind: spring
)"),
                   "parameter 'c' of liaison 'l' depends on itself", "a -> b -> c -> a"},
        BadLiaison{scene_of(R"(  l:
    parameters: {^rest_m: 2}
    kind: spring
    stiffness_n_per_m: rest_m
)"),
                   "'rest_m' cannot be the name of a parameter", "it is a quantity of the link"}));

constexpr const char* kBrittle =
    R"(  l:
    parameters: {hold_m: 1}
    states:
      x: {stiffness_n_per_m: 1, exits: [{to: y, when: elongation_m > sqrt(hold_m)}]}
      y: {}
  m: {kind: maxwell, stiffness_n_per_m: 1, viscosity_n_s_per_m: 1}
)";

INSTANTIATE_TEST_SUITE_P(
    Links, BadLiaisons,
    testing::Values(
        BadLiaison{
            scene_of(kBrittle, "  - {liaison: l, between: [\"a[0]\", \"a[1]\"], ^hold: 2}\n"),
            "unknown key 'hold' in link", "did you mean 'hold_m'?"},
        BadLiaison{
            scene_of(kBrittle, "  - {liaison: l, between: [\"a[0]\", \"a[1]\"], hold_m: ^-2}\n"),
            "the liaison 'l' cannot have these parameters: 'when' in exit of state 'x' of "
            "liaison 'l' has a part that is no finite number",
            ""},
        BadLiaison{
            scene_of(kBrittle, "  - {liaison: m, between: [\"a[0]\", \"a[1]\"], rest_m: ^2}\n"),
            "a maxwell has no 'rest_m'", ""},
        BadLiaison{scene_of(kBrittle, "  - {liaison: ^m, within: a}\n"),
                   "a Maxwell element joins two MATs, not sets", ""},
        BadLiaison{scene_of(kBrittle, "  - {liaison: ^l, within: a, rest_m: 1}\n"),
                   "the liaison 'l' of sets reaches to any distance, it needs a 'range_m'", ""},
        BadLiaison{scene_of(kBrittle, "  - {liaison: l, within: a, rest_m: ^-0.01, range_m: 1}\n"),
                   "the rest length of a liaison of sets must be >= 0, got -0.01",
                   "a state may have one below 0: 'rest' of an exit"},
        BadLiaison{scene_of(kBrittle, "  - {liaison: ^l, within: a, range_m: 1}\n"),
                   "a liaison of sets whose MATs have no radius needs a 'rest_m'", ""},
        BadLiaison{scene_of(kBrittle, "  - {liaison: l, within: ^[], range_m: 1, rest_m: 1}\n"),
                   "'within' in a link must not be an empty list", ""},
        BadLiaison{
            scene_of(kBrittle, "  - {liaison: l, between_sets: [a, ^[]], range_m: 1, rest_m: 1}\n"),
            "a set of a link must not be an empty list", ""},
        BadLiaison{
            scene_of(kBrittle, "  - {liaison: l, within: ^\"a[0]\", range_m: 1, rest_m: 1}\n"),
            "a set of one MAT has no two that could be joined", ""},
        BadLiaison{scene_of(kBrittle,
                            "  - {liaison: l, between_sets: ^[a, \"a[0]\"], range_m: 1, "
                            "rest_m: 1}\n"),
                   "the two sets have a MAT in common", "write within: for one set"},
        BadLiaison{
            scene_of(kBrittle, "  - {liaison: l, between_sets: ^[a], range_m: 1, rest_m: 1}\n"),
            "a link is between 2 sets, got 1", ""},
        BadLiaison{scene_of(kBrittle,
                            "  - {liaison: l, within: a, between_sets: ^[a, a], range_m: 1, "
                            "rest_m: 1}\n"),
                   "a link is within a set, between two sets or between ends: one of them", ""},
        BadLiaison{scene_of(kBrittle, "  - {liaison: l, within: a, range_m: ^0, rest_m: 1}\n"),
                   "'range_m' in link must be > 0, got 0", ""},
        BadLiaison{
            scene_of(kBrittle, "  - {liaison: l, between: [\"a[0]\", \"a[1]\"], rest: ^radius}\n"),
            "'rest' in link must be one of radii, got 'radius'", "did you mean 'radii'?"}));

}  // namespace
}  // namespace cordis::scene
