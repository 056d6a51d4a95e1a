// tests/cli/simulate_test.cpp -- numbers of a scene that is played offline.
#include <array>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/exit_code.h"
#include "cli/simulate/row_schedule.h"
#include "cli/simulate/simulate_verb.h"
#include "tests/cli/captured_run.h"
#include "tests/support/filled.h"
#include "tests/support/watched_scenes.h"

namespace cordis::cli {
namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;

/// A mass that falls freely from rest: its height is -g t^2 / 2, which the scheme keeps exactly.
constexpr const char* kFalling = R"(cordis: 1
name: falling
space: 2
step: {rate_hz: 4000, integrator: cordis}
world: {gravity_m_per_s2: [0, -10]}
matter:
  stone: {kind: mass, mass_kg: 2, at_m: [0.5, 0]}
signals:
  height: {of: stone, quantity: position, axis: y}
)";

/// It begins with what a run has saved.
constexpr const char* kFallingOn = R"(cordis: 1
name: falling_on
space: 2
step: {rate_hz: 4000, integrator: cordis}
start_state: stone.state
world: {gravity_m_per_s2: [0, -10]}
matter:
  stone: {kind: mass, mass_kg: 2, at_m: [0.5, 0]}
)";

/// The step is beyond the limit of stability.
constexpr const char* kDiverging = R"(cordis: 1
name: diverging
space: 1
step: {rate_hz: 1000, integrator: cordis}
matter:
  wall: {kind: fixed, at_m: 0}
  ball: {kind: mass, mass_kg: 1, at_m: 0.1}
liaisons: {steel: {kind: spring_damper, stiffness_n_per_m: 5.0e+6, viscosity_n_s_per_m: 0}}
links: [{liaison: steel, between: [wall, ball], rest_m: 0}]
signals: {place: {of: ball, quantity: position}}
)";

/// A ball flies between two walls, each so stiff that a touch may gain energy: not certain. A key is
/// tied to a fixed point.
constexpr const char* kBouncing = R"(cordis: 1
name: bouncing
space: 1
step: {rate_hz: 1000, integrator: cordis}
liaisons:
  hit: {kind: state_machine, stiffness_n_per_m: 19100, pulls: false}
  wall: {kind: spring, stiffness_n_per_m: 100}
matter:
  low: {kind: fixed, at_m: -0.1}
  high: {kind: fixed, at_m: 0.113}
  ground: {kind: fixed, at_m: 0.5}
  ball: {kind: mass, mass_kg: 0.01, at_m: 0, velocity_m_per_s: 1.234}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 0.6}
links:
  - {liaison: hit, between: [low, ball], rest_m: 0.03}
  - {liaison: hit, between: [ball, high], rest_m: 0.03}
  - {liaison: wall, between: [ground, key], rest_m: 0.1}
)";

class Simulate : public testing::Test {
 protected:
  Simulate() : folder_(testing::TempDir() + "simulate." + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
  }
  ~Simulate() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string put(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  std::string text_of(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  int run(std::vector<std::string> words) {
    CommandLine line("cordis", "", "1");
    add_simulate_verb(line);
    words.insert(words.begin(), "simulate");
    return run_captured(line, words, out_, error_);
  }

  /// The table of a CSV file; its header goes to `header_`.
  std::vector<std::vector<double>> table(const std::string& name) {
    std::istringstream lines(text_of(name));
    std::string line;
    std::getline(lines, line);
    header_ = line;
    std::vector<std::vector<double>> rows;
    while (std::getline(lines, line)) {
      rows.emplace_back();
      for (const char* cell = line.c_str(); *cell != '\0';) {
        char* end = nullptr;
        rows.back().push_back(std::strtod(cell, &end));
        cell = *end == ',' ? end + 1 : end;
      }
    }
    return rows;
  }

  std::string folder_;
  std::string out_;
  std::string error_;
  std::string header_;
};

TEST_F(Simulate, WritesARowForEachStepWithUnitsInTheHeader) {
  const std::string scene = put("fall.yaml", kFalling);
  ASSERT_EQ(
      run({scene, "--duration", "1s", "--every", "step", "--mat", "stone", "--csv", path("a.csv")}),
      kSuccess)
      << error_;
  const auto rows = table("a.csv");
  EXPECT_EQ(header_, "time [s],height [m],stone.x [m],stone.y [m]");
  ASSERT_EQ(rows.size(), 4000u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double n = static_cast<double>(i + 1);
    EXPECT_EQ(rows[i][0], n / 4000.0);
    EXPECT_NEAR(rows[i][1], -5.0 * n * n / 16.0e6, 1e-12 * n);
    EXPECT_EQ(rows[i][2], 0.5);
    EXPECT_EQ(rows[i][3], rows[i][1]);
  }
}

/// 12,100 masses and 23,981 links, pulled at a corner.
constexpr const char* kNet = R"(cordis: 1
name: net
space: 1
step: {rate_hz: 4000, integrator: cordis}
matter:
  net: {kind: grid, rows: 110, columns: 110, mass_kg: 0.001, stiffness_n_per_m: 1000, viscosity_n_s_per_m: 0.01}
  hand: {kind: fixed, at_m: 0.01}
liaisons: {thread: {kind: spring_damper, stiffness_n_per_m: 1000, viscosity_n_s_per_m: 0.01}}
links: [{liaison: thread, between: [hand, "net[0]"]}]
)";

/// More than 4,096 balls, which fall upon one another.
constexpr const char* kGravel = R"(cordis: 1
name: gravel
space: 2
step: {rate_hz: 4000, integrator: cordis}
world: {gravity_m_per_s2: [0, -9.81]}
liaisons: {stony: {stiffness_n_per_m: 500, viscosity_n_s_per_m: 0.05, pulls: false, range: rest}}
matter:
  gravel:
    kind: pack
    fill: 0.5
    seed: 1
    region: {from_m: [0, 0], to_m: [0.9, 0.75]}
    ball: {mass_kg: 0.001, radius_m: 0.005}
links: [{liaison: stony, within: gravel, name: contact}]
)";

