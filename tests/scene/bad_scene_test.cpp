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
                 "cordis: 1\nsession: s\n^nodes:\n  sim: {node: sim_node, scene: s/a.yaml}\n",
                 "this is a launch file, and a scene is wanted",
                 "its scene is s/a.yaml, from the folder of this file"},
        BadScene{kNothing, "cordis: 1\nname: keys\n^axes: 1\ntravel_m: 0.04\nstrange: 3\n",
                 "this is a device file, and a scene is wanted",
                 "a launch file names it: {node: device_node, device: FILE.yaml}"},
        BadScene{kNothing, "cordis: 1\nliaisons: {}\n^parts: {}\n",
                 "this is a file of parts, and a scene is wanted",
                 "a scene takes them in: parts: {include: ...}"},
        BadScene{
            kNothing,
            "^space: 1\nstep: {rate_hz: 1000}\nmatter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\n",
            "missing key 'cordis' in scene", ""},
        BadScene{
            kNothing,
            "^cordis: 1\nstep: {rate_hz: 1000}\nmatter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\n",
            "missing key 'space' in scene", ""},
        BadScene{kNothing,
                 "cordis: 1\nspace: ^4\nstep: {rate_hz: 1000}\nmatter: {a: {kind: mass, mass_kg: "
                 "1, at_m: 0}}\n",
                 "'space' in scene must be between 1 and 3, got 4", ""},
        BadScene{kNothing, "^cordis: 1\nspace: 1\nmatter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\n",
                 "missing key 'step' in scene", ""},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: ^1500}\nmatter: {a: {kind: mass, mass_kg: "
                 "1, at_m: 0}}\n",
                 "'rate_hz' must be an integer multiple of the gesture rate, 1000 Hz, got 1500",
                 "take 1000 or 2000, or set 'gesture_rate_hz'"},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: ^500}\nmatter: {a: {kind: mass, mass_kg: 1, "
                 "at_m: 0}}\n",
                 "'rate_hz' must be an integer multiple of the gesture rate, 1000 Hz, got 500",
                 "take 1000, or set 'gesture_rate_hz'"},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: ^44100}\nmatter: {a: {kind: mass, mass_kg: "
                 "1, at_m: 0}}\n",
                 "'rate_hz' must be an integer multiple of the gesture rate, 1000 Hz, got 44100",
                 "take 44000 or 45000, or set 'gesture_rate_hz' to 980, and 'rate_hz' of the "
                 "device"},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: 1000, frame_rate_hz: ^999, gesture_rate_hz: "
                 "500}\nmatter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\n",
                 "'frame_rate_hz' must not exceed the gesture rate, 500 Hz", ""},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: ^0}\nmatter: {a: {kind: mass, mass_kg: 1, "
                 "at_m: 0}}\n",
                 "'rate_hz' in step must be between 1 and 1000000, got 0", ""},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: 1000, freeze: {tolerance_m: ^0}}\nmatter: "
                 "{a: {kind: mass, mass_kg: 1, at_m: 0}}\n",
                 "'tolerance_m' in freeze must be > 0, got 0", ""},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: 1000, integrator: ^implicit, freeze: "
                 "{tolerance_m: 1e-6}}\nmatter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\n",
                 "the integrator implicit does not take freezing, which the scene has", ""},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: 1000, integrator: ^euler}\nmatter: {a: "
                 "{kind: mass, mass_kg: 1, at_m: 0}}\n",
                 "'integrator' in step must be one of cordis, leapfrog, symplectic4, implicit, "
                 "modal, got "
                 "'euler'",
                 ""},
        BadScene{kNothing,
                 "cordis: 1\nspace: 1\nstep: {rate_hz: 1000, integrator: ^symplectic4}\nmatter: "
                 "{s: {kind: string, count: 3, mass_kg: 1, stiffness_n_per_m: 1, "
                 "viscosity_n_s_per_m: 1, ends: fixed}}\n",
                 "the integrator symplectic4 does not take viscosity, which s.links[0] has",
                 "s.links[0] stands at t:4"},
        BadScene{kHead1, "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nworld: {^viscosity: 1}\n",
                 "unknown key 'viscosity' in world", "did you mean 'viscosity_n_s_per_m'?"},
        BadScene{
            kHead1,
            "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nworld: {viscosity_n_s_per_m: ^-1}\n",
            "'viscosity_n_s_per_m' in world must be >= 0, got -1", ""},
        BadScene{kHead2,
                 "matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}\nworld: {gravity_m_per_s2: "
                 "^-9.81}\n",
                 "'gravity_m_per_s2' in world must have 2 numbers, got 1", ""},
        BadScene{kHead2, "matter: ^{a: {kind: fixed, at_m: [0, 0]}}\n",
                 "the scene has no mass that can move", ""},
        BadScene{kHead2, "matter: ^{}\n", "the scene has no mass that can move", ""},
        BadScene{kHead2,
                 "matter: ^{}\nports: {p: {device: d, axes: 0, role: mass, at_m: [0, 0], coupling: "
                 "direct}}\n",
                 "the scene has no mass that can move", ""},
        BadScene{kHead2,
                 "matter: ^{a: {kind: string, count: 2, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], "
                 "ends: fixed, stiffness_n_per_m: 1}}\n",
                 "the scene has no mass that can move", ""},
        BadScene{kHead2, "matter: ^{a: {kind: mass, mass_kg: 1.0e-320, at_m: [0, 0]}}\n",
                 "this cannot be simulated: MAT 0: mass must be large enough for the step", ""}));

