// tests/cli/lab_test.cpp
#include "cli/lab/lab.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/lab/lab_chart.h"
#include "cli/lab/lab_report.h"
#include "sim_node/checks/planned_scene.h"
#include "sim_node/checks/start_state.h"
#include "sim_node/run/simulation.h"

namespace cordis::cli {
namespace {

/// A mass of 0.1 kg on a spring of 1000 N/m without viscosity: w = 100 / s, limit at 50 Hz.
class Lab : public testing::Test {
 protected:
  Lab() {
    std::filesystem::remove_all(options_.folder);
    write("");
  }
  ~Lab() override {
    std::filesystem::remove_all(options_.folder);
    std::filesystem::remove(options_.file);
  }
  void write(const std::string& more) {
    std::ofstream(options_.file) << R"(cordis: 1
name: bob
space: 1
step: {rate_hz: 1000}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: [0.1]}
liaisons:
  holder: {kind: spring, stiffness_n_per_m: 1000, rest_m: 0}
links:
  - {liaison: holder, between: [ground, bob]}
)" << more;
  }
  LabReport run() {
    return run_lab(options_, [](const std::string&) {});
  }
  std::string read(const char* name) {
    std::ifstream file(std::filesystem::path(options_.folder) / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const std::string place_ = testing::TempDir() + "lab_test." + std::to_string(getpid());
  LabOptions options_{place_ + ".yaml", place_, 2.0, 2, true, false};
};

TEST_F(Lab, RefusesASceneThatStartsFromASavedState) {
  config::Problems problems;
  const auto bob =
      std::make_shared<const scene::Scene>(sim::plan_scene(options_.file, {}, problems).scene);
  const std::string state = place_ + ".state";
  std::ofstream(state) << sim::state_file_text(*bob, sim::Simulation(bob, 1).world().snapshot());
  write("start_state: " + state + "\n");
  std::string refusal;
  try {
    run();
  } catch (const config::ConfigError& error) {
    refusal = error.what();
  }
  EXPECT_NE(
      refusal.find("a lab begins with the start that a scene describes: leave out 'start_state'"),
      std::string::npos)
      << refusal;
  std::filesystem::remove(state);
}

TEST_F(Lab, TheErrorIsThatOfThePhase) {
  // x = 0.1 cos(w t); the scheme has exactly 0.1 cos(W t) with W = (2 / h) asin(w h / 2).
  const LabReport report = run();
  EXPECT_TRUE(report.reference.by_reference);
  EXPECT_LT(report.reference.uncertainty, 1e-7);
  const plan::Sampling& sampling = report.reference.sampling;
  double mean = 0.0;
  double square = 0.0;
  int resolving = 0;
  for (int i = 0; i < sampling.count(); ++i) {
    if (sampling.groups_hz[static_cast<std::size_t>(i)] < sampling.resolving_hz) continue;
    const double x = std::cos(100.0 * sampling.time(i));
    mean += x;
    square += x * x;
    ++resolving;
  }
  const double amplitude = std::sqrt(square / resolving - std::pow(mean / resolving, 2));
  EXPECT_NEAR(report.reference.amplitude, 0.1 * amplitude, 1e-9);
  int compared = 0;
  for (const LabRun& run : report.runs) {
    if (run.result.integrator != "cordis" || run.result.blown_up) continue;
    const double h = 1.0 / run.result.rate_hz;
    double off = 0.0;
    int samples = 0;
    for (int i = 0; i < sampling.count(); ++i) {
      const double t = sampling.time(i);
      if (!sampling.is_for(i, run.result.rate_hz, sampling.group_of(run.result.rate_hz))) continue;
      ++samples;
      off += std::pow(std::cos(2.0 / h * std::asin(50.0 * h) * t) - std::cos(100.0 * t), 2);
    }
    EXPECT_NEAR(run.result.error, std::sqrt(off / samples) / amplitude, 1e-6) << run.result.rate_hz;
    ++compared;
  }
  EXPECT_GE(compared, 5);
}

/// The error of `cordis` at a rate, over all of its steps, where x = cos(w t).
double error_over_all_steps(double frequency_hz, double rate_hz, double duration_s) {
  const double w = 2.0 * M_PI * frequency_hz;
  const double own = 2.0 * rate_hz * std::asin(0.5 * w / rate_hz);
  double off = 0.0;
  double motion = 0.0;
  for (long step = 1; step <= std::lround(duration_s * rate_hz); ++step) {
    const double t = static_cast<double>(step) / rate_hz;
    off += std::pow(std::cos(own * t) - std::cos(w * t), 2);
    motion += std::pow(std::cos(w * t), 2);
  }
  return std::sqrt(off / motion);
}

TEST_F(Lab, SeesWhatVibratesInTimeWithItsRates) {
  for (const double frequency : {100.0, 150.0, 200.0, 400.0}) {
    const double w = 2.0 * M_PI * frequency;
    std::ofstream(options_.file) << R"(cordis: 1
space: 1
step: {rate_hz: 48000}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 1, at_m: [0.01]}
links: [{liaison: holder, between: [ground, bob]}]
liaisons: {holder: {kind: spring, rest_m: 0, stiffness_n_per_m: )"
                                 << w * w << "}}\n";
    options_.duration_s = 1.0;
    const LabReport report = run();
    EXPECT_NEAR(report.reference.amplitude, 0.01 / std::sqrt(2.0), 0.0005) << frequency;
    int compared = 0;
    for (const LabRun& run : report.runs) {
      if (run.result.integrator != "cordis" || run.result.rate_hz < 1.001 * M_PI * frequency)
        continue;
      const double expected = error_over_all_steps(frequency, run.result.rate_hz, 1.0);
      EXPECT_NEAR(run.result.error, expected, 0.2 * expected)
          << frequency << " Hz at " << run.result.rate_hz;
      ++compared;
    }
    EXPECT_GE(compared, 4);
  }
}

TEST_F(Lab, WhatIsBelowTheLimitBlowsUp) {
  int blown_up = 0;
  for (const LabRun& run : run().runs) {
    if (run.result.integrator != "cordis") continue;
    EXPECT_EQ(run.result.blown_up, run.result.rate_hz < 50) << run.result.rate_hz;
    blown_up += run.result.blown_up ? 1 : 0;
  }
  EXPECT_GE(blown_up, 1);
}

TEST_F(Lab, GoesOnWhereItWasAndBeginsAnewForAnotherScene) {
  const LabReport first = run();
  EXPECT_EQ(first.kept_runs, 0);
  const LabReport again = run();
  EXPECT_EQ(again.kept_runs, static_cast<int>(first.runs.size()));
  EXPECT_NE(text_of(again).find("kept from an earlier lab"), std::string::npos);
  write("world: {viscosity_n_s_per_m: 0.1}\n");
  EXPECT_EQ(run().kept_runs, 0);
}

TEST_F(Lab, BeginsAnewForAnotherExpression) {
  const auto write_law = [this](const std::string& elasticity) {
    write("");
    std::ifstream in(options_.file);
    std::string text(std::istreambuf_iterator<char>(in), {});
    const std::string spring = "{kind: spring, stiffness_n_per_m: 1000, rest_m: 0}";
    text.replace(text.find(spring), spring.size(), "{elasticity: '" + elasticity + "', rest_m: 0}");
    std::ofstream(options_.file) << text;
  };
  write_law("1000 * elongation_m + 10 * elongation_m^3");
  const LabReport first = run();
  EXPECT_GT(first.runs.size(), 5u);
  EXPECT_EQ(run().kept_runs, static_cast<int>(first.runs.size()));
  write_law("1000 * elongation_m + 20 * elongation_m^3");
  EXPECT_EQ(run().kept_runs, 0);
  write_law("1000 * elongation_m + 20 * elongation_m^5");
  EXPECT_EQ(run().kept_runs, 0);
}

TEST_F(Lab, WritesATableAndAScriptForItsChart) {
  const LabReport report = run();
  draw_chart(report, options_.folder);
  const std::string csv = read("lab.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
            report.runs.size() + 1);
  const std::string script = read("chart.gp");
  EXPECT_NE(script.find("limit of cordis"), std::string::npos);
  EXPECT_NE(script.find("bob (2 MATs, 1 link, 0 sets, 1-D), 2 s; "), std::string::npos);
  EXPECT_NE(text_of(report).find("blew up"), std::string::npos);
}

TEST_F(Lab, TheNameOfASceneIsTextForGnuplot) {
  const std::string victim = place_ + ".made";
  std::ifstream in(options_.file);
  std::string text(std::istreambuf_iterator<char>(in), {});
  text.replace(text.find("name: bob"), 9, "name: \"bo'b `touch " + victim + "` \\\\\"");
  std::ofstream(options_.file) << text;

  draw_chart(run(), options_.folder);

  EXPECT_NE(read("chart.gp").find("'bo''b `touch " + victim + "` \\ (2 MATs"), std::string::npos)
      << read("chart.gp");
  EXPECT_FALSE(std::filesystem::exists(victim)) << "a shell was run";
}

TEST_F(Lab, NoNameCoversAnotherBesideTheCurves) {
  draw_chart(run(), options_.folder);
  const std::string script = read("chart.gp");
  const std::regex label("set label '([^']+)' at graph 1.03, graph ([0-9.]+) ");
  std::map<std::string, double> heights;
  for (auto found = std::sregex_iterator(script.begin(), script.end(), label);
       found != std::sregex_iterator(); ++found)
    heights[(*found)[1]] = std::stod((*found)[2]);
  ASSERT_GE(heights.size(), 4u) << script;
  std::vector<double> sorted;
  for (const auto& [name, height] : heights) sorted.push_back(height);
  std::sort(sorted.begin(), sorted.end());
  EXPECT_GE(sorted.front(), 0.0);
  EXPECT_LE(sorted.back(), 1.0);
  for (std::size_t i = 1; i < sorted.size(); ++i) EXPECT_GT(sorted[i] - sorted[i - 1], 0.05);
}

TEST_F(Lab, AFolderThatCannotBeMadeIsNamed) {
  LabOptions options = options_;
  options.folder = options.file + "/lab";
  try {
    run_lab(options, [](const std::string&) {});
    FAIL() << "a file was taken for a folder";
  } catch (const std::runtime_error& refusal) {
    EXPECT_EQ(refusal.what(), "cannot make the folder '" + options.folder + "': Not a directory");
  }
}

TEST_F(Lab, ASceneThatOnlyADeviceMovesIsRefusedWithWhatItNeeds) {
  std::ofstream(options_.file) << R"(cordis: 1
space: 1
step: {rate_hz: 1000}
matter: {bob: {kind: mass, mass_kg: 0.1, at_m: 0}}
ports: {key: {device: keyboard, axes: [0], role: mass, coupling: direct}}
liaisons: {holder: {kind: spring, stiffness_n_per_m: 1000}}
links: [{liaison: holder, between: [key, bob]}]
)";
  try {
    run();
    FAIL() << "nothing moves";
  } catch (const std::runtime_error& refusal) {
    EXPECT_STREQ(refusal.what(),
                 "nothing moves; key rests: give the launch file to have it played");
  }
}

}  // namespace
}  // namespace cordis::cli
