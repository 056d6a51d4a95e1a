// tests/sim/rate_check_test.cpp -- scenes that have a rate and an accuracy.
#include "sim_node/checks/rate_check.h"

#include "sim_node/checks/stability_check.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/filled.h"

namespace cordis::sim {
namespace {

/// A mass on a spring, 16 vibrations per second.
scene::Scene settled(const std::string& step, config::Problems& problems) {
  scene::Scene scene = scene::load_scene_text(test::filled(R"(cordis: 1
space: 1
step: {<step>gesture_rate_hz: 10, integrator: cordis}
accuracy: {tolerance: 0.001, band_hz: 16}
liaisons: {holder: {kind: spring, stiffness_n_per_m: 1000, rest_m: 0}}
matter:
  ground: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 0.1, at_m: 0.1}
links: [{liaison: holder, between: [ground, bob]}]
)",
                                                           {{"step", step}}),
                                              "t", problems);
  select_rate(scene, problems);
  return scene;
}

TEST(SettledRate, IsThatOfThePlanWhereTheSceneHasNone) {
  config::Problems problems;
  EXPECT_EQ(settled("", problems).step_rate_hz, 650.0);  // (w dt)^2 / 24 = 0.001
  EXPECT_EQ(problems.text(), "");
}

TEST(SettledRate, IsThatOfTheSceneAndTooLowAWarning) {
  config::Problems enough;
  EXPECT_EQ(settled("rate_hz: 700, ", enough).step_rate_hz, 700.0);
  EXPECT_EQ(enough.text(), "");

  config::Problems too_low;
  EXPECT_EQ(settled("rate_hz: 500, ", too_low).step_rate_hz, 500.0);
  EXPECT_FALSE(too_low.has_errors());
  EXPECT_NE(too_low.text().find("at 500 Hz the scene does not keep this"), std::string::npos);
  EXPECT_NE(too_low.text().find("take a rate_hz of 650"), std::string::npos) << too_low.text();
}

/// A viscosity that grows with the time: nothing bounds it.
TEST(SettledRate, NamesWhatNothingBoundsAsTheCheckOfStabilityDoes) {
  config::Problems problems;
  scene::Scene scene = scene::load_scene_text(R"(cordis: 1
space: 1
step: {gesture_rate_hz: 100, integrator: leapfrog}
accuracy: {tolerance: 0.001, band_hz: 16, over_s: 0.1}
liaisons:
  holder: {kind: spring, stiffness_n_per_m: 1000, rest_m: 0}
  thickening: {dissipation: '0.3 * time_s * speed_m_per_s', rest_m: 0}
matter:
  ground: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 0.1, at_m: 0.1}
links:
  - {liaison: holder, between: [ground, bob]}
  - {liaison: thickening, between: [ground, bob]}
)",
                                              "t", problems);
  const auto selection = select_rate(scene, problems);
  const std::string promise = problems.text();
  EXPECT_NE(promise.find("positions are not promised"), std::string::npos) << promise;
  config::Problems of_check;
  check_stability(scene, false, of_check);
  const std::string check = of_check.text();
  const std::string sentence = "it is not certain that the scene is stable: thickening";
  const std::size_t begin = check.find(sentence);
  ASSERT_NE(begin, std::string::npos) << check;
  const std::string whole = check.substr(begin, check.find('\n', begin) - begin);
  EXPECT_NE(whole.find("'time_s' (t:7)"), std::string::npos) << whole;
  EXPECT_NE(promise.find(whole), std::string::npos) << promise << check;
  EXPECT_EQ(promise.substr(0, promise.find(' ')), check.substr(0, check.find(' '))) << "one place";
  ASSERT_TRUE(selection);
  EXPECT_NE(selection->uncertainty.find(whole), std::string::npos) << "so the report has it";
}

/// A mass at 1 cm on a spring of 20 N/m, with an accuracy and more keys of the mass.
scene::Scene asking(const std::string& accuracy, const std::string& step, const std::string& more,
                    config::Problems& problems) {
  scene::Scene scene =
      scene::load_scene_text(test::filled(R"(cordis: 1
space: 1
accuracy: {<accuracy>}
step: {<step>}
liaisons: {k: {kind: spring, stiffness_n_per_m: 20, rest_m: 0}}
matter:
  g: {kind: fixed, at_m: 0}
  a: {kind: mass, mass_kg: 1, <more>}
links: [{liaison: k, between: [g, a]}]
)",
                                          {{"accuracy", accuracy}, {"step", step}, {"more", more}}),
                             "t", problems);
  select_rate(scene, problems);
  return scene;
}

TEST(SettledRate, IsNoneAboveTheHighestThatCanBeWritten) {
  const std::string accuracy = "tolerance: 1e-9, band_hz: 1000";
  config::Problems open;
  asking(accuracy, "integrator: cordis", "at_m: 0.01", open);
  EXPECT_TRUE(open.has_errors());
  EXPECT_NE(open.text().find("t:3:"), std::string::npos) << open.text();
  EXPECT_NE(
      open.text().find("no rate up to 1000000 Hz keeps this: the pitch at the end of the band "
                       "asks for "),
      std::string::npos)
      << open.text();

  config::Problems written;
  asking(accuracy, "integrator: cordis, rate_hz: 1000000", "at_m: 0.01", written);
  EXPECT_FALSE(written.has_errors());
  EXPECT_NE(written.text().find("no rate_hz may be so high: ask for less"), std::string::npos)
      << written.text();
}

TEST(SettledRate, MeetsThePulsesOfTables) {
  const std::string pulse =
      "at_m: 0, driven: {force_n: {at_s: [0.1003, 0.10035, 0.1004], values: [[0], [100], [0]]}}";
  for (const char* integrator : {"modal", "cordis"}) {
    config::Problems problems;
    const scene::Scene scene = asking("tolerance: 0.01, band_hz: 5, over_s: 0.3",
                                      std::string("integrator: ") + integrator, pulse, problems);
    EXPECT_EQ(problems.text(), "") << integrator;
    EXPECT_GE(scene.step_rate_hz, 20000.0) << integrator;
  }
}

/// What is fastened to modes asks for a rate of its own, whichever integrator is taken in the end.
TEST(SettledRate, IsStableWithDampersOfDrivenMatterAtModes) {
  for (const std::string step : {"", "step: {integrator: modal}\n"}) {
    config::Problems problems;
    const std::string text = test::filled(R"yaml(cordis: 1
space: 1
accuracy: {tolerance: 0.01, band_hz: 5}
<step>liaisons:
  d: {kind: damper, viscosity_n_s_per_m: 10000}
  s: {kind: spring, stiffness_n_per_m: 20000}
matter:
  g: {kind: fixed, at_m: 0}
  p: {kind: fixed, driven: {position_m: "0.01*sin(6*time_s)"
  }
}
  m: {kind: mass, mass_kg: 1, at_m: 0}
links:
  - {liaison: d, between: [p, m]}
  - {liaison: s, between: [g, m], rest_m: 0}
)yaml",
                                          {{"step", step}});
    scene::Scene scene = scene::load_scene_text(text, "t", problems);
    ASSERT_FALSE(problems.has_errors()) << problems.text();
    select_rate(scene, problems);
    EXPECT_TRUE(check_stability(scene, false, problems).holds()) << scene.step_rate_hz;
    EXPECT_EQ(problems.text(), "") << step;
    if (!step.empty()) {
      EXPECT_GE(scene.step_rate_hz, 3000.0);  // 2 Z / dt on a mass of 1 kg
    }
  }
}

}  // namespace
}  // namespace cordis::sim