TEST_F(Simulate, ComesToTheSameStateByAnyNumberOfThreads) {
  for (const char* text : {kNet, kGravel}) {
    const std::string scene = put("large.yaml", text);
    ASSERT_EQ(run({scene, "--duration", "0.02s", "--threads", "1"}), kSuccess) << error_;
    const std::string state = out_.substr(out_.find("state hash"));
    EXPECT_THAT(out_, testing::Not(HasSubstr("threads")));
    for (const std::string threads : {"2", "3", "auto"}) {
      ASSERT_EQ(run({scene, "--duration", "0.02s", "--threads", threads}), kSuccess) << error_;
      EXPECT_THAT(out_, HasSubstr(state)) << threads;
      if (threads == "auto") continue;
      EXPECT_THAT(out_, HasSubstr("by " + threads + " threads"));
    }
  }
}

TEST_F(Simulate, RefusesNumbersOfThreadsThatAreNone) {
  const std::string scene = put("fall.yaml", kFalling);
  for (const char* threads : {"0", "257", "-1", "many"}) {
    EXPECT_EQ(run({scene, "--duration", "0.01s", "--threads", threads}), kBadInput) << threads;
    EXPECT_THAT(error_, HasSubstr("--threads")) << threads;
  }
}

TEST_F(Simulate, SavesTheStateThatASceneGoesOnFrom) {
  const std::string scene = put("fall.yaml", kFalling);
  ASSERT_EQ(run({scene, "--duration", "0.25s", "--save-state", path("stone.state")}), kSuccess)
      << error_;
  ASSERT_EQ(run({put("on.yaml", kFallingOn), "--duration", "0.25s"}), kSuccess) << error_;
  const std::string later = out_;
  ASSERT_EQ(run({scene, "--duration", "0.5s"}), kSuccess) << error_;

  EXPECT_THAT(later, HasSubstr("simulated 0.25 s"));
  EXPECT_THAT(later, HasSubstr(out_.substr(out_.find("state hash"))));
  EXPECT_THAT(later, HasSubstr("after 2000 steps"));
}

TEST_F(Simulate, CountsRowsFromASavedStateOn) {
  const std::string scene = put("fall.yaml", kFalling);
  ASSERT_EQ(run({scene, "--duration", "0.25s", "--save-state", path("stone.state")}), kSuccess);
  const std::string on = put("on.yaml", kFallingOn);
  for (const std::string every : {"0.01s", "40"}) {
    ASSERT_EQ(run({on, "--duration", "0.1s", "--every", every, "--csv", path("on.csv")}), kSuccess)
        << error_;
    const auto rows = table("on.csv");
    ASSERT_EQ(rows.size(), 10u) << every;
    for (std::size_t i = 0; i < rows.size(); ++i)
      EXPECT_DOUBLE_EQ(rows[i][0], 0.25 + 0.01 * static_cast<double>(i + 1));
  }
}

TEST_F(Simulate, SavesAStateInPlaceOfNothingButAState) {
  const std::string scene = put("fall.yaml", kFalling);
  const std::string launch = put("launch.yaml", R"(cordis: 1
nodes:
  sim: {node: sim_node, scene: fall.yaml}
)");
  const std::string state = put("old.state", "cordis_state: 1\n");

  EXPECT_EQ(run({launch, "--duration", "0.1s", "--save-state", scene}), kBadInput);
  EXPECT_THAT(error_, HasSubstr("--save-state would overwrite " + scene));
  EXPECT_EQ(text_of("fall.yaml"), kFalling);
  EXPECT_EQ(
      run({launch, "--duration", "0.1s", "--csv", state, "--save-state", folder_ + "/./old.state"}),
      kBadInput);
  EXPECT_THAT(error_, HasSubstr("--csv and --save-state name the same file"));
  EXPECT_EQ(run({launch, "--duration", "0.1s", "--save-state", state}), kSuccess) << error_;
  EXPECT_THAT(text_of("old.state"), HasSubstr("step: 400\n"));
}

