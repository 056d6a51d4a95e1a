// tests/cli/scene_check_test.cpp
#include "cli/check/scene_check.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/check/check_report.h"
#include "cli/check/check_verb.h"
#include "cli/exit_code.h"
#include "sim_node/sim_config.h"
#include "tests/cli/captured_run.h"
#include "tests/support/filled.h"
#include "tests/support/watched_scenes.h"

namespace cordis::cli {
namespace {

/// A mass of 0.1 kg on a spring: K' = 4 at 50 steps per second for 1000 N/m.
class Checked : public testing::Test {
 protected:
  ~Checked() override { std::remove(path_.c_str()); }
  void write(const std::string& rate, const std::string& more = "") {
    std::ofstream(path_) << R"(cordis: 1
name: bob
space: 1
step: {rate_hz: )" << rate
                         << R"(, gesture_rate_hz: 10}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: [0.1]}
liaisons:
  holder: {kind: spring, stiffness_n_per_m: 1000}
links:
  - {liaison: holder, between: [ground, bob]}
)" << more;
  }
  int run(std::vector<std::string> words) {
    CommandLine line("cordis", "", "1");
    add_check_verb(line);
    words.insert(words.begin(), {"check", path_});
    return run_captured(line, words, out_, error_);
  }

  std::string path_ = testing::TempDir() + "scene_check_test." + std::to_string(getpid()) + ".yaml";
  std::string out_;
  std::string error_;
};

TEST_F(Checked, AStableSceneHasItsMarginAndItsLimitByNameAndLine) {
  write("100");
  EXPECT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("), 2 MATs, 1 link, 0 sets, 1-D\n"), std::string::npos) << out_;
  EXPECT_NE(out_.find("margin 75 % of stiffness"), std::string::npos) << out_;
  EXPECT_NE(out_.find("set by holder (" + path_ + ":11)"), std::string::npos) << out_;
  EXPECT_NE(out_.find("mass bob of 0.1 kg (" + path_ + ":7)"), std::string::npos) << out_;
}

TEST_F(Checked, LinksWithStatesAndSetsHaveALineToo) {
  const std::string states =
      R"(  - {liaison: catch, between: [ground, bob], name: catch}
  - {liaison: knock, within: [bob, other]}
ports:
  other: {device: d, axes: [0], role: mass, coupling: direct, at_m: 0.5}
)";
  const auto soft = [&](const std::string& stiffness, const std::string& of_set) {
    write("1000", states);
    std::ifstream in(path_);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string head = "liaisons:\n";
    text.insert(
        text.find(head) + head.size(),
        test::filled(
            R"(  catch: {states: {a: {stiffness_n_per_m: <stiffness>, exits: [{to: b, when: elongation_m > 1}]},
                   b: {final: true}}}
  knock: {stiffness_n_per_m: <of_set>, pulls: false, rest_m: 0.1, range: rest}
)",
            {{"stiffness", stiffness}, {"of_set", of_set}}));
    std::ofstream(path_) << text;
  };
  soft("9000", "100");
  EXPECT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("set by catch (" + path_ + ":15)"), std::string::npos) << out_;
  soft("100", "9000");
  EXPECT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("), 3 MATs, 2 links, 1 set, 1-D\n"), std::string::npos) << out_;
  EXPECT_NE(out_.find("set by knock of sets (" + path_ + ":16)"), std::string::npos) << out_;
  EXPECT_NE(out_.find("at worst: knock of sets (" + path_ + ":16)"), std::string::npos) << out_;
}

TEST_F(Checked, AnUnstableOneFailsUnlessForced) {
  write("40");
  EXPECT_EQ(run({}), kBadInput);
  EXPECT_NE(out_.find("UNSTABLE: take a rate_hz of 60 or more"), std::string::npos) << out_;
  EXPECT_NE(
      error_.find(path_ + ":11:32: error: at 40 Hz the scene is unstable: holder at the mass "),
      std::string::npos)
      << error_;
  EXPECT_NE(error_.find("or run it all the same by a launch file with force: true of its sim_node"),
            std::string::npos)
      << error_;
  EXPECT_EQ(run({"--force"}), kSuccess);
  EXPECT_NE(error_.find("warning: at 40 Hz the scene is unstable"), std::string::npos) << error_;
}

TEST_F(Checked, AnUnstableOneIsToldNoRateThatNoSceneMayHave) {
  write("40");
  std::ifstream in(path_);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string light = "mass_kg: 0.1";
  ASSERT_NE(text.find(light), std::string::npos) << text;
  text.replace(text.find(light), light.size(), "mass_kg: 1.0e-12");
  std::ofstream(path_) << text;
  EXPECT_EQ(run({}), kBadInput);
  EXPECT_NE(out_.find("UNSTABLE at every rate_hz: take less stiffness"), std::string::npos) << out_;
  EXPECT_NE(error_.find("hint: no rate_hz is high enough"), std::string::npos) << error_;
}