INSTANTIATE_TEST_SUITE_P(
    Liaisons, BadScenes,
    testing::Values(
        BadScene{
            kHead1,
            "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nliaisons:\n  s: ^{kind: spring}\n",
            "missing key 'stiffness_n_per_m' in liaison 's'", ""},
        BadScene{kHead1,
                 "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nliaisons:\n  s: ^{kind: "
                 "spring_damper, stiffness_n_per_m: 1}\n",
                 "missing key 'viscosity_n_s_per_m' in liaison 's'", ""},
        BadScene{kHead1,
                 "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nliaisons:\n  s: "
                 "^{stiffness_n_per_m: 1}\n",
                 "missing key 'kind' in liaison 's'", ""},
        BadScene{kHead1,
                 "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nliaisons:\n  s: {kind: ^sprng}\n",
                 "'kind' in liaison 's' must be one of spring, damper, spring_damper, maxwell, "
                 "state_machine, parallel, got 'sprng'",
                 "did you mean 'spring'?"},
        BadScene{kHead1,
                 "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nliaisons:\n  s: {kind: spring, "
                 "stiffness_n_per_m: ^-2}\n",
                 "'stiffness_n_per_m' in liaison 's' must be >= 0, got -2", ""},
        BadScene{kHead1,
                 "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nliaisons:\n  s: {kind: damper, "
                 "viscosity_n_s_per_m: 1, rest_m: ^1}\n",
                 "a damper has no 'rest_m'", ""},
        BadScene{
            kHead1,
            "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nliaisons:\n  s: {kind: spring, "
            "stiffness_n_per_m: 1, ^colour: red}\n",
            "unknown key 'colour' in liaison 's'",
            "known keys: kind, parameters, stiffness_n_per_m, viscosity_n_s_per_m, rest_m, rest"},
        BadScene{kHead1,
                 "matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}\nliaisons:\n  include: [^[x]]\n",
                 "'include' must be the path of a file, got a sequence", ""},
        BadScene{kHead2,
                 "matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0]}}\nliaisons:\n  s: {kind: "
                 "spring, stiffness_n_per_m: 1, rest_m: ^-1}\n",
                 "'rest_m' in liaison 's' must be >= 0, got -1", ""}));