TEST_F(Simulate, ARunThatFailsLeavesTheOldState) {
  const std::string launch = put("d.yaml", test::filled(R"(cordis: 1
nodes:
  sim: {node: sim_node, scene: '<scene>', force: true}
)",
                                                        {{"scene", put("div.yaml", kDiverging)}}));
  put("old.state", "cordis_state: 1\n");
  const auto files = [this] {
    const std::filesystem::directory_iterator entries(folder_);
    return std::distance(begin(entries), end(entries));
  };
  const auto before = files();

  EXPECT_EQ(run({launch, "--duration", "2s", "--save-state", path("old.state")}), kFailure);

  EXPECT_EQ(text_of("old.state"), "cordis_state: 1\n");
  EXPECT_EQ(files(), before);
  EXPECT_EQ(run({launch, "--duration", "2s", "--save-state", path("none/a.state")}), kBadInput);
  EXPECT_THAT(error_, HasSubstr("No such file or directory"));
}

TEST_F(Simulate, TakesRowsByTickByStepsAndByTime) {
  const std::string scene = put("fall.yaml", kFalling);
  ASSERT_EQ(run({scene, "--duration", "0.1s", "--every", "step", "--csv", path("all.csv")}), 0);
  const auto all = table("all.csv");
  const std::vector<std::pair<std::string, std::size_t>> cases{
      {"tick", 4}, {"10", 10}, {"2.5ms", 10}, {"0.01s", 40}};
  for (const auto& [every, stride] : cases) {
    ASSERT_EQ(run({scene, "--duration", "0.1s", "--every", every, "--csv", path("some.csv")}), 0);
    const auto some = table("some.csv");
    ASSERT_EQ(some.size(), all.size() / stride) << every;
    for (std::size_t i = 0; i < some.size(); ++i)
      EXPECT_EQ(some[i], all[(i + 1) * stride - 1]) << every;
  }
}

TEST_F(Simulate, SaysWhyTheDevicesWereLetGoOf) {
  const std::string scene = put("bouncing.yaml", kBouncing);
  ASSERT_EQ(run({scene, "--duration", "60s", "--summary", path("s.json")}), kSuccess) << error_;
  const std::string reason =
      "has let go of the devices: the steps have made more than a tenth of the largest energy";
  EXPECT_THAT(error_, HasSubstr("warning: " + reason));
  EXPECT_EQ(nlohmann::json::parse(text_of("s.json"))["passed_bound"], reason);

  const std::string falling = put("fall.yaml", kFalling);
  ASSERT_EQ(run({falling, "--duration", "1s", "--summary", path("f.json")}), kSuccess) << error_;
  EXPECT_EQ(error_, "");
  EXPECT_EQ(nlohmann::json::parse(text_of("f.json"))["passed_bound"], "");
}

TEST_F(Simulate, CountsWhatTheStepsRefuseAndHaveNoRoomFor) {
  // no number from 0.1 s on: 400 of 800 steps
  const std::string scene = put("rooted.yaml", R"(cordis: 1
name: rooted
space: 1
step: {rate_hz: 4000}
matter:
  free: {kind: mass, mass_kg: 1, at_m: 1}
  led: {kind: fixed, at_m: 0, driven: {displacement_m: 'sqrt(1 - time_s / 0.100125) - 1'}}
)");
  ASSERT_EQ(run({scene, "--duration", "0.2s", "--summary", path("s.json")}), kSuccess) << error_;
  const auto after = nlohmann::json::parse(text_of("s.json"));
  EXPECT_EQ(after["refused_inputs"], 400);
  EXPECT_EQ(after["overflowed_steps"], 0);
  EXPECT_EQ(after["forgotten_pairs"], 0);
  EXPECT_THAT(error_,
              HasSubstr("warning: positions, forces and parameters refused, not finite: 400\n"));
  EXPECT_THAT(error_, testing::Not(HasSubstr("more pairs in range than room")));

  const std::string falling = put("fall.yaml", kFalling);
  ASSERT_EQ(run({falling, "--duration", "0.2s", "--summary", path("f.json")}), kSuccess) << error_;
  EXPECT_EQ(error_, "");
  EXPECT_EQ(nlohmann::json::parse(text_of("f.json"))["refused_inputs"], 0);
}

