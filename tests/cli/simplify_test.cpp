#include "cli/simplify/simplify.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/check/scene_check.h"
#include "cli/exit_code.h"
#include "cli/verbs.h"
#include "tests/cli/captured_run.h"
#include "tests/reduction/scenes.h"

namespace cordis::cli {
namespace {

/// A chain of rings in a plane of 3-D, two springs with a MAT of mass 0 between any two rings, and
/// a damper beside each spring row.
std::string chain_text() {
  return "cordis: 1\nname: chain\nspace: 3\nstep: {rate_hz: 2000}\nreduce: all\n"
         "world: {gravity_m_per_s2: [0, -9.81, 0]}\n"
         "liaisons:\n"
         "  half: {kind: spring, stiffness_n_per_m: 400, rest_m: 0.04}\n"
         "  oil: {kind: damper, viscosity_n_s_per_m: 0.1}\n"
         "matter:\n"
         "  hook: {kind: fixed, at_m: [0, 0, 0]}\n"
         "  ring: {kind: mass, mass_kg: 0.05, at_m: [[0, -0.1, 0], [0, -0.2, 0], [0, -0.3, 0]]}\n"
         "  joint: {kind: mass, mass_kg: 0, at_m: [[0, -0.05, 0], [0, -0.15, 0], [0, -0.25, 0]]}\n"
         "ports:\n"
         "  hand: {device: d, axes: [0, 1], role: mass, coupling: direct, at_m: [0.1, -0.3, 0]}\n"
         "links:\n"
         "  - {liaison: half, between: [hook, \"joint[0]\"]}\n"
         "  - {liaison: half, between: [joint, ring]}\n"
         "  - {liaison: half, between: [\"ring[0..1]\", \"joint[1..2]\"]}\n"
         "  - {liaison: oil, between: [hook, \"ring[0]\"]}\n"
         "  - {liaison: oil, between: [\"ring[0..1]\", \"ring[1..2]\"]}\n"
         "  - {liaison: half, between: [hand, \"ring[2]\"], rest_m: 0.09}\n"
         "signals:\n"
         "  low: {of: \"ring[2]\", quantity: position, axis: y}\n"
         "  aside: {of: \"ring[2]\", quantity: position, axis: x}\n";
}

/// The same chain by hand: one spring of half the stiffness instead of two.
scene::Scene chain_by_hand() {
  std::string text = chain_text();
  const auto take_out = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  take_out("reduce: all\n", "");
  const std::size_t joint = text.find("  joint:");
  text.erase(joint, text.find('\n', joint) + 1 - joint);
  take_out("  - {liaison: half, between: [hook, \"joint[0]\"]}\n",
           "  - {liaison: half, stiffness_n_per_m: 200, rest_m: 0.08, between: [hook, "
           "\"ring[0]\"]}\n");
  take_out("  - {liaison: half, between: [joint, ring]}\n", "");
  take_out("  - {liaison: half, between: [\"ring[0..1]\", \"joint[1..2]\"]}\n",
           "  - {liaison: half, stiffness_n_per_m: 200, rest_m: 0.08, between: "
           "[\"ring[0..1]\", \"ring[1..2]\"]}\n");
  config::Problems problems;
  scene::Scene scene = scene::load_scene_text(text, "by hand", problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

TEST(Simplify, WritesASceneThatLoadsAgainAndMovesAsBefore) {
  config::Problems problems;
  const Simplified simplified =
      simplify_scene(scene::load_scene_text(chain_text(), "t", problems), problems);
  const scene::Scene again = scene::load_scene_text(simplified.text, "again", problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(again.space(), 2);
  EXPECT_EQ(again.network.mats.size(), 5u);   // hook, 3 rings, hand
  EXPECT_EQ(again.network.links.size(), 4u);  // the rows with their dampers, and to the hand
  EXPECT_NE(simplified.report.find("series: 3 MATs without mass"), std::string::npos);
  EXPECT_NE(simplified.report.find("parallel: 3 links"), std::string::npos);
  EXPECT_NE(simplified.report.find("dimension: 3-D computed as 2-D"), std::string::npos);
  const std::vector<double> by_hand = plan::signals_after(chain_by_hand(), 3000);
  const std::vector<double> moved = plan::signals_after(again, 3000);
  EXPECT_GT(std::abs(by_hand[1]), 0.005);
  for (std::size_t s = 0; s < moved.size(); ++s)
    EXPECT_NEAR(moved[s], by_hand[s], 1e-10);  // rounding
}

class SimplifyVerb : public testing::Test {
 protected:
  ~SimplifyVerb() override {
    std::remove(path_.c_str());
    std::remove(out_path_.c_str());
  }
  int run(const std::vector<std::string>& words) {
    CommandLine line("cordis", "", "1");
    add_simplify_verb(line);
    add_check_verb(line);
    return run_captured(line, words, out_, error_);
  }

  std::string path_ = testing::TempDir() + "simplify_test." + std::to_string(getpid()) + ".yaml";
  std::string out_path_ = path_ + ".out.yaml";
  std::string out_;
  std::string error_;
};

TEST_F(SimplifyVerb, WritesAFileAndCheckTellsTheReductionsOfASceneInBothForms) {
  std::ofstream(path_) << chain_text();

  EXPECT_EQ(run({"simplify", path_, "--out", out_path_}), kSuccess) << error_;
  EXPECT_NE(error_.find("series: 3 MATs"), std::string::npos) << error_;
  EXPECT_EQ(run({"check", out_path_}), kSuccess) << error_;
  EXPECT_NE(out_.find("reduced     nothing"), std::string::npos) << out_;
  EXPECT_EQ(run({"check", path_}), kSuccess) << error_;
  EXPECT_NE(out_.find("parallel: 3 links merged into another between the same MATs; exact"),
            std::string::npos)
      << out_;
  EXPECT_EQ(run({"check", path_, "--json", "-"}), kSuccess) << error_;
  const nlohmann::json reductions = nlohmann::json::parse(out_)["reductions"];
  ASSERT_EQ(reductions.size(), 3u);
  EXPECT_EQ(reductions[2]["name"], "series");
  EXPECT_EQ(reductions[2]["error_budget"], 0.0);
  EXPECT_EQ(reductions[2]["count"], 3);
}

TEST_F(SimplifyVerb, ABadSceneIsRefused) {
  std::ofstream(path_) << chain_text() << "  more: {of: joint, quantity: pieces, near_m: 0.1}\n";
  EXPECT_EQ(run({"simplify", path_}), kBadInput);
  EXPECT_NE(error_.find("the mass of joint must be > 0"), std::string::npos) << error_;
}

}  // namespace
}  // namespace cordis::cli