TEST_F(Checked, AnUnstableMediumIsRefusedAtTheMassThatItDampsTooMuch) {
  std::ofstream(path_) << R"(cordis: 1
name: medium
space: 1
step: {rate_hz: 1000}
world: {viscosity_n_s_per_m: 900}
matter:
  bob: {kind: mass, mass_kg: 0.1, at_m: 0.1}
)";
  EXPECT_EQ(run({}), kBadInput);
  EXPECT_NE(error_.find(path_ + ":7:"), std::string::npos) << error_;
  EXPECT_NE(error_.find("the viscosity of the medium at the mass bob sets the limit"),
            std::string::npos)
      << error_;
}

TEST_F(Checked, ASceneMayAskForAccuracyInsteadOfARate) {
  write("1000");
  std::ifstream in(path_);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string rate = "rate_hz: 1000, ";
  std::string open = text;
  open.replace(open.find(rate), rate.size(), "integrator: cordis, ");
  std::ofstream(path_) << open << "accuracy: {tolerance: 0.001, band_hz: 16}\n";
  // (w dt)^2 / 24 = 0.001 at w = 32 pi: 649 Hz, and a multiple of 10
  EXPECT_EQ(run({"--json", "-"}), kSuccess) << error_;
  const nlohmann::json json = nlohmann::json::parse(out_);
  EXPECT_DOUBLE_EQ(json["rate_hz"].get<double>(), 650.0);
  EXPECT_DOUBLE_EQ(json["accuracy"]["band_hz"].get<double>(), 16.0);
  EXPECT_TRUE(json["asked"]["kept"].get<bool>());
  EXPECT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("would do: because of the pitch"), std::string::npos) << out_;

  text.replace(text.find(rate), rate.size(), "rate_hz: 500, integrator: cordis, ");
  std::ofstream(path_) << text << "accuracy: {tolerance: 0.001, band_hz: 16}\n";
  EXPECT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("rate_hz is TOO LOW for that: "), std::string::npos) << out_;

  std::ofstream(path_) << open << "accuracy: {tolerance: 2}\n";
  EXPECT_EQ(run({}), kBadInput);
  EXPECT_NE(error_.find("tolerance"), std::string::npos) << error_;
  EXPECT_NE(error_.find("band_hz"), std::string::npos) << error_;
}

TEST_F(Checked, WhereNothingSwingsTheCreepAsksForTheRate) {
  // s = w^2 / (r + sqrt(r^2 - w^2)) = 10.06 / s at w = 40 pi, r = Z / 2 m = 789.5 / s. A step of
  // `implicit` makes e^(-s dt) to 1 / (1 + s dt): the creep is off by -s dt / 2.
  std::ofstream(path_) << R"(cordis: 1
name: closer
space: 1
step: {integrator: implicit, gesture_rate_hz: 10}
accuracy: {tolerance: 0.005, band_hz: 20}
matter:
  ground: {kind: fixed, at_m: 0}
  door: {kind: mass, mass_kg: 0.1, at_m: 0.1}
liaisons:
  closer: {kind: spring_damper, stiffness_n_per_m: 1579, viscosity_n_s_per_m: 157.9, rest_m: 0}
links:
  - {liaison: closer, between: [ground, door]}
)";
  EXPECT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("would do: because of the creep at the end of the band"), std::string::npos)
      << out_;
  EXPECT_NE(
      out_.find("accuracy    at 20 Hz the viscosity lets nothing swing: creep -0.5 % at most"),
      std::string::npos)
      << out_;
}

TEST_F(Checked, AProgramReadsTheSame) {
  write("100");
  ASSERT_EQ(run({"--json", "-", "--band", "2"}), kSuccess) << error_;
  const nlohmann::json json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["stability"]["verdict"], "stable");
  EXPECT_NEAR(json["stability"]["certified_step_s"].get<double>(), 0.02, 1e-9);
  EXPECT_NEAR(json["stability"]["diverging_step_s"].get<double>(), 0.02, 1e-8);
  EXPECT_EQ(json["stability"]["limit"]["liaison"]["line"], 11);
  // w dt = 2 pi 2 / 100: (w dt)^2 / 24
  EXPECT_NEAR(json["accuracy"]["pitch_error"].get<double>(), 6.58e-4, 3e-6);
  EXPECT_GT(json["load"]["step_nsec"].get<double>(), 0.0);
  EXPECT_GE(json["load"]["worst_step_nsec"].get<double>(), json["load"]["step_nsec"].get<double>());
  EXPECT_GE(json["load"]["measured_steps"].get<int>(), 100);
}

TEST_F(Checked, TellsTheLongestStepAndWhenItMakesTicksLate) {
  write("100");
  CheckOptions options;
  options.file = path_;
  SceneCheck check = check_scene(options);

  check.step_nsec = 1e6;
  check.worst_step_nsec = 2e6;
  check.measured_steps = 500;
  EXPECT_NE(text_of(check).find("the longest of 500 steps takes 2000 us\n"), std::string::npos)
      << text_of(check);
  EXPECT_EQ(text_of(check).find("late"), std::string::npos) << text_of(check);

  check.worst_step_nsec = 2e9 / check.scene.gesture_rate_hz;
  EXPECT_NE(text_of(check).find("some ticks come late\n"), std::string::npos) << text_of(check);
  EXPECT_TRUE(nlohmann::json::parse(json_of(check))["load"]["makes_ticks_late"]);
}