TEST_F(Simulate, CountsWholeGesturePeriods) {
  const std::string odd = put("odd.yaml", R"(cordis: 1
name: odd
space: 1
step: {rate_hz: 44100}
matter:
  stone: {kind: mass, mass_kg: 2, at_m: 0, velocity_m_per_s: 1}
signals: {place: {of: stone, quantity: position}}
)");
  const auto after = [&](const std::string& duration, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{odd, "--duration", duration, "--summary", path("s.json")};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run(words), kSuccess) << error_;
    return nlohmann::json::parse(text_of("s.json"));
  };
  // k periods have 44.1 k steps, rounded down
  EXPECT_EQ(after("437ms", {"--csv", path("t.csv")})["steps"], 19'271);
  EXPECT_EQ(after("437ms", {"--csv", path("t.csv")})["rows"], 437);
  EXPECT_EQ(after("999ms")["steps"], 44'055);
  EXPECT_EQ(after("1s")["steps"], 44'100);
  EXPECT_EQ(after("0.0001ms")["steps"], 44) << "one period at least";
  EXPECT_EQ(after("1.5ms")["steps"], 88);

  after("437ms", {"--save-state", path("odd.state")});
  std::string text = text_of("odd.yaml");
  text.replace(text.find("matter:"), 0, "start_state: odd.state\n");
  const std::string on = put("on.yaml", text);
  ASSERT_EQ(run({on, "--duration", "563ms", "--summary", path("s.json")}), kSuccess) << error_;
  const auto two = nlohmann::json::parse(text_of("s.json"));
  const auto whole = after("1s");
  EXPECT_EQ(two["steps"], whole["steps"]);
  EXPECT_EQ(two["state_hash"], whole["state_hash"]);
}

/// A mass that a spring with this rest length holds.
std::string held_by(const std::string& rest_m) {
  return R"(cordis: 1
name: held
space: 1
step: {rate_hz: 4000}
world: {gravity_m_per_s2: -9.81}
liaisons:
  k: {kind: spring_damper, stiffness_n_per_m: 1000, viscosity_n_s_per_m: 20, rest_m: ")" +
         rest_m + R"("}
matter:
  roof: {kind: fixed, at_m: 0}
  bob:  {kind: mass, mass_kg: 1, at_m: -0.5}
links: [{liaison: k, between: [roof, bob]}]
signals: {height: {of: bob, quantity: position}}
)";
}

TEST_F(Simulate, SaysThatAFormulaOfALiaisonIsNoFiniteNumber) {
  const std::string scene = put("held.yaml", held_by("-0.5 + 0.1 * sqrt(0.1001 - time_s)"));
  ASSERT_EQ(run({scene, "--duration", "0.2s", "--summary", path("s.json")}), kSuccess) << error_;
  EXPECT_THAT(error_,
              HasSubstr("warning: 399 values of formulas in 'liaisons' were no finite numbers, "
                        "first at 0.10025 s: what asks for them had no force\n"));
  const auto after = nlohmann::json::parse(text_of("s.json"));
  EXPECT_EQ(after["refused_inputs"], 399);
  EXPECT_THAT(after["parameters"].get<std::string>(), HasSubstr("399 values"));
}

TEST_F(Simulate, HoldsByASpringWhosePhaseGrowsForLong) {
  const std::string scene = put("held.yaml", held_by("-0.5 + 0.001 * sin(1.0e+9 * time_s)"));
  ASSERT_EQ(run({scene, "--duration", "2s", "--summary", path("s.json")}), kSuccess) << error_;
  EXPECT_EQ(error_, "");
  const auto after = nlohmann::json::parse(text_of("s.json"));
  EXPECT_GT(after["columns"]["height"]["least"], -0.53);
  EXPECT_EQ(after["parameters"], "");
}

TEST_F(Simulate, SaysThatTheStepsHaveMadeEnergy) {
  const std::string scene = put("bouncing.yaml", kBouncing);
  ASSERT_EQ(run({scene, "--duration", "60s", "--summary", path("s.json")}), kSuccess) << error_;
  EXPECT_THAT(error_,
              ContainsRegex("warning: at [0-9.]+ s the steps have made .* J that no account "
                            "explains, above 1 % of the largest energy"));
  const auto after = nlohmann::json::parse(text_of("s.json"));
  EXPECT_GT(after["integration_error_j"], 0.1 * after["largest_energy_j"].get<double>());

  const std::string falling = put("fall.yaml", kFalling);
  ASSERT_EQ(run({falling, "--duration", "1s", "--summary", path("f.json")}), kSuccess) << error_;
  const auto truth = nlohmann::json::parse(text_of("f.json"));
  EXPECT_LT(std::abs(truth["integration_error_j"].get<double>()),
            1e-9 * truth["largest_energy_j"].get<double>());
}

TEST_F(Simulate, SaysThatADriveBringsMoreThanTheStepIsCertifiedFor) {
  const std::string head =
      R"(cordis: 1
name: x
space: 1
step: {rate_hz: 1000}
liaisons: {d: {stiffness_n_per_m: 100, dissipation: '0.3 * speed_m_per_s^3'}}
)";
  const std::string pushed = put("pushed.yaml", head +
                                                    R"(matter:
  wall: {kind: fixed, at_m: 0}
  m: {kind: mass, mass_kg: 0.01, at_m: 1, driven: {force_n: 'if(time_s > 1e5, 200, 2)'}}
links: [{liaison: d, between: [wall, m], rest_m: 1}]
)");
  ASSERT_EQ(run({pushed, "--duration", "1s", "--summary", path("p.json")}), kSuccess) << error_;
  EXPECT_EQ(nlohmann::json::parse(text_of("p.json"))["passed_bound"], "") << error_;

  const std::string led = put("led.yaml", head +
                                              R"(matter:
  wall: {kind: fixed, at_m: 0, driven: {displacement_m: 'if(time_s < 0.3, 0,
         if(time_s < 0.3005, 200 * (time_s - 0.3), 0.1))'}}
  m: {kind: mass, mass_kg: 0.01, at_m: 1}
links: [{liaison: d, between: [wall, m], rest_m: 1}]
)");
  run({led, "--duration", "2s", "--summary", path("l.json")});
  EXPECT_THAT(error_, testing::AnyOf(HasSubstr("than its step is certified for"),
                                     HasSubstr("energy is no finite number below 1e100 J")));
}

const std::string kOneLink = "  - {liaison: c, between: [a, m]}\n";

TEST_F(Simulate, EndsWhereADrivenForceBringsTheMotionBeyondAllBounds) {
  const std::string scene = put("driven_off.yaml", R"(cordis: 1
name: driven_off
space: 1
step: {rate_hz: 1000}
matter:
  a: {kind: mass, mass_kg: 1, at_m: 1, driven: {force_n: "x_m^3"}}
signals: {x: {of: a, quantity: position}}
)");
  EXPECT_EQ(run({scene, "--duration", "10s", "--summary", path("n.json")}), kFailure);
  EXPECT_THAT(error_, HasSubstr("the scene diverged at step"));
  EXPECT_THAT(error_, HasSubstr("; the fastest is 'a'"));
  EXPECT_EQ(nlohmann::json::parse(text_of("n.json"))["complete"], false);
}

TEST_F(Simulate, SaysThatAFormulaMayMakeAStiffnessFallBelow0) {
  const std::string scene = put("falling.yaml", R"(cordis: 1
name: falling
space: 1
step: {rate_hz: 1000}
liaisons: {k: {kind: spring, stiffness_n_per_m: "100 - 200*time_s", rest_m: 0}}
matter:
  a: {kind: fixed, at_m: 0}
  m: {kind: mass, mass_kg: 0.01, at_m: 0.1}
links: [{liaison: k, between: [a, m]}]
)");
  EXPECT_EQ(run({scene, "--duration", "20s", "--summary", path("n.json")}), kFailure);
  EXPECT_THAT(error_, HasSubstr("the scene diverged at step"));
  EXPECT_THAT(error_, HasSubstr("may make its stiffness fall below 0"));
  EXPECT_THAT(error_, testing::Not(HasSubstr("may hold it")));
}

TEST_F(Simulate, EndsWhereTheEnergyIsNoFiniteNumber) {
  const std::vector<std::string> scenes{
      test::moved_mass("rate_hz: 1000", "at_m: 0.1",
                       "  c: {elasticity: '100*elongation_m - 0.5*speed_m_per_s', rest_m: 0}\n",
                       kOneLink),
      test::moved_mass("rate_hz: 44100", "at_m: 0.3",
                       R"(  k: {kind: spring, stiffness_n_per_m: 2000, rest_m: 0.1}
  c: {dissipation: '12*speed_m_per_s^3'}
)",
                       "  - {liaison: k, between: [a, m]}\n" + kOneLink)};
  for (const std::string& text : scenes) {
    const std::string scene = put("no_energy.yaml", text);
    EXPECT_EQ(run({scene, "--duration", "4s", "--summary", path("n.json")}), kFailure) << text;
    EXPECT_THAT(error_, HasSubstr("the scene diverged at step"));
    EXPECT_THAT(error_, HasSubstr("energy is no finite number below 1e100 J; the fastest is 'm'"));
    EXPECT_THAT(error_, HasSubstr("what came before is kept"));
    const auto json = nlohmann::json::parse(text_of("n.json"));
    EXPECT_EQ(json["complete"], false);
    EXPECT_THAT(json["failure"].get<std::string>(), HasSubstr("no finite number"));
    EXPECT_THAT(json["passed_bound"].get<std::string>(), HasSubstr("a tenth of the largest"))
        << "also before the first frame";
  }
}

