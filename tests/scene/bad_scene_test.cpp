// tests/scene/bad_scene_test.cpp
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

TEST_P(BadScenes, HaveOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Whole, BadScenes,
    testing::Values(
        BadScene{kNothing, "^", "scene must be a mapping of keys, got nothing", ""},
        BadScene{kNothing, "^[1]\n", "scene must be a mapping of keys, got a sequence", ""},
        BadScene{kNothing,
                 R"(cordis: 1
session: s
^nodes:
  sim: {node: sim_node, scene: s/a.yaml}
)",
                 "this is a launch file, and a scene is wanted",
                 "its scene is s/a.yaml, from the folder of this file"},
        BadScene{kNothing, R"(cordis: 1
name: keys
^axes: 1
travel_m: 0.04
strange: 3
)",
                 "this is a device file, and a scene is wanted",
                 "a launch file names it: {node: device_node, device: FILE.yaml}"},
        BadScene{kNothing, R"(cordis: 1
liaisons: {}
^parts: {}
)",
                 "this is a file of parts, and a scene is wanted",
                 "a scene takes them in: parts: {include: ...}"},
        BadScene{kNothing,
                 R"(^space: 1
step: {rate_hz: 1000}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "missing key 'cordis' in scene", ""},
        BadScene{kNothing,
                 R"(^cordis: 1
step: {rate_hz: 1000}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "missing key 'space' in scene", ""},
        BadScene{kNothing,
                 R"(cordis: 1
space: ^4
step: {rate_hz: 1000}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "'space' in scene must be between 1 and 3, got 4", ""},
        BadScene{kNothing, R"(^cordis: 1
space: 1
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "missing key 'step' in scene", ""},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
step: {rate_hz: ^500}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "'rate_hz' must not be below the gesture rate, 1000 Hz, got 500",
                 "take 1000 or more, or set 'gesture_rate_hz'"},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
step: {rate_hz: 1000, frame_rate_hz: ^999, gesture_rate_hz: 500}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "'frame_rate_hz' must not exceed the gesture rate, 500 Hz", ""},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
step: {rate_hz: ^0}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "'rate_hz' in step must be between 1 and 1000000, got 0", ""},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
step: {rate_hz: 1000, freeze: {tolerance_m: ^0}}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "'tolerance_m' in freeze must be > 0, got 0", ""},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
step: {rate_hz: 1000, integrator: ^implicit, freeze: {tolerance_m: 1e-6}}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "the integrator implicit does not take freezing, which the scene has",
                 "integrators that take the scene: cordis, leapfrog"},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
step: {rate_hz: 1000, integrator: ^euler}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "'integrator' in step must be one of cordis, leapfrog, symplectic4, implicit, "
                 "modal, got "
                 "'euler'",
                 ""},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
step: {rate_hz: 1000, integrator: ^symplectic4}
matter: {s: {kind: string, count: 3, mass_kg: 1, stiffness_n_per_m: 1, viscosity_n_s_per_m: 1,
             ends: fixed}}
)",
                 "the integrator symplectic4 does not take viscosity, which s.links[0] has",
                 "integrators that take the scene: cordis, leapfrog, implicit, modal; s.links[0] "
                 "stands at t:4"},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
step: {rate_hz: 1000, integrator: ^symplectic4}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 1, 2]}}
liaisons:
  soft: {kind: spring, stiffness_n_per_m: 1}
  free: {elasticity: 500 * elongation_m * mass_a_kg}
links:
  - {liaison: soft, between: ["a[0]", "a[1]"]}
  - {liaison: free, between: ["a[1]", "a[2]"], name: pull}
)",
                 "the integrator symplectic4 does not take a free expression, which pull has",
                 "integrators that take the scene: cordis, leapfrog, implicit, modal; pull stands "
                 "at t:10, its liaison at t:7"},
        BadScene{kNothing,
                 R"(cordis: 1
space: 2
step: {rate_hz: 1000, integrator: ^leapfrog}
matter: {a: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [[0, 0], [1, 0]]}}
liaisons:
  rub: {stiffness_n_per_m: 9, pulls: false, range: rest, friction: {static: 1, stiffness_n_per_m: 9}}