TEST_F(Checked, ReportsTheReductionsInBothForms) {
  std::ofstream(path_) << R"(cordis: 1
space: 2
step: {rate_hz: 1000}
reduce: all
liaisons: {s: {kind: spring, stiffness_n_per_m: 100, rest_m: 0}}
matter:
  wall: {kind: fixed, at_m: [0, 0]}
  joint: {kind: mass, mass_kg: 0, at_m: [0.1, 0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: [0.3, 0]}
links:
  - {liaison: s, between: [wall, joint]}
  - {liaison: s, between: [joint, bob]}
  - {liaison: s, between: [wall, bob]}
)";
  EXPECT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("reduced     dimension: 2-D computed as 1-D"), std::string::npos) << out_;
  EXPECT_NE(out_.find("parallel: 1 link merged into another between the same MATs; exact"),
            std::string::npos)
      << out_;
  EXPECT_NE(out_.find("series: 1 MAT without mass taken out"), std::string::npos) << out_;
  EXPECT_EQ(run({"--json", "-"}), kSuccess) << error_;
  const nlohmann::json reductions = nlohmann::json::parse(out_)["reductions"];
  ASSERT_EQ(reductions.size(), 3u);
  EXPECT_EQ(reductions[2]["name"], "series");
  EXPECT_EQ(reductions[2]["count"], 1);
}

TEST_F(Checked, WhatIsStableAtAnyStepHasNoLimit) {
  write("100, integrator: implicit");
  ASSERT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("certified up to any length\nlimit       none: no step is too long\n"),
            std::string::npos)
      << out_;
}

TEST_F(Checked, NothingIsCertifiedOfWhatIsNotCertain) {
  std::ofstream(path_) << R"(cordis: 1
name: stars
space: 2
step: {rate_hz: 4000}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0]}
  b: {kind: mass, mass_kg: 2, at_m: [3, 0], velocity_m_per_s: [0, 1]}
liaisons:
  gravitation: {elasticity: "mass_a_kg*mass_b_kg/distance_m^2"}
links:
  - {liaison: gravitation, between: [a, b], rest_m: 0}
)";
  ASSERT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("not certain: gravitation"), std::string::npos) << out_;
  EXPECT_EQ(out_.find("certified"), std::string::npos) << out_;
  EXPECT_EQ(out_.find("no step is too long"), std::string::npos) << out_;
}

TEST_F(Checked, WhatSignalsBringInIsSaidToBeLeftOutOfTheErrors) {
  const auto check = [&](const std::string& asked, const std::string& force) {
    std::ofstream(path_) << test::filled(R"(cordis: 1
name: slowed
space: 1
step: {integrator: cordis}
accuracy: {<asked>}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: [0.1], driven: {force_n: ["<force>"]}}
liaisons:
  holder: {kind: spring, stiffness_n_per_m: 1000}
links:
  - {liaison: holder, between: [ground, bob]}
signals:
  v: {of: bob, quantity: velocity, axis: x}
)",
                                         {{"asked", asked}, {"force", force}});
    EXPECT_EQ(run({}), kSuccess) << error_;
    return out_;
  };
  const std::string kLeftOut = "            without what the signals named above bring in\n";
  const std::string kPromise = "pitch and decay are those without what signals bring in: ";
  for (const char* asked :
       {"tolerance: 0.01, band_hz: 40", "tolerance: 0.1, band_hz: 40, over_s: 0.1"}) {
    const std::string by_signal = check(asked, "-0.5 * v");
    EXPECT_NE(by_signal.find(kLeftOut), std::string::npos) << by_signal;
    EXPECT_EQ(run({"--json", "-"}), kSuccess) << error_;
    EXPECT_TRUE(nlohmann::json::parse(out_)["accuracy"]["leaves_signals_out"].get<bool>());

    const std::string by_velocity = check(asked, "-0.5 * velocity_x_m_per_s");
    EXPECT_EQ(by_velocity.find(kLeftOut), std::string::npos) << by_velocity;
    EXPECT_EQ(run({"--json", "-"}), kSuccess) << error_;
    EXPECT_FALSE(nlohmann::json::parse(out_)["accuracy"]["leaves_signals_out"].get<bool>());
  }
  EXPECT_NE(check("tolerance: 0.01, band_hz: 40", "-0.5 * v").find(kPromise), std::string::npos)
      << out_;
  EXPECT_NE(error_.find("warning: " + kPromise), std::string::npos) << error_;
}

