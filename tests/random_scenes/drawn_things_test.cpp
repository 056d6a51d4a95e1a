// tests/random_scenes/drawn_things_test.cpp -- random scenes have what the language has.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/random_scenes/random_scene.h"

namespace cordis::test {
namespace {

/// A thing that the language has, as scenes write it: a line has these parts one after the other, and then one of
/// the words, before the end.
struct Drawn {
  const char* what;
  std::vector<const char*> parts;
  std::vector<std::string> words = {};  // none: any
  const char* end = "\n";
};

bool is_in(const Drawn& drawn, const std::string& line) {
  std::size_t place = 0;
  for (const char* part : drawn.parts) {
    place = line.find(part, place);
    if (place == std::string::npos) return false;
    place += std::strlen(part);
  }
  const std::string rest = line.substr(place, line.find(drawn.end, place) - place);
  return drawn.words.empty() || std::ranges::any_of(drawn.words, [&rest](const std::string& word) {
           return rest.find(word) != std::string::npos;
         });
}

/// The words with the numbers 0 to 9 in the place of `#`.
std::vector<std::string> numbered(const std::string& word) {
  std::vector<std::string> all;
  for (int number = 0; number < 10; ++number) {
    all.push_back(word);
    all.back().replace(word.find('#'), 1, std::to_string(number));
  }
  return all;
}

std::vector<Drawn> drawn_of_matter() {
  return {
      {"a start displaced by formulas", {"  p: ", ", displacement_m: ["}},
      {"a start by number", {"  p: ", ", displacement_m: ["}, {"index"}, "]"},
      {"a start by place", {"  p: ", ", displacement_m: ["}, {"x_m", "y_m", "z_m"}, "]"},
      {"a velocity by number", {"  p: ", "velocity_m_per_s: ["}, {"index"}, "]"},
      {"a velocity by place", {"  p: ", "velocity_m_per_s: ["}, {"x_m", "y_m", "z_m"}, "]"},
      {"a string or the like that is displaced", {"  more: ", ", displacement_m: ["}},
      {"a shell that starts by formulas", {"  shell: "}, {"index", "_m)\""}},
      {"a position as formulas of time", {"  led: ", "position_m: ["}},
      {"a position as a table of time", {"  led: ", "position_m: {at_s"}},
      {"a position in a part", {"  hub: ", "position_m: "}},
      {"a start by formulas in a part", {"  tip: "}, {"index", "_m)\""}},
      {"a part that is moved", {"  pieces: ", "driven: {displacement_m"}},
      {"a part that is pushed by place", {"  pieces: ", "driven: {force_n: ", "x_m / ("}},
      {"a part that is pushed by time", {"  pieces: ", "driven: {force_n: "}, {"time_s", "at_s"}},
      {"a force by place", {"  p: ", "driven: {force_n: "}, {"x_m"}},
      {"a force of a centre", {"  p: ", "driven: {force_n: ", "* x_m / ("}},
      {"a port of a part that gives positions", {"  finger: ", "role: mass"}},
      {"a port of a part that gives forces", {"  finger: ", "role: liaison"}},
      {"a net that is free", {"  net: ", "border: free"}},
      {"a net with a fixed border", {"  net: ", "border: fixed"}},
      {"a net held at its corners", {"  net: ", "border: corners"}},
      {"shear springs", {"  net: ", "shear_stiffness_n_per_m: "}},
      {"shear dampers", {"  net: ", "shear_viscosity_n_s_per_m: "}},
      {"liaisons beside each other", {"  beside: {parallel: ["}},
      {"a damper beside a spring", {"  beside: ", "kind: damper"}},
      {"a Maxwell element beside a spring", {"  beside: ", "kind: maxwell"}},
      {"a momentum about a point", {"  turned: ", "about_m: ["}},
      {"pieces of what is near", {"  lumps: ", "near_m: "}},
      {"a fixed lattice", {"  still: ", "kind: lattice", "fixed: true"}},
      {"a fixed beam", {"  still: ", "kind: beam", "fixed: true"}},
      {"a fixed pack", {"  still: ", "kind: pack", "fixed: true"}},
      {"a ball that is shot at a set", {"liaison: of_targets, between_sets"}},
      {"a fixed body that is touched", {"liaison: of_obstacle, between_sets"}},
  };
}

std::vector<Drawn> drawn_of_fields() {
  const std::vector<std::string> of_motion = {"middle", "fastest", "thrust", "lively"};
  const std::vector<std::string> others = {"place_of_wall", "changed"};
  return {
      {"gravity by motion", {"world: ", "gravity_m_per_s2: ["}, of_motion, "]"},
      {"gravity by another signal", {"world: ", "gravity_m_per_s2: ["}, others, "]"},
      {"a flow by motion", {"world: ", "flow_m_per_s: ["}, of_motion, "]"},
      {"a flow by another signal", {"world: ", "flow_m_per_s: ["}, others, "]"},
      {"a medium by time", {"world: ", "viscosity_n_s_per_m: \""}, {"time_s"}, "\""},
      {"a medium by motion", {"world: ", "viscosity_n_s_per_m: \""}, of_motion, "\""},
      {"a medium by another signal", {"world: ", "viscosity_n_s_per_m: \""}, others, "\""},
  };
}

std::vector<Drawn> drawn_of_conditions() {
  return {
      {"a law of a bend", {"kind: bending", ", elasticity: "}, {"bend_rad", "at_rad", "power"}},
      {"the angle of a bend", {"when: "}, {"of_bends[0].angle_rad", "of_bends[0].bend_rad"}},
      {"the moment of a bend", {"when: ", "of_bends[0].moment_n_m"}},
      {"the speed of a bend", {"when: ", "of_bends[0].speed_rad_per_s"}},
      {"the rest of a bend", {"when: ", "of_bends[0].rest_angle_rad"}},
      {"the age of a bend", {"when: ", "of_bends[0].age_s"}},
      {"a bend that asks outside", {"to: bent, when: \""}, {"p[", "time_s", "wall", "hand."}, "\""},
      {"the length of a link without states", {"when: "}, numbered("l#.distance_m")},
      {"its elongation", {"when: "}, numbered("l#.elongation_m")},
      {"its tension", {"when: "}, numbered("l#.force_n")},
      {"the length of a Maxwell element", {"when: "}, numbered("m#.distance_m")},
      {"the speed of a Maxwell element", {"when: "}, numbered("m#.speed_m_per_s")},
      {"the rest length of a link", {"when: "}, numbered("s#.rest_length_m")},
      {"the age of a link", {"when: "}, numbered("s#.age_s")},
      {"the state of a link", {"when: "}, numbered("s#.state == ")},
  };
}

/// A reader that takes a scene has read all that is in it. The scenes are those of the usual test, however few are tried.
TEST(RandomScenes, DrawEachOfTheseThingsAgainAndAgain) {
  constexpr std::uint32_t kTexts = 2000;
  std::vector<std::vector<std::string>> scenes;
  for (std::uint32_t seed = 1; seed <= kTexts; ++seed) {
    scenes.emplace_back();
    std::istringstream text(random_scene_text(seed));
    for (std::string line; std::getline(text, line);) scenes.back().push_back(line);
  }
  for (const auto& list : {drawn_of_matter(), drawn_of_fields(), drawn_of_conditions()}) {
    for (const Drawn& drawn : list) {
      const auto count = std::ranges::count_if(scenes, [&drawn](const auto& lines) {
        return std::ranges::any_of(lines, [&](const auto& line) { return is_in(drawn, line); });
      });
      EXPECT_GT(count, kTexts / 400) << drawn.what;
      RecordProperty(drawn.what,
                     fmt::format("{:.2f} %", 100.0 * static_cast<double>(count) / kTexts));
    }
  }
}

}  // namespace
}  // namespace cordis::test