TEST_F(Simulate, SaysOfNoFigureThatItIs0WhereTheEnergyIsNoFiniteNumber) {
  const std::string scene = put("lost.yaml", R"(cordis: 1
name: lost
space: 1
step: {rate_hz: 136.2945839943363, gesture_rate_hz: 136.2945839943363}
matter:
  g: {kind: fixed, at_m: 0}
  b: {kind: mass, mass_kg: 1, at_m: 0}
liaisons:
  first:
    rest_m: 0
    states:
      idle: {stiffness_n_per_m: 50, exits: [{to: loaded, when: age_s > 0.3, rest: 0.8}]}
      loaded: {stiffness_n_per_m: 50, final: true}
  latch:
    rest_m: 0
    states:
      free: {stiffness_n_per_m: 50, exits: [{to: loaded, when: elongation_m > 0.5}]}
      loaded: {stiffness_n_per_m: 5000, exits: [{to: gone, when: elongation_m < 0.001}]}
      gone: {stiffness_n_per_m: 1, final: true}
  cubic: {rest_m: 0, elasticity: {kind: power, coefficient: 10000, exponent: 15}}
links:
  - {liaison: first, between: [g, b]}
  - {liaison: latch, between: [g, b]}
  - {liaison: cubic, between: [g, b]}
)");
  EXPECT_EQ(run({scene, "--duration", "2s", "--summary", path("n.json")}), kFailure) << error_;
  const auto json = nlohmann::json::parse(text_of("n.json"));
  for (const char* figure : {"energy_j", "energy_drift", "integration_error_j", "largest_energy_j"})
    EXPECT_TRUE(json[figure].is_null()) << figure << ' ' << json[figure];
}