TEST_F(Checked, WhatVibratesBesideWhatTravelsFarHasAnErrorOfItsOwn) {
  const auto check = [&](const std::string& speed) {
    std::ofstream(path_) << test::filled(R"(cordis: 1
name: pair
space: 1
step: {integrator: cordis}
accuracy: {tolerance: 0.01, band_hz: 1, over_s: 1}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [0], velocity_m_per_s: [<speed>]}
  b: {kind: mass, mass_kg: 1, at_m: [1.0001], velocity_m_per_s: [<speed>]}
liaisons:
  stiff: {kind: spring, stiffness_n_per_m: 500000, rest_m: 1}
links:
  - {liaison: stiff, between: [a, b]}
)",
                                         {{"speed", speed}});
    EXPECT_EQ(run({}), kSuccess) << error_;
    return out_;
  };
  const std::string kOwn = "what is joined to a moves by itself with an error of ";
  EXPECT_NE(check("10").find(kOwn), std::string::npos) << out_;
  EXPECT_NE(error_.find("warning: the tolerance is that of all motion together: " + kOwn),
            std::string::npos)
      << error_;
  EXPECT_EQ(run({"--json", "-"}), kSuccess) << error_;
  const nlohmann::json json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["asked"]["worst_body"]["mat"]["name"], "a") << out_;
  EXPECT_GT(json["asked"]["worst_body"]["error"].get<double>(), 0.1);
  EXPECT_EQ(check("0").find(kOwn), std::string::npos) << out_;
}

TEST_F(Checked, BetweenTheTwoLimitsItSaysWhatTheRunWatches) {
  // taut: K dt^2 / m = 4.1, by a state that nothing has entered at the start
  std::ofstream(path_) << test::snatch("410000");
  ASSERT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("not certain: the scene may be unstable in some poses or states;\n"
                      "            energy and K' + 2 Z' are watched during the run; a rate_hz of "
                      "2000 is stable in all\n"),
            std::string::npos)
      << out_;
  EXPECT_NE(error_.find("warning: at 1000 Hz the scene may be unstable in some poses or states: "),
            std::string::npos)
      << error_;
  EXPECT_NE(error_.find("; energy and K' + 2 Z' are watched during the run"), std::string::npos)
      << error_;
}

TEST_F(Checked, WhatNothingBoundsIsNamedWithItsPlace) {
  const auto of_law = [&](const std::string& law) {
    std::ofstream(path_) << test::filled(R"(cordis: 1
name: led
space: 1
step: {rate_hz: 1000}
matter:
  a: {kind: fixed, at_m: 0}
  m: {kind: mass, mass_kg: 0.1, at_m: 0.1}
signals: {far: {of: m, quantity: position}}
liaisons:
  c: {elasticity: '<law>', rest_m: 0}
links: [{liaison: c, between: [a, m]}]
)",
                                         {{"law", law}});
    EXPECT_EQ(run({}), kSuccess) << error_;
    return std::pair(out_, error_);
  };
  const std::string place = path_ + ":10)";
  for (const auto& [law, name] :
       {std::pair("100 * far * elongation_m", "far"), std::pair("time_s * elongation_m", "time_s"),
        std::pair("m.speed_m_per_s * sin(time_s) * elongation_m", "m.speed_m_per_s"),
        std::pair("min(far, 1) * elongation_m", "far")}) {
    const auto& [out, error] = of_law(law);
    const std::string named = ": '" + std::string(name) + "' (" + place;
    EXPECT_NE(out.find(named + ";"), std::string::npos) << law << "\n" << out;
    EXPECT_NE(error.find(named + "\n"), std::string::npos) << law << "\n" << error;
  }
  const auto& [out, error] = of_law("(m.speed_m_per_s + time_s) * elongation_m");
  EXPECT_NE(out.find("'m.speed_m_per_s' (" + place + ", 'time_s' (" + place), std::string::npos)
      << out;
}

TEST_F(Checked, AFlowThatALawHasToHoldIsNoCertainStep) {
  const auto in_flow = [&](const std::string& speed) {
    std::ofstream(path_) << test::filled(R"(cordis: 1
name: wind
space: 1
step: {rate_hz: 1000}
world: {viscosity_n_s_per_m: 0.1, flow_m_per_s: [<speed>]}
matter:
  w: {kind: fixed, at_m: 0}
  m: {kind: mass, mass_kg: 0.001, at_m: 0}
liaisons:
  l: {elasticity: {kind: power, coefficient: 1.0e+5, exponent: 3}}
links:
  - {liaison: l, between: [w, m], rest_m: 0}
)",
                                         {{"speed", speed}});
    EXPECT_EQ(run({}), kSuccess) << error_;
    return out_.find("stable in every pose and state") != std::string::npos;
  };
  EXPECT_TRUE(in_flow("2"));
  EXPECT_FALSE(in_flow("2000")) << "200 N";
}

