// tests/sim/start_check_test.cpp -- warnings of starts that no rate or rounding can follow.
#include "sim_node/checks/start_check.h"

#include "tests/sim/loaded_scenes.h"

namespace cordis::sim {
namespace {

std::string warnings_of(const std::string& text) {
  config::Problems problems;
  const scene::Scene scene = scene::load_scene_text(text, "t", problems);
  check_start(scene, problems);
  return problems.text();
}

/// Balls of 1 g in a row, in a set or joined one to one.
std::string balls(const std::string& spacing, bool as_set) {
  const std::string link = as_set
                               ? "{liaison: clay, within: row, name: hold}"
                               : "{liaison: clay, between: [\"row[2]\", \"row[3]\"], name: hold}";
  return R"(cordis: 1
space: 2
step: {rate_hz: 1000}
liaisons:
  clay: {elasticity: {kind: lennard_jones, depth_j: 1.0e-5, diameter_m: 0.008, cut_m: 0.02}}
matter:
  row: {kind: points, mass_kg: 0.001, radius_m: 0.004, at_m: [[0, 0], [0.01, 0], [0.02, 0], [)" +
         spacing + R"(, 0]]}
links:
  - )" + link +
         "\n";
}

TEST(StartCheck, WarnsOfLennardJonesBallsThatTheFirstStepThrowsApart) {
  for (const bool as_set : {true, false}) {
    EXPECT_EQ(warnings_of(balls("0.028", as_set)), "") << as_set;
    EXPECT_EQ(warnings_of(balls("0.0275", as_set)), "") << as_set;  // they overlap a little
    const std::string text = warnings_of(balls("0.022", as_set));
    EXPECT_EQ(text.find("t:9:"), 0u) << text;
    EXPECT_NE(text.find("warning: row[2] and row[3] start 0.002 m apart, and hold"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("whose diameter is 0.008 m, pushes them with 4.03e+06 N: 8.05e+03 m in the "
                        "first step"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("start them at least a diameter apart"), std::string::npos) << text;
  }
}

TEST(StartCheck, WarnsOfMembersOfASetThatStartAtOnePointUnderARestLength) {
  const auto warnings = [](int space, const std::string& rest, bool is_fixed) {
    const std::string places = space == 1 ? "[0, 0.01, 0.01]" : "[[0, 0], [0.01, 0], [0.01, 0]]";
    return warnings_of("cordis: 1\nspace: " + std::to_string(space) + R"(
step: {rate_hz: 1000}
liaisons:
  touch: {stiffness_n_per_m: 1, pulls: false}
matter:
  row: {kind: )" + (is_fixed ? "fixed" : "mass, ball: {mass_kg: 0.001, radius_m: 0.004}") +
                       ", at_m: " + places + R"(}
links:
  - {liaison: touch, within: row, name: hold, range_m: 0.005, )" +
                       rest + "}\n");
  };
  for (const int space : {1, 2}) {
    for (const char* const rest : {"rest: radii", "rest_m: 0.003"}) {
      const std::string text = warnings(space, rest, false);
      EXPECT_NE(text.find("t:9:"), std::string::npos) << text;
      EXPECT_NE(
          text.find("warning: row[1] and row[2] start at the same point, so hold of sets has no "
                    "direction between them and exerts no force"),
          std::string::npos)
          << text;
      EXPECT_NE(text.find("move one of them a little"), std::string::npos) << text;
    }
    EXPECT_EQ(warnings(space, "rest_m: 0", false), "");
  }
}

/// Marbles of 10 g and 2 cm on a body.
std::string marble_scene(const std::string& body, const std::string& places,
                         const std::string& liaison) {
  return R"(cordis: 1
space: 2
step: {rate_hz: 20000}
liaisons:
  contact:
    parameters: {stiffness_n_per_m: 1000}
    range: rest
    states:
      apart: {exits: [{to: touching, when: elongation_m < 0}]}
      touching: {stiffness_n_per_m: stiffness_n_per_m, exits: [{to: apart, when: elongation_m >= 0}]}
  land: )" +
         liaison +
         R"(
matter:
  drum: )" +
         body +
         R"(
  marble: {kind: mass, ball: {mass_kg: 0.01, radius_m: 0.02}, at_m: )" +
         places + R"(}
links:
  - {liaison: land, between_sets: [marble, drum]}
)";
}

constexpr const char* kLand = "{stiffness_n_per_m: 600, pulls: false, range: rest}";

TEST(StartCheck, WarnsOfMatterThatASurfaceThrowsOut) {
  const std::string drum = "{kind: cylinder, center_m: [0, 0], radius_m: 0.5";
  for (const char* const land : {kLand, "{like: contact, parameters: {stiffness_n_per_m: 600}}"}) {
    const std::string text =
        warnings_of(marble_scene(drum + "}", "[[0, 0.1], [0, 0.2], [0, 0.7]]", land));
    // 0.5 * 600 * 0.42^2 J
    EXPECT_NE(
        text.find(
            "t:16:5: warning: land of sets throws marble[0] out of drum at 103 m/s: they start "
            "0.42 m nearer than their rest length, the worst of 2 pairs"),
        std::string::npos)
        << text;
    EXPECT_NE(
        text.find("hint: start it farther out, or write sides: both for a body that is hollow, "
                  "or let the scene 'settle'"),
        std::string::npos)
        << text;
    EXPECT_EQ(warnings_of(marble_scene(drum + ", sides: both}", "[[0, 0.1], [0, 0.2]]", land)), "");
    EXPECT_EQ(warnings_of(marble_scene(drum + "}", "[0, 0.51]", land)), "");
  }
  const std::string floor = "{kind: plane, at_m: [0, 0], normal: y}";
  EXPECT_NE(warnings_of(marble_scene(floor, "[0, -0.3]", kLand))
                .find("hint: start it farther out, or let"),
            std::string::npos);
}

TEST(StartCheck, WarnsOfBallsThatAContactThrowsApart) {
  const std::string ball = "{kind: fixed, ball: {radius_m: 0.02}, at_m: [0, 0]}";
  const auto stiff = [](const std::string& rest) {
    return "{stiffness_n_per_m: 20000, range: rest" + rest + "}";
  };
  // 0.5 * 20000 * 0.02^2 J
  const std::string text = warnings_of(marble_scene(ball, "[0.02, 0]", stiff(", pulls: false")));
  EXPECT_NE(
      text.find("land of sets throws marble and drum apart at 28.3 m/s: they start 0.02 m nearer "
                "than their rest length"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("hint: start them farther apart, or let the scene 'settle'"),
            std::string::npos)
      << text;
  EXPECT_EQ(warnings_of(marble_scene(ball, "[0.035, 0]", stiff(", pulls: false"))), "");
  EXPECT_EQ(warnings_of(marble_scene(ball, "[0.02, 0]", stiff(", pushes: false"))), "");
  // two that move: each has half of the energy
  const std::string free = "{kind: mass, ball: {mass_kg: 0.01, radius_m: 0.02}, at_m: [0, 0]}";
  EXPECT_NE(
      warnings_of(marble_scene(free, "[0.02, 0]", stiff(", pulls: true"))).find("apart at 20 m/s"),
      std::string::npos);
}

TEST(StartCheck, FollowsTheExitsOfAContactThatIsTooDeep) {
  const std::string ball = "{kind: fixed, ball: {radius_m: 0.02}, at_m: [0, 0]}";
  const auto slips = [](const std::string& limit) {
    return R"({range: rest, states: {
    apart: {exits: [{to: pushing, when: elongation_m < 0}]},
    pushing: {stiffness_n_per_m: 20000, exits: [{to: passed, when: elongation_m < -)" +
           limit +
           R"(}]},
    passed: {final: true}}})";
  };
  EXPECT_EQ(warnings_of(marble_scene(ball, "[0.02, 0]", slips("0.01"))), "");
  EXPECT_NE(
      warnings_of(marble_scene(ball, "[0.02, 0]", slips("0.03"))).find("throws marble and drum"),
      std::string::npos);
  const std::string renewed =
      "{range: rest, states: {x: {stiffness_n_per_m: 20000, exits: [{to: y, when: elongation_m < "
      "0, "
      "rest: here}]}, y: {stiffness_n_per_m: 20000, final: true}}}";
  EXPECT_EQ(warnings_of(marble_scene(ball, "[0.02, 0]", renewed)), "");
}

std::string falling(const std::string& place, const std::string& step) {
  return R"(cordis: 1
space: 2
step: {)" +
         step + R"(}
world: {gravity_m_per_s2: [0, -9.81]}
matter:
  near: {kind: mass, mass_kg: 0.1, at_m: [0, 0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: [0, )" +
         place + "]}\n";
}

bool falls(const std::string& text) {
  config::Problems problems;
  const scene::Scene scene = scene::load_scene_text(text, "t", problems);
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  for (int n = 0; n < 1000; ++n) world.step();
  return world.position(1) != scene.network.mats[1].position;
}

TEST(StartCheck, WarnsOfAPlaceWhoseRoundingSwallowsGravity) {
  // half of what 1e6 m are rounded to is 5.8e-11 m, and g dt^2 9.8e-12 m at 1 MHz
  const std::string text = warnings_of(falling("1e6", "rate_hz: 1000000, integrator: implicit"));
  EXPECT_NE(text.find("t:7:3: warning: bob never begins to fall: 9.81e-12 m a step are less than "
                      "half of what a position of 1e+06 m is rounded to"),
            std::string::npos)
      << text;
}

TEST(StartCheck, WarnsOfAPlaceWhereNothingFallsAndOfNoOther) {
  for (const std::string integrator : {"cordis", "leapfrog", "symplectic4", "implicit"}) {
    for (const std::string place : {"1", "1e4", "1e6"}) {
      for (const std::string rate : {"10000", "100000", "1000000"}) {
        std::string step = "rate_hz: " + rate;
        step += ", integrator: " + integrator;
        const std::string scene = falling(place, step);
        EXPECT_EQ(warnings_of(scene).empty(), falls(scene)) << step << place;
      }
    }
  }
}

/// A mass of 1 kg on a spring that a table pushes with 100 N at most.
std::string pushed(const std::string& times, const std::string& step) {
  return R"(cordis: 1
space: 1
step: {)" +
         step + R"(}
liaisons: {k: {kind: spring, stiffness_n_per_m: 1000, rest_m: 0}}
matter:
  g: {kind: fixed, at_m: 0}
  a: {kind: mass, mass_kg: 1, at_m: 0, driven: {force_n: {at_s: [)" +
         times + R"(], values: [[0], [100], [0]]}}}
links: [{liaison: k, between: [g, a]}]
)";
}

TEST(StartCheck, WarnsOfAPulseOfATableThatIsShorterThanAStep) {
  const std::string text = warnings_of(pushed("0.1003, 0.10035, 0.1004", "rate_hz: 4000"));
  EXPECT_NE(text.find("t:7:3: warning: 'driven' of a has a pulse of 5e-05 s at 0.10035 s, shorter "
                      "than a step of 0.00025 s: it may be lost, in whole or in part"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("a rate_hz of 20000 meets it"), std::string::npos) << text;
  EXPECT_EQ(warnings_of(pushed("0.1003, 0.10035, 0.1004", "rate_hz: 20000")), "");
  EXPECT_EQ(warnings_of(pushed("0.1, 0.2, 0.3", "rate_hz: 4000")), "");
  const std::string short_text = warnings_of(pushed("0.1, 0.1000001, 0.1000002", "rate_hz: 4000"));
  EXPECT_NE(short_text.find("make it longer and as much lower"), std::string::npos) << short_text;
}

TEST(StartCheck, WarnsOfEndsThatCoincideUnderAFormulaThatPullsThere) {
  const auto links_of = [](const std::string& rest, const std::string& places) {
    return warnings_of(R"yaml(cordis: 1
space: 2
step: {rate_hz: 1000}
liaisons: {d: {kind: spring, stiffness_n_per_m: 100, rest_m: ")yaml" +
                       rest + R"yaml("}}
matter: {m: {kind: points, mass_kg: 1, at_m: [)yaml" +
                       places + R"yaml(]}}
links: [{liaison: d, between: ["m[0]", "m[1]"], name: rod}]
)yaml");
  };
  const std::string text = links_of("0.1 + 0.01 * sin(time_s)", "[1, 0], [1, 0]");
  EXPECT_NE(text.find("m[0] and m[1] start at the same point, so rod has no direction"),
            std::string::npos)
      << text;
  // What the formula asks for counts as it is at the start.
  EXPECT_NE(links_of("m[0].position_x_m", "[1, 0], [1, 0]"), "");
  EXPECT_EQ(links_of("m[0].position_x_m", "[0, 1], [0, 1]"), "");
  EXPECT_EQ(links_of("0.01 * sin(time_s)", "[1, 0], [1, 0]"), "");
  EXPECT_EQ(links_of("0.1 + 0.01 * sin(time_s)", "[1, 0], [1.1, 0]"), "");
}

}  // namespace
}  // namespace cordis::sim
