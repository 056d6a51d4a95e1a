// tests/scene/bad_scene.h -- scenes with one fault each, and what must be said about it.
#pragma once

#include <algorithm>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace cordis::scene {

/// What stands before the text of a bad scene.
enum Before {
  kNothing,
  kHead1,  ///< the first three lines of a sound scene of space 1
  kHead2,
  kHead3,
  kLinked  ///< the head of space 2, two liaisons and five masses
};

/// A scene with one fault, and all that must be said about it.
struct BadScene {
  Before before;
  const char* text;  ///< '^' marks the place of the fault; it is taken out before reading
  const char* message;
  const char* hint;
};

inline void PrintTo(const BadScene& bad, std::ostream* stream) {
  *stream << '\n' << bad.text;
}

inline std::string text_before(Before before) {
  constexpr const char* kLiaisonsAndMatter =
      R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 1}
  d: {kind: damper, viscosity_n_s_per_m: 1}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0], [2, 0]]}
  b: {kind: mass, mass_kg: 1, at_m: [[0, 1], [1, 1]]}
)";
  if (before == kNothing) return {};
  if (before == kLinked) return scene_head(2) + kLiaisonsAndMatter;
  return scene_head(static_cast<int>(before));
}

/// Reads the scene; its only problem must be the expected one at the marked place.
inline void expect_only_problem(const BadScene& bad) {
  std::string text = text_before(bad.before) + bad.text;
  const std::size_t mark = text.find('^');
  ASSERT_NE(mark, std::string::npos);
  text.erase(mark, 1);
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(mark), '\n');
  const std::size_t line_start = mark == 0 ? 0 : text.rfind('\n', mark - 1) + 1;

  config::Problems problems;
  load_scene_text(text, "t", problems);

  ASSERT_EQ(problems.in_order().size(), 1u) << problems.text();
  const config::Problem& problem = problems.all()[0];
  EXPECT_EQ(problem.message, bad.message);
  EXPECT_EQ(problem.hint, bad.hint);
  EXPECT_EQ(problem.place.file, "t");
  EXPECT_EQ(problem.place.line, line);
  EXPECT_EQ(problem.place.column, static_cast<int>(mark - line_start) + 1);
}

class BadScenes : public testing::TestWithParam<BadScene> {};

}  // namespace cordis::scene