TEST_F(Checked, ARateThatIsProposedPromisesNoMoreThanItsReport) {
  const auto crowd = [&](const std::string& rate) {
    std::ofstream(path_) << test::filled(R"(cordis: 1
name: crowd
space: 3
step: {rate_hz: <rate>}
matter:
  cloud: {kind: lattice, structure: cubic, corner_m: [0, 0, 0], counts: [5, 5, 5], spacing_m: 0.01, mass_kg: 0.001}
liaisons:
  hold: {kind: state_machine, stiffness_n_per_m: 100}
links:
  - {liaison: hold, within: cloud, rest_m: 0.02, range_m: 1}
)",
                                         {{"rate", rate}});
    return run({});
  };
  EXPECT_EQ(crowd("3000"), kSuccess) << error_;
  EXPECT_NE(out_.find("in every pose and state in which no link turns about"), std::string::npos);
  EXPECT_EQ(crowd("1000"), kBadInput);
  EXPECT_NE(
      error_.find("a rate_hz of 3000 is stable in every pose and state in which no link turns "
                  "about"),
      std::string::npos)
      << error_;
}

TEST_F(Checked, NoPartnersAreCertifiedWhereNothingIs) {
  const auto balls = [&](const std::string& rate) {
    std::ofstream(path_) << test::filled(R"(cordis: 1
name: balls
space: 3
step: {rate_hz: <rate>, gesture_rate_hz: 100}
matter:
  s: {kind: lattice, structure: cubic, corner_m: [0, 0, 0], counts: [4, 4, 4], spacing_m: 0.02, mass_kg: 0.001}
liaisons:
  push: {kind: state_machine, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.02, pulls: false}
links:
  - {liaison: push, within: s, rest_m: 0.01, range_m: 0.01}
)",
                                         {{"rate", rate}});
    EXPECT_EQ(run({"--json", "-"}), kSuccess) << error_;
    const nlohmann::json set = nlohmann::json::parse(out_)["stability"]["sets"][0];
    const bool is_certified = !set["certified_partners"].is_null();
    EXPECT_EQ(run({}), kSuccess) << error_;
    EXPECT_EQ(out_.find("touches more than") != std::string::npos, is_certified) << out_;
    return is_certified;
  };
  EXPECT_TRUE(balls("1000"));
  EXPECT_FALSE(balls("200")) << "K' = 2.5 of a touch";
}

TEST_F(Checked, WhatCollisionsGainAddsUpWhereItIsMuch) {
  const auto bounces = [&](const std::string& rate, const std::string& law = "") {
    std::ofstream(path_) << test::filled(R"(cordis: 1
name: bounce
space: 1
step: {rate_hz: <rate>}
world: {gravity_m_per_s2: -9.81}
matter:
  floor: {kind: fixed, at_m: 0}
  ball: {kind: mass, mass_kg: 0.001, at_m: 0.03}
liaisons:
  contact: {kind: state_machine, stiffness_n_per_m: 700, pulls: false<law>}
links:
  - {liaison: contact, between: [floor, ball], rest_m: 0.01}
)",
                                         {{"rate", rate}, {"law", law}});
    EXPECT_EQ(run({}), kSuccess) << error_;
    EXPECT_NE(out_.find("one collision gains"), std::string::npos) << out_;
    return out_.find("what collisions gain adds up") != std::string::npos;
  };
  const auto may_jump = [&] {
    return out_.find("at worst, more where its force jumps: ") != std::string::npos;
  };
  EXPECT_TRUE(bounces("1000"));   // K' = 0.7
  EXPECT_FALSE(bounces("3000"));  // 0.078
  EXPECT_FALSE(may_jump());
  bounces("3000", ", elasticity: {kind: power, coefficient: 10, exponent: 1.5}");
  EXPECT_FALSE(may_jump());
  bounces("3000", ", elasticity: {kind: table, at_m: [0], force_n: [-0.1]}");
  EXPECT_TRUE(may_jump());
}

TEST_F(Checked, PortsAreJudgedInTheirRole) {
  write("100",
        R"(  - {liaison: holder, between: [key, bob]}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: [0]}
)");
  // K (T / 2 + d T) with T = 0.1 s: 150 N s/m with one period of delay, 50 without
  ASSERT_EQ(run({}), kSuccess) << error_;
  EXPECT_NE(out_.find("safe from 150 N s/m of the device on"), std::string::npos) << out_;
  EXPECT_NE(out_.find("and 1 period of delay\n"), std::string::npos) << out_;
  EXPECT_EQ(out_.find("the device of"), std::string::npos) << out_;
}