TEST_F(Simulate, JudgesAPowerOfTheSpeedByTheSpeedInReach) {
  const std::string scene = put("modes.yaml",
                                R"(cordis: 1
name: modes
space: 1
step: {rate_hz: 2700, integrator: modal}
matter:
  s: {kind: string, count: 30, mass_kg: 0.001, ends: fixed, stiffness_n_per_m: 10000, displacement_m: ['0.05*sin(0.1*index)'], layout_at_m: [0,0], layout_spacing_m: 0.01}
  b: {kind: fixed, at_m: 0.0}
liaisons: {d: {dissipation: {kind: power, coefficient: 0.15, exponent: 3}, rest_m: 0}}
links: [{liaison: d, between: [b, 's[20]']}]
)");
  EXPECT_EQ(run({scene, "--duration", "2s"}), kFailure);
  EXPECT_THAT(error_, HasSubstr("the scene diverged at step"));
  EXPECT_THAT(error_, HasSubstr("is too stiff for 2700 Hz"));
  EXPECT_THAT(error_, testing::Not(HasSubstr("within its limit")));
}

/// Scenes without devices and drives that are certified within a reach, and go beyond it.
TEST_F(Simulate, WatchesAReachWithoutDevicesAndDrives) {
  const std::vector<std::string> scenes{
      test::moved_mass("rate_hz: 1000", "at_m: 1",
                       R"(  t: {elasticity: '50 - 0*elongation_m'}
  c: {elasticity: '3.0e+4 * elongation_m^3'}
)",
                       "  - {liaison: t, between: [a, m]}\n" + kOneLink),
      test::kFallOnContact};
  for (const std::string& text : scenes) {
    const std::string scene = put("reach.yaml", text);
    run({scene, "--duration", "3s", "--summary", path("r.json")});
    const auto json = nlohmann::json::parse(text_of("r.json"));
    const auto bound = json["passed_bound"].get<std::string>();
    EXPECT_THAT(bound, testing::AnyOf(HasSubstr("more than a tenth of the largest energy"),
                                      HasSubstr("than its step is certified for")))
        << text << error_;
    EXPECT_THAT(error_, HasSubstr("above 1 % of the largest energy"));
  }
}

TEST_F(Simulate, OwnsUpToWhatViscosityHasBroughtIn) {
  const std::string scene = put("fall.yaml", test::kFallOnContact);
  run({scene, "--duration", "2s", "--summary", path("v.json")});
  EXPECT_THAT(error_, HasSubstr("can only take have brought in"));
  const auto json = nlohmann::json::parse(text_of("v.json"));
  EXPECT_GT(json["integration_error_j"].get<double>(),
            0.1 * json["largest_energy_j"].get<double>());
}