links:
  - {liaison: rub, within: a}
)",
                 "the integrator leapfrog does not take friction, which rub of sets has",
                 "integrators that take the scene: cordis; rub of sets stands at t:8, its liaison "
                 "at t:6"},
        BadScene{kNothing,
                 R"(cordis: 1
space: 2
step: {rate_hz: 1000, integrator: ^modal}
matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "the integrator modal does not take 2 or 3 dimensions, which the scene has",
                 "integrators that take the scene: cordis, leapfrog, symplectic4, implicit"},
        BadScene{kNothing,
                 R"(cordis: 1
space: 1
accuracy: ^{tolerance: 0.01, over_s: 2}
step: {gesture_rate_hz: 1000}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)",
                 "missing key 'band_hz' in accuracy",
                 "the highest frequency that the tolerance holds for"},
        BadScene{kHead1, "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nworld: {^viscosity: 1}\n",
                 "unknown key 'viscosity' in world", "did you mean 'viscosity_n_s_per_m'?"},
        BadScene{
            kHead1,
            "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nworld: {viscosity_n_s_per_m: ^-1}\n",
            "'viscosity_n_s_per_m' in world must be >= 0, got -1", ""},
        BadScene{kHead2,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
world: {gravity_m_per_s2: ^-9.81}
)",
                 "'gravity_m_per_s2' in world must have 2 numbers, got 1",
                 "for example [0, -9.81]"},
        BadScene{kHead2, "matter: ^{a: {kind: fixed, at_m: [0, 0]}}\n",
                 "the scene has no mass that can move, and no port", ""},
        BadScene{kHead2, "matter: ^{}\n", "the scene has no mass that can move, and no port", ""},
        BadScene{kHead2,
                 "matter: ^{a: {kind: string, count: 2, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], "
                 "ends: fixed, stiffness_n_per_m: 1}}\n",
                 "the scene has no mass that can move, and no port", ""},
        BadScene{kHead2, "matter: ^{a: {kind: mass, mass_kg: 1.0e-320, at_m: [0, 0]}}\n",
                 "this cannot be simulated: MAT 0: mass must be large enough for the step", ""}));

INSTANTIATE_TEST_SUITE_P(
    Liaisons, BadScenes,
    testing::Values(
        BadScene{kHead1,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  s: ^{kind: spring}
)",
                 "missing key 'stiffness_n_per_m' in liaison 's'", ""},
        BadScene{kHead1,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  s: ^{kind: spring_damper, stiffness_n_per_m: 1}
)",
                 "missing key 'viscosity_n_s_per_m' in liaison 's'",
                 "give it, or write kind: spring"},
        BadScene{kHead1,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  s: ^{kind: spring_damper, viscosity_n_s_per_m: 1}
)",
                 "missing key 'stiffness_n_per_m' in liaison 's'",
                 "give it, or write kind: damper"},
        BadScene{kHead1,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  s: ^{stiffness_n_per_m: 1}
)",
                 "missing key 'kind' in liaison 's'",
                 "one of spring, damper, spring_damper, maxwell, state_machine, parallel, bending; "
                 "a liaison with states or a law, as elasticity, needs none"},
        BadScene{kHead1,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  s: {kind: ^sprng}
)",
                 "'kind' in liaison 's' must be one of spring, damper, spring_damper, maxwell, "
                 "state_machine, parallel, bending, got 'sprng'",
                 "did you mean 'spring'?"},
        BadScene{kHead1,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  s: {kind: spring, stiffness_n_per_m: ^-2}
)",
                 "'stiffness_n_per_m' in liaison 's' must be >= 0, got -2", ""},
        BadScene{kHead1,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  s: {kind: damper, viscosity_n_s_per_m: 1, rest_m: ^1}
)",
                 "a damper has no 'rest_m'", ""},
        BadScene{
            kHead1,
            R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  s: {kind: spring, stiffness_n_per_m: 1, ^colour: red}
)",
            "unknown key 'colour' in liaison 's'",
            "known keys: kind, parameters, stiffness_n_per_m, viscosity_n_s_per_m, rest_m, rest"},
        BadScene{kHead1,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
liaisons:
  include: [^[x]]
)",
                 "'include' must be the path of a file, got a sequence", ""},
        BadScene{kHead2,
                 R"(matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
liaisons:
  s: {kind: spring, stiffness_n_per_m: 1, rest_m: ^-1}
)",
                 "'rest_m' in liaison 's' must be >= 0, got -1", ""}));