TEST_F(Checked, PortsThatFollowEachOtherAndAreAlikeHaveOneParagraph) {
  const auto keys = [&](const std::string& other) {
    std::ofstream(path_) << R"(cordis: 1
name: keys
space: 2
step: {rate_hz: 5000}
parts:
  key: {ports: {finger: {device: keyboard, axes: [0], role: mass, at_m: [0, 0.1], along: y, needs: {force_n: 2}}}}
matter:
  keys: {part: key, repeat: {count: 16, translate_m: [0.05, 0]}}
  bob: {kind: mass, mass_kg: 1, at_m: [0, 0.2]}
liaisons: {pad: {kind: spring_damper, stiffness_n_per_m: 10, viscosity_n_s_per_m: 0.1}}
links: [{liaison: pad, between: [")"
                         << other << "\", bob]}]\n";
    EXPECT_EQ(run({}), kSuccess) << error_;
    std::size_t ports = 0;
    for (std::size_t line = out_.find("\nport "); line != std::string::npos;
         line = out_.find("\nport ", line + 1)) {
      ++ports;
    }
    return ports;
  };
  EXPECT_EQ(keys("keys[0].finger"), 1u) << out_;
  EXPECT_NE(
      out_.find("\nport        16 ports keys[0].finger to keys[15].finger (" + path_ + ":6): "),
      std::string::npos)
      << out_;
  EXPECT_EQ(keys("keys[5].finger.handle"), 3u) << out_;
  EXPECT_NE(out_.find("\nport        5 ports keys[0].finger to keys[4].finger ("),
            std::string::npos)
      << out_;
  EXPECT_NE(out_.find("\nport        keys[5].finger ("), std::string::npos) << out_;
  EXPECT_NE(out_.find("\nport        10 ports keys[6].finger to keys[15].finger ("),
            std::string::npos)
      << out_;
}

/// A launch file beside the scene, with a device of rate 10 Hz and this viscosity.
class CheckedLaunch : public Checked {
 protected:
  static constexpr const char* kKey = R"(  - {liaison: holder, between: [key, bob]}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: [0]}
)";

  CheckedLaunch() {
    write("100", kKey);
    scene_ = path_;
    device_ = path_ + ".device.yaml";
    path_ += ".launch.yaml";
  }
  ~CheckedLaunch() override {
    std::remove(scene_.c_str());
    std::remove(device_.c_str());
  }
  void launch(const std::string& clock, const std::string& viscosity,
              const std::string& more = "") const {
    std::ofstream(device_) << R"(cordis: 1
driver: mock
axes: 1
rate_hz: 10
moving_mass_kg: 1
viscosity_n_s_per_m: )" << viscosity
                           << "\n"
                           << more;
    std::ofstream(path_) << R"(cordis: 1
session: checked
clock: )" << clock
                         << "\nnodes:\n  sim: {node: sim_node, scene: " << scene_
                         << "}\n  keyboard: {node: device_node, device: " << device_ << "}\n";
  }

  SceneCheck check(const std::vector<std::string>& overrides = {}) const {
    CheckOptions options;
    options.file = path_;
    options.overrides = overrides;
    return check_scene(options);
  }

  std::string scene_;
  std::string device_;
};

TEST_F(CheckedLaunch, IsJudgedAtItsDevicesAndItsClock) {
  launch("lockstep", "200");
  const std::string text = text_of(check());
  EXPECT_NE(text.find("safe from 50 N s/m of the device on"), std::string::npos) << text;
  EXPECT_NE(text.find("and 0 periods of delay\n"), std::string::npos) << text;
  EXPECT_NE(text.find("the device of keyboard supports "), std::string::npos) << text;

  const SceneCheck realtime = check({"clock=realtime"});
  const nlohmann::json json = nlohmann::json::parse(json_of(realtime));
  EXPECT_EQ(json["ports"][0]["delay_periods"], 1);
  EXPECT_EQ(json["ports"][0]["devices"][0]["node"], "keyboard");
  EXPECT_EQ(json["ports"][0]["devices"][0]["supported"], true);
  EXPECT_TRUE(json["problems"].empty());
}

TEST_F(CheckedLaunch, ThePortCountsTheDelayThatItsDeviceAdds) {
  launch("lockstep", "200", "delay_periods: 1\n");
  // K (T / 2 + d T) with T = 0.1 s: 150 N s/m with one period of delay, 50 without
  const std::string text = text_of(check());
  EXPECT_NE(text.find("safe from 150 N s/m of the device on"), std::string::npos) << text;
  EXPECT_NE(text.find("and 1 period of delay\n"), std::string::npos) << text;
  const nlohmann::json json = nlohmann::json::parse(json_of(check({"clock=realtime"})));
  EXPECT_EQ(json["ports"][0]["delay_periods"], 2);
}

TEST_F(CheckedLaunch, ADeviceThatThePortIsTooStiffForIsRefusedAsByARun) {
  launch("realtime", "2");
  const SceneCheck refused = check();
  EXPECT_NE(text_of(refused).find(" N/m: see below\n"), std::string::npos) << text_of(refused);
  EXPECT_TRUE(refused.problems.has_errors());
  const nlohmann::json json = nlohmann::json::parse(json_of(refused));
  EXPECT_EQ(json["problems"][0]["severity"], "error");
  EXPECT_EQ(json["problems"][0]["file"], scene_);
  EXPECT_EQ(json["problems"][0]["message"].get<std::string>().find(
                "port 'key' is as stiff as 1000 N/m, and the device 'keyboard' supports "),
            0u);
  EXPECT_EQ(json["ports"][0]["devices"][0]["supported"], false);
}