/// A swing that dies away has had most at its start.
TEST_F(Simulate, SaysTheLargestEnergyThatTheSceneHasHad) {
  const std::string scene =
      put("swing.yaml",
          test::moved_mass("rate_hz: 10000", "at_m: 0.1",
                           "  c: {kind: spring_damper, stiffness_n_per_m: 1, viscosity_n_s_per_m: "
                           "0.01, rest_m: 0}\n",
                           kOneLink));
  run({scene, "--duration", "10s", "--summary", path("s.json")});
  const auto json = nlohmann::json::parse(text_of("s.json"));
  EXPECT_LT(json["energy_j"].get<double>(), 1e-9) << "it rests";
  EXPECT_NEAR(json["largest_energy_j"].get<double>(), 0.005, 1e-5);
}

TEST_F(Simulate, GivesTheStateOfTheSameStepsInAnyPortions) {
  const std::string launch = CORDIS_SOURCE_DIR "/launch_configs/bowed_string.yaml";
  std::vector<std::string> hashes;
  for (const std::string every : {"tick", "step"}) {
    ASSERT_EQ(run({launch, "--duration", "1s", "--every", every, "--csv", path("b.csv"),
                   "--summary", path("b.json")}),
              0)
        << error_;
    hashes.push_back(nlohmann::json::parse(text_of("b.json"))["state_hash"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(Simulate, WritesThePositionAndTheForceOfADevice) {
  const std::string launch = CORDIS_SOURCE_DIR "/launch_configs/bowed_string.yaml";
  ASSERT_EQ(run({launch, "--duration", "0.5s", "--every", "step", "--csv", path("b.csv")}), 0);
  const auto rows = table("b.csv");
  ASSERT_EQ(header_,
            "time [s],bow [m],under_bow [m],middle [m],bow_force [N],energy [J],hand.position[0] "
            "[m],hand.force[0] [N]");
  for (const auto& row : rows) {
    EXPECT_EQ(row[6], row[1]);
    EXPECT_EQ(row[7], row[4]);
  }
}

TEST_F(Simulate, WritesEventsToAFileOfTheirOwn) {
  const std::string launch = CORDIS_SOURCE_DIR "/launch_configs/ratchet.yaml";
  ASSERT_EQ(
      run({launch, "--duration", "4s", "--events", path("e.csv"), "--summary", path("e.json")}), 0);
  const std::string text = text_of("e.csv");
  EXPECT_TRUE(text.starts_with(
      "time [s],step,liaison,link,mat_a,mat_b,from,to,quantity,value,energy [J]\n"));
  const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n'));
  EXPECT_EQ(lines - 1, nlohmann::json::parse(text_of("e.json"))["events"]);
  EXPECT_GT(lines, 10u);
  EXPECT_THAT(text, HasSubstr(",ratchet,driver,pawl,rack,"));
}

TEST_F(Simulate, ASceneThatDivergesKeepsItsRowsAndSaysSo) {
  const std::string launch = put("d.yaml", test::filled(R"(cordis: 1
nodes:
  sim: {node: sim_node, scene: '<scene>', force: true}
)",
                                                        {{"scene", put("div.yaml", kDiverging)}}));
  EXPECT_EQ(run({launch, "--duration", "2s", "--csv", path("d.csv"), "--summary", path("d.json")}),
            kFailure);
  EXPECT_THAT(error_, HasSubstr("the scene diverged at step"));
  EXPECT_THAT(error_, HasSubstr("what came before is kept"));
  const auto rows = table("d.csv");
  EXPECT_GT(rows.size(), 10u);
  for (const auto& row : rows) EXPECT_TRUE(std::isfinite(row[1]));
  const auto json = nlohmann::json::parse(text_of("d.json"));
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["steps"], rows.size() + 1);
}

TEST_F(Simulate, RefusesBeforeItSimulates) {
  const std::string scene = put("fall.yaml", kFalling);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{scene, "--duration", "1s", "--csv", path("none/a.csv")}, "No such file or directory"},
      {{scene, "--duration", "1s", "--mat", "ston"}, "has no MATs 'ston'; did you mean 'stone'?"},
      {{scene, "--duration", "1s", "--mat", "stone[1]"}, "picks none of the MATs stone[0..0]"},
      {{scene}, "say how long: --duration 2s"},
      {{scene, "--duration", "1s", "force=true"},
       "'force=true' changes a launch file, and " + scene + " is a scene"},
      {{put("view.yaml", R"(cordis: 1
session: s
nodes: {view: {node: viz_node}}
)")},
       "view.yaml has no sim_node"},
      {{scene, "--duration", "1s", "--every", "often"}, "is none of step, tick"},
      {{scene, "--duration", "1s", "--every", "1us"}, "1us"},
      {{scene, "--duration", "1s", "--wav", path("a.wav")}, "add 'sound: true'"},
      {{scene, "--duration", "1s", "--npz", "-"}, "wants a file, not stdout"},
      {{scene, "--duration", "1s", "--csv", path("x"), "--npz", path("x")}, "name the same file"},
      {{scene, "--duration", "1s", "--csv", path("x"), "--save-state", path("x")},
       "--csv and --save-state name the same file"},
      {{scene, "--duration", "1s", "--events", path("./x"), "--wav", path("x")},
       "name the same file"},
      {{scene, "--duration", "1s", "--save-state", scene}, "--save-state would overwrite"},
      {{scene, "--duration", "1s", "--csv", scene}, "--csv would overwrite its own file"},
      {{put("other.yaml", kFalling), "--duration", "1s", "--csv", scene},
       "--csv would overwrite the YAML file"},
      {{scene, "--duration", "1s", "--csv", put("t.mcap", "")}, "--csv would overwrite the take"},
      {{scene, "--duration", "1s", "--npz", put("t.mcap.part", "")},
       "--npz would overwrite the take"},
      {{scene, "--duration", "1s", "--summary", put("t.json", "\x89MCAP0\r\n and more")},
       "--summary would overwrite the take"},
  };
  for (const auto& [words, sentence] : cases) {
    EXPECT_EQ(run(words), kBadInput) << sentence;
    EXPECT_THAT(error_, HasSubstr(sentence));
  }
  std::ofstream(path("old.csv")) << "as it was";
  for (const auto& [word, file] :
       {std::pair{"--wav", path("a.wav")}, std::pair{"--summary", path("none/a.json")},
        std::pair{"--mat", std::string("ston")}}) {
    EXPECT_EQ(run({scene, "--duration", "1s", "--csv", path("old.csv"), word, file}), kBadInput);
    EXPECT_EQ(text_of("old.csv"), "as it was") << word;
  }
  EXPECT_EQ(text_of("fall.yaml"), kFalling);
  EXPECT_EQ(text_of("t.json"), "\x89MCAP0\r\n and more");
}

TEST_F(Simulate, CtrlCEndsASceneThatSettlesForLong) {
  const std::string scene = put("sheet.yaml",
                                R"(cordis: 1
space: 2
step: {rate_hz: 4000}
world: {gravity_m_per_s2: [0, -9.81]}
matter:
  s: {kind: string, count: 5000, from_m: [0, 0], to_m: [1, 0], ends: fixed, mass_kg: 0.001,
      stiffness_n_per_m: 3000}
settle: {until_n: 1.0e-300, steps: 5000000}
)");
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGINT, SIG_DFL);
    _exit(run({scene, "--duration", "1s"}));
  }
  ASSERT_GT(child, 0);
  clockid_t clock{};
  timespec used{};
  ASSERT_EQ(clock_getcpuclockid(child, &clock), 0);
  int status = 0;
  while (used.tv_sec == 0 && used.tv_nsec < 300'000'000) {
    ASSERT_EQ(clock_gettime(clock, &used), 0);
    ASSERT_EQ(waitpid(child, &status, WNOHANG), 0) << "it ended before: " << status;
  }
  kill(child, SIGINT);
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
}