TEST(BadScene, TellsAllItsProblemsInOneGoAndNoneThatFollowsFromAnother) {
  config::Problems problems;

  load_scene_text(
      "cordis: 1\n"
      "space: 2\n"
      "step: {rate_khz: 1, rate_hz: 1000}\n"
      "liaisons:\n"
      "  soft: {kind: spring, stiffness: 3}\n"
      "matter:\n"
      "  string: {kind: string, count: 0, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], liaison: "
      "soft}\n"
      "  nail: {kind: fixed, at_m: [0, x]}\n"
      "ports:\n"
      "  key: {device: k, axes: [77], role: mass, at_m: [0, 0]}\n"
      "links:\n"
      "  - {liaison: soft, between: [key, \"string[20]\"]}\n"
      "  - {liaison: sift, name: held, between: [nail, \"string[99]\"]}\n"
      "signals:\n"
      "  f: {of: key, quantity: force, axis: y}\n"
      "  g: {of: held, quantity: force}\n"
      "  h: {of: string.links, quantity: elongation}\n"
      "  i: {of: strin, quantity: elongation}\n",
      "t", problems);

  std::string places;
  for (const config::Problem& problem : problems.in_order()) {
    places += std::to_string(problem.place.line) + ':' + std::to_string(problem.place.column) + ' ';
  }
  EXPECT_EQ(places, "3:8 5:9 5:24 7:33 8:33 10:27 13:15 18:11 ") << problems.text();
}

TEST(BadScene, OfEverySectionIsToldInOneGo) {
  config::Problems problems;

  load_scene_text(
      "cordis: 1\n"
      "space: 2\n"
      "step: {rate_hz: 1000}\n"
      "parts:\n"
      "  wheel: {matter: {hub: {part: axle}}}\n"
      "  axle: {matter: {pin: {part: wheel}}}\n"
      "liaisons:\n"
      "  asks: {states: {one: {exits: [{to: two, when: tension_n > 1}]}, two: {}}}\n"
      "  lost: {states: {one: {}, two: {}}}\n"
      "  shut: {states: {one: {exits: [{to: two, when: age_s > 1}]}, two: {stiffness_n_per_m: "
      "1}}}\n"
      "  trap: {states: {one: {exits: [{to: two, when: elongation_m > 1}]},\n"
      "                  two: {exits: [{to: one, when: elongation_m > 0.5}]}}}\n"
      "  bent: {elasticity: {kind: table, at_m: [1, 0], force_n: [0, 1]}}\n"
      "matter:\n"
      "  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}\n"
      "  w: {part: wheel}\n"
      "links:\n"
      "  - {liaison: shut, within: []}\n"
      "  - {liaison: shut, between: [\"m[0]\", \"m[7]\"]}\n",
      "t", problems);

  const std::string told = problems.text();
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
    EXPECT_NE(told.find(line), std::string::npos) << line << "\nin\n" << told;
  }
  EXPECT_EQ(problems.all().size(), 8u) << told;
}

TEST(BadScene, IsPrintedWithItsLineAndACaret) {
  config::Problems problems;
  load_scene_text(
      scene_head(2) +
          "matter:\n  string:\n    kind: string\n    count: 40\n    mass_g: 20\n    from_m: [0, "
          "0]\n    to_m: [1, 0]\n    stiffness_n_per_m: 1\n    mass_kg: -0.1\n",
      "scenes/bow.yaml", problems);
  EXPECT_EQ(problems.text(),
            "scenes/bow.yaml:8:5: error: unknown key 'mass_g' in matter 'string'\n"
            "    mass_g: 20\n"
            "    ^\n"
            "  hint: did you mean 'mass_kg'?\n"
            "scenes/bow.yaml:12:14: error: 'mass_kg' in matter 'string' must be > 0, got -0.1\n"
            "    mass_kg: -0.1\n"
            "             ^");
}

TEST(LoadScene, OfAMissingFileIsOneProblem) {
  config::Problems problems;
  load_scene("no_such.yaml", problems);
  EXPECT_EQ(problems.text(), "no_such.yaml: error: cannot be read: No such file or directory");

  config::Problems of_launch;
  of_launch.remember_source("l.yaml", "scene: no_such.yaml");
  load_scene("no_such.yaml", of_launch, {"l.yaml", 1, 8});
  EXPECT_EQ(of_launch.text(),
            "l.yaml:1:8: error: cannot read 'no_such.yaml': No such file or directory\nscene: "
            "no_such.yaml\n       ^");
}

}  // namespace
}  // namespace cordis::scene