TEST_F(CheckedLaunch, WhatIsWrongOfDeviceAndSceneStandsInBothReportsInTheSameWords) {
  struct Case {
    const char* rate;
    const char* viscosity;
    std::size_t problem_count;
  };
  for (const Case& tried :
       {Case{"100", "200", 0}, Case{"100", "2", 1}, Case{"50", "200", 1}, Case{"50", "2", 2}}) {
    path_ = std::exchange(scene_, path_);
    write(tried.rate, kKey);
    path_ = std::exchange(scene_, path_);
    launch("realtime", tried.viscosity);
    config::Problems problems_of_run;
    const config::Launch launch = config::load_launch(path_, {}, problems_of_run);

    sim::read_sim_config(launch, launch.nodes.at(0), problems_of_run);

    EXPECT_EQ(problems_of_run.all().size(), tried.problem_count) << problems_of_run.text();
    EXPECT_EQ(problems_of_run.text(), check().problems.text());
  }
}

TEST_F(CheckedLaunch, ADeviceThatNeedsAFasterAnswerThanAPeriodIsAWarningInRealTime) {
  launch("realtime", "100");
  const SceneCheck slow = check();
  EXPECT_NE(text_of(slow).find("enough once its answers are measured to be fast"),
            std::string::npos)
      << text_of(slow);
  EXPECT_FALSE(slow.problems.has_errors());
  const nlohmann::json json = nlohmann::json::parse(json_of(slow));
  EXPECT_EQ(json["problems"][0]["severity"], "warning");
  const std::string message = json["problems"][0]["message"];
  EXPECT_NE(message.find(" us; one period is assumed until 20 answers are measured"),
            std::string::npos)
      << message;
  const nlohmann::json device = json["ports"][0]["devices"][0];
  EXPECT_EQ(device["supported"], false);
  EXPECT_GT(device["needed_answer_delay_s"], 0.01);
  EXPECT_LT(device["needed_answer_delay_s"], 0.1);
  EXPECT_FALSE(check({"clock=lockstep"}).problems.has_errors()) << "without delay it is supported";
}

TEST_F(CheckedLaunch, WordsChangeALaunchFileAlone) {
  launch("realtime", "200");
  EXPECT_THROW(check({"sim.scene=/nowhere.yaml"}), config::ConfigError);
  path_ = std::exchange(scene_, path_);
  EXPECT_EQ(run({"clock=lockstep"}), kBadInput);
  EXPECT_NE(error_.find("'clock=lockstep' changes a launch file, and " + path_ + " is a scene"),
            std::string::npos)
      << error_;
}

TEST_F(CheckedLaunch, WithoutASimNodeThereIsNothingToJudge) {
  std::ofstream(path_) << R"(cordis: 1
session: checked
clock: realtime
nodes:
  view: {node: viz_node}
)";
  EXPECT_EQ(run({}), kFailure);
  EXPECT_NE(error_.find("has no sim_node"), std::string::npos) << error_;
}

TEST_F(Checked, WhatAPortNeedsOfItsDeviceIsSaid) {
  for (const std::string role : {"mass", "liaison"}) {
    const std::string port =
        "ports:\n  key: {device: keyboard, axes: [0], at_m: [0], role: " + role;
    write("100", port + ", needs: {travel_m: 0.05, down_m: 0.03, force_n: 5}}\n");
    ASSERT_EQ(run({}), kSuccess) << error_;
    EXPECT_NE(out_.find("needs a device of 0.05 m of travel and 0.03 m below its rest and 5 N "
                        "along each of its axes\n"),
              std::string::npos)
        << out_;
    ASSERT_EQ(run({"--json", "-"}), kSuccess) << error_;
    EXPECT_EQ(nlohmann::json::parse(out_)["ports"][0]["needs"],
              (nlohmann::json{{"travel_m", 0.05}, {"down_m", 0.03}, {"force_n", 5.0}}));
    write("100", port + "}\n");
    ASSERT_EQ(run({}), kSuccess) << error_;
    EXPECT_EQ(out_.find("needs a device"), std::string::npos) << out_;
  }
}

TEST_F(Checked, TooSlowForRealTimeIsReportedWithBothAlternatives) {
  write("100");
  CheckOptions options;
  options.file = path_;
  SceneCheck check = check_scene(options);

  check.step_nsec = 1.25e7;  // 80 steps a second are what the machine can do, and 50 the limit
  EXPECT_NE(
      text_of(check).find("TOO SLOW for real time: run it with clock asap, 1.25 times slower, "
                          "or at 80 steps per second\n"),
      std::string::npos)
      << text_of(check);
  const nlohmann::json other = nlohmann::json::parse(json_of(check))["load"]["alternatives"];
  EXPECT_EQ(other["asap"]["times_slower"], 1.25);
  EXPECT_EQ(other["realtime"]["rate_hz"], 80.0);
  EXPECT_EQ(other["realtime"]["stable"], true);

  check.scene.ports
      .emplace_back();  // no device plays it as fast as possible, and simulated ones wait
  EXPECT_NE(text_of(check).find("run it with clock lockstep, 1.25 times"), std::string::npos);
  check.scene.ports.clear();

  check.step_nsec = 1.15e7;  // 86.9, but a scene has a whole number of steps per gesture
  EXPECT_EQ(check.real_time_rate(), 80.0);
  check.step_nsec = 1.5e8;  // not even one
  EXPECT_NE(text_of(check).find("slower, or make it smaller: a step takes longer than a gesture\n"),
            std::string::npos)
      << text_of(check);
  EXPECT_FALSE(nlohmann::json::parse(json_of(check))["load"]["alternatives"]["realtime"]["stable"]);

  check.step_nsec = 2.5e7;
  EXPECT_NE(text_of(check).find("40 steps per second, which is unstable"), std::string::npos);

  check.step_nsec = 1e6;
  EXPECT_EQ(text_of(check).find("TOO SLOW"), std::string::npos);
  EXPECT_FALSE(nlohmann::json::parse(json_of(check))["load"].contains("alternatives"));
}