TEST(BadScene, ReportsAllItsProblemsInOneGoAndNoneThatFollowsFromAnother) {
  config::Problems problems;

  load_scene_text(
      R"(cordis: 1
space: 2
step: {rate_khz: 1, rate_hz: 1000}
liaisons:
  soft: {kind: spring, stiffness: 3}
matter:
  string: {kind: string, count: 0, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], liaison: soft}
  nail: {kind: fixed, at_m: [0, x]}
ports:
  key: {device: k, axes: [77], role: mass, at_m: [0, 0]}
links:
  - {liaison: soft, between: [key, "string[20]"]}
  - {liaison: sift, name: held, between: [nail, "string[99]"]}
signals:
  f: {of: key, quantity: force, axis: y}
  g: {of: held, quantity: force}
  h: {of: string.links, quantity: elongation}
  i: {of: strin, quantity: elongation}
)",
      "t", problems);

  std::string places;
  for (const config::Problem& problem : problems.in_order()) {
    places += std::to_string(problem.place.line) + ':' + std::to_string(problem.place.column) + ' ';
  }
  EXPECT_EQ(places, "3:8 5:9 5:24 7:33 8:33 10:27 13:15 18:11 ") << problems.text();
}

TEST(BadScene, OfEverySectionIsReportedInOneGo) {
  config::Problems problems;

  load_scene_text(
      R"(cordis: 1
space: 2
step: {rate_hz: 1000}
parts:
  wheel: {matter: {hub: {part: axle}}}
  axle: {matter: {pin: {part: wheel}}}
liaisons:
  asks: {states: {one: {exits: [{to: two, when: tension_n > 1}]}, two: {}}}
  lost: {states: {one: {}, two: {}}}
  shut: {states: {one: {exits: [{to: two, when: age_s > 1}]}, two: {stiffness_n_per_m: 1}}}
  trap: {states: {one: {exits: [{to: two, when: elongation_m > 1}]},
                  two: {exits: [{to: one, when: elongation_m > 0.5}]}}}
  bent: {elasticity: {kind: table, at_m: [1, 0], force_n: [0, 1]}}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
  w: {part: wheel}
links:
  - {liaison: shut, within: []}
  - {liaison: shut, between: ["m[0]", "m[7]"]}
)",
      "t", problems);

  const std::string report = problems.text();
  for (const char* line :
       {"t:6:31: error: part 'wheel' contains itself: wheel > axle > wheel\n",
        "t:8:49: error: 'when' in exit of state 'one' of liaison 'asks' names 'tension_n', which "
        "is "
        "no quantity and no parameter\n",
        "t:9:28: error: state 'two' of liaison 'lost' cannot be reached from its start, 'one'\n",
        "t:10:63: warning: no exit leads out of state 'two' of liaison 'shut'\n",
        "t:12:49: warning: this exit of state 'two' of liaison 'trap' holds already when the state "
        "is entered from 'one' by ends that move slowly",
        "t:13:46: error: 'at_m' in elasticity of liaison 'bent' must ascend, got 0 after 1\n",
        "t:18:29: error: 'within' in a link must not be an empty list\n",
        "t:19:39: error: 'm' has the MATs 0 to 1, got 7\n"}) {
    EXPECT_NE(report.find(line), std::string::npos) << line << "\nin\n" << report;
  }
  EXPECT_EQ(problems.all().size(), 8u) << report;
}

TEST(BadScene, IsPrintedWithItsLineAndACaret) {
  config::Problems problems;
  load_scene_text(scene_head(2) +
                      R"(matter:
  string:
    kind: string
    count: 40
    mass_g: 20
    from_m: [0, 0]
    to_m: [1, 0]
    stiffness_n_per_m: 1
    mass_kg: -0.1
)",
                  "scenes/bow.yaml", problems);
  EXPECT_EQ(problems.text(),
            R"(scenes/bow.yaml:8:5: error: unknown key 'mass_g' in matter 'string'
    mass_g: 20
    ^
  hint: did you mean 'mass_kg'?
scenes/bow.yaml:12:14: error: 'mass_kg' in matter 'string' must be > 0, got -0.1
    mass_kg: -0.1
             ^)");
}

TEST(LoadScene, OfAMissingFileIsOneProblem) {
  config::Problems problems;
  load_scene("no_such.yaml", problems);
  EXPECT_EQ(problems.text(), "no_such.yaml: error: cannot be read: No such file or directory");

  config::Problems of_launch;
  of_launch.remember_source("l.yaml", "scene: no_such.yaml");
  load_scene("no_such.yaml", of_launch, {"l.yaml", 1, 8});
  EXPECT_EQ(of_launch.text(),
            R"(l.yaml:1:8: error: cannot read 'no_such.yaml': No such file or directory
scene: no_such.yaml
       ^)");
}

}  // namespace
}  // namespace cordis::scene
