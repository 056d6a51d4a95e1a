// tests/sim/stability_check_test.cpp -- what the check of stability says of a scene.
#include "sim_node/checks/stability_check.h"

#include <string>

#include <gtest/gtest.h>

#include "sim_node/scene/sections/scene_reader.h"
#include "tests/support/filled.h"

namespace cordis::sim {
namespace {

/// All that it says.
std::string check_of(const std::string& text) {
  config::Problems problems;
  const scene::Scene scene = scene::load_scene_text(text, "t", problems);
  EXPECT_EQ(problems.text(), "");
  check_stability(scene, false, problems);
  return problems.text();
}

/// A spring that changes beside a ball on a surface.
std::string changing_spring_beside(const std::string& surface) {
  return test::filled(R"(cordis: 1
space: 2
step: {rate_hz: 5000}
world: {gravity_m_per_s2: [0, -9.81]}
liaisons:
  land: {stiffness_n_per_m: 1000, viscosity_n_s_per_m: 1, pulls: false, range: rest}
  moved: {kind: spring, stiffness_n_per_m: '100 * (1 + 0.1 * sin(time_s))'}
matter:
  floor: {<surface>}
  b: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.05}, at_m: [0, 0.05]}
  h: {kind: fixed, at_m: [5, 5]}
  w: {kind: mass, mass_kg: 0.1, at_m: [5, 4]}
links:
  - {liaison: land, between_sets: [b, floor], name: lands}
  - {liaison: moved, between: [h, w], name: hang}
)",
                      {{"surface", surface}});
}

TEST(StabilityCheck, NamesTheSurfaceThatBallsMayPassBesideAChangingParameter) {
  EXPECT_EQ(check_of(changing_spring_beside("kind: plane, at_m: [0, 0], normal: y")), "");
  const std::string thin =
      check_of(changing_spring_beside("kind: polyline, corners_m: [[-10, 0], [10, 0]]"));
  EXPECT_NE(thin.find("hang: its parameter changes and does work without an end, and with enough "
                      "energy a ball passes a surface, in lands of sets (t:14): 'time_s' (t:7)\n"),
            std::string::npos)
      << thin;
}

TEST(StabilityCheck, NamesTheLawWithoutALargestSlopeBesideAChangingParameter) {
  const std::string text = check_of(R"(cordis: 1
space: 1
step: {rate_hz: 5000}
liaisons:
  cubic: {elasticity: '1000 * elongation_m^3', rest_m: 0.1}
  moved: {kind: spring, stiffness_n_per_m: '100 * (1 + 0.1 * sin(time_s))'}
matter:
  h: {kind: fixed, at_m: 0}
  w: {kind: mass, mass_kg: 0.1, at_m: 0.1}
links:
  - {liaison: moved, between: [h, w], name: hang}
  - {liaison: cubic, between: [h, w], name: grows}
)");
  EXPECT_NE(text.find("hang: its parameter changes and does work without an end, and a law without "
                      "a largest slope may take it, in grows (t:12): 'time_s' (t:6)\n"),
            std::string::npos)
      << text;
}

TEST(StabilityCheck, NamesTheFormulaOfTheLiaisonThatAsks) {
  const std::string text = check_of(R"(cordis: 1
space: 2
step: {rate_hz: 10000}
world:
  flow_m_per_s: [0.1 * tilt, 0]
  viscosity_n_s_per_m: 0.1
  gravity_m_per_s2: [0, -9.81 * tilt]
matter:
  b: {kind: mass, mass_kg: 0.1, at_m: [1, 0]}
  a: {kind: mass, mass_kg: 0.1, at_m: [0, 0], driven: {force_n: [tilt, 0]}}
signals:
  tilt: {of: b, quantity: force, axis: y}
)");
  EXPECT_NE(text.find("the gravity of the world: it asks for what masses move, and nothing bounds "
                      "what that brings in: 'tilt' (t:7)\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace cordis::sim