TEST_F(Checked, AKeyThatStandsTwiceHidesNothingElse) {
  write("100", R"(space: 2
tuning: 440
matter: {}
)");
  EXPECT_EQ(run({}), kBadInput);
  for (const char* sentence :
       {":12:1: error: duplicate key 'space'", ":13:1: error: unknown key 'tuning' in scene",
        ":14:1: error: duplicate key 'matter'"}) {
    EXPECT_NE(error_.find(sentence), std::string::npos) << error_;
  }
}

TEST_F(Checked, AFixedPointThatSetsTheLimitHasNoMass) {
  std::ofstream(path_) << R"(cordis: 1
space: 2
step: {rate_hz: 5000}
matter:
  sun: {kind: fixed, at_m: [0, 0]}
  earth: {kind: mass, mass_kg: 0.1, at_m: [1, 0], velocity_m_per_s: [0, 1]}
liaisons:
  gravity: {parameters: {gm: 1.0}, elasticity: "gm * mass_b_kg / distance_m^2"}
links:
  - {liaison: gravity, between: [sun, earth]}
)";
  EXPECT_EQ(run({"--plan"}), kSuccess) << error_;
  EXPECT_NE(out_.find(":10) at the fixed point sun ("), std::string::npos) << out_;
}

TEST_F(Checked, AHandAtAPortOfRoleLiaisonHasNoLimitOfItsViscosityWithoutDelay) {
  write("100",
        R"(ports:
  key: {device: keyboard, axes: [0], role: liaison, mass_kg: 1, at_m: [0]}
)");
  ASSERT_EQ(run({"--plan"}), kSuccess) << error_;
  EXPECT_NE(out_.find(" N/m and as its own viscosity divided by 100 ms, at 10 Hz and 1 period"),
            std::string::npos)
      << out_;
}

TEST_F(Checked, TheReportForAProgramReplacesNoSceneAndNoTake) {
  write("100");
  const auto size = std::filesystem::file_size(path_);
  EXPECT_EQ(run({"--json", path_}), kBadInput);
  EXPECT_NE(error_.find("--json would overwrite its own file " + path_), std::string::npos)
      << error_;
  EXPECT_EQ(out_, "");
  const std::string other = path_ + ".other.yaml";
  const std::string take = path_ + ".mcap";
  for (const std::string& kept : {other, take}) {
    std::ofstream(kept) << "kept";
    EXPECT_EQ(run({"--json", kept}), kBadInput);
    EXPECT_NE(error_.find("--json would overwrite the "), std::string::npos) << error_;
    EXPECT_EQ(std::filesystem::file_size(kept), 4u);
    std::filesystem::remove(kept);
  }
  EXPECT_EQ(std::filesystem::file_size(path_), size);
}

TEST_F(Checked, AProgramReadsWhyASingleFileIsRefused) {
  const auto error_of = [this](const std::vector<std::string>& words) {
    EXPECT_EQ(run(words), kBadInput);
    const nlohmann::json json = nlohmann::json::parse(out_, nullptr, /*allow_exceptions=*/false);
    EXPECT_EQ(json.value("file", ""), path_) << out_;
    return json.value("error", "");
  };
  write("100", "tuning: 440\n");
  EXPECT_NE(error_of({"--json", "-"}).find("unknown key 'tuning'"), std::string::npos);
  EXPECT_NE(error_.find("unknown key 'tuning'"), std::string::npos) << error_;
  std::ofstream(path_) << "cordis: [";
  EXPECT_NE(error_of({"--json", "-"}).find(path_ + ":"), std::string::npos);
  std::remove(path_.c_str());
  EXPECT_NE(error_of({"--json", "-"}).find("cannot be read"), std::string::npos);

  const std::string file = path_ + ".json";
  EXPECT_EQ(run({"--json", file}), kBadInput);
  nlohmann::json json;
  std::ifstream(file) >> json;
  EXPECT_EQ(json["file"], path_);
  std::remove(file.c_str());
}

TEST_F(Checked, WrongWordsAndFilesAreBadInput) {
  write("100");
  EXPECT_EQ(run({"--band", "loud"}), kBadInput);
  EXPECT_NE(error_.find("--band must be a number"), std::string::npos) << error_;
  write("100", "tuning: 440\n");
  EXPECT_EQ(run({}), kBadInput);
  EXPECT_NE(error_.find(":12:1: error"), std::string::npos) << error_;
}

}  // namespace
}  // namespace cordis::cli