TEST_F(Simulate, AFullDiskEndsItWithASentence) {
  const std::string scene = put("fall.yaml", kFalling);
  EXPECT_EQ(run({scene, "--duration", "10s", "--csv", "/dev/full"}), kFailure);
  EXPECT_THAT(error_, HasSubstr("cannot write '/dev/full': No space left on device"));
}

TEST_F(Simulate, NumpyReadsTheSameNumbersAsTheCsvFileHas) {
  const std::string launch = CORDIS_SOURCE_DIR "/launch_configs/bowed_string.yaml";
  ASSERT_EQ(run({launch, "--duration", "0.5s", "--mat", "string", "--csv", path("n.csv"), "--npz",
                 path("n.npz")}),
            0);
  put("read.py", R"(import csv, sys, numpy, zipfile
assert zipfile.ZipFile(sys.argv[1]).testzip() is None
table = numpy.load(sys.argv[1])
rows = list(csv.reader(open(sys.argv[2])))
numbers = numpy.array(rows[1:], dtype=float)
headers = [f'{name} [{unit}]' if unit else str(name) for name, unit in zip(table['_columns'], table['_units'])]
assert headers == rows[0], headers
for i, name in enumerate(table['_columns']):
    assert table[name].dtype == numpy.float64
    assert (table[name] == numbers[:, i]).all(), name
print('read', numbers.shape)
)");
  const std::string command = "/usr/bin/python3 " + path("read.py") + " " + path("n.npz") + " " +
                              path("n.csv") + " > " + path("said") + " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << text_of("said");
  EXPECT_EQ(text_of("said"), "read (500, 50)\n");
}

}  // namespace
}  // namespace cordis::cli
