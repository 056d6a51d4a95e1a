// tests/checked/checked_test.cpp -- preconditions outside the engine, compiled with their checks.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/table/column_summary.h"
#include "device_node/force_guard.h"
#include "node/period_grid.h"
#include "sim_node/plan/reduction/take_out.h"
#include "sim_node/plan/stability/program_enclosure.h"
#include "sim_node/run/tick_division.h"
#include "viz_node/frame_pace.h"
#include "viz_node/render/number_text.h"
#include "viz_node/render/surface_mats.h"
#include "viz_node/render/vectors.h"
#include "viz_node/web/flow_credit.h"

namespace cordis {
namespace {

struct Misuse {
  std::string condition;  // a part of what is printed
  std::function<void()> act;
};

/// A program of one instruction.
engine::Program program_of(engine::Operation operation, engine::Quantity quantity = {}) {
  engine::Program program;
  program.code = {{.operation = operation, .quantity = quantity}};
  return program;
}

/// Two MATs, joined by a link with states.
scene::Scene scene_of_two() {
  scene::Scene scene;
  scene.network.mats.resize(2);
  scene.network.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

/// One MAT and one surface.
msg::SceneDescription description_of(const std::vector<std::uint32_t>& surface_mat) {
  msg::SceneDescription description;
  description.mat_kind().resize(1);
  description.surfaces().resize(1);
  description.surface_mat() = surface_mat;
  return description;
}

TEST(CheckedDeathTest, EachMisuseIsNamedAndEndsTheProgram) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  viz::FlowCredit credit;
  credit.sent(7, 70, 0);
  device::ForceGuard guard(device::ForceGuardSettings{});
  guard.accept({});
  scene::Scene scene = scene_of_two();
  plan::LinkBox box;
  box.distance = box.speed = {0.0, 1.0};
  const engine::Program of_age = program_of(engine::Operation::kQuantity, engine::Quantity::kAge);
  const engine::Program without_end = program_of(engine::Operation::kAdd);

  const std::vector<Misuse> misuses = {
      {"length > 0",
       [] {
         viz::normalized({0.0, 0.0, 0.0});
       }},
      {"length > 0", [] { viz::round_length(0.0); }},
      {"isfinite", [] { viz::round_length(std::numeric_limits<double>::infinity()); }},
      {"rate_hz > 0", [] { const viz::FramePace pace(-1.0); }},
      {"may_send", [&] { credit.sent(7, 70, 0); }},
      {"count_ > 0", [] { cli::ColumnSummary().json("m"); }},
      {"gesture_rate_hz > 0", [] { const sim::TickDivision division(1000.0, 0.0); }},
      {"numerator >= denominator", [] { const sim::TickDivision division(999.0, 1000.0); }},
      {"rate_hz > 0", [] { const node::PeriodGrid grid(0.0, 0); }},
      {"mats.size", [&] { plan::take_out({true}, {}, scene); }},
      {"links.size",
       [&] {
         plan::take_out({false, false}, {true}, scene);
       }},
      {"gone_",
       [&] {
         plan::take_out({true, false}, {}, scene);
       }},
      {"is_well_formed", [&] { plan::steepest_slopes(without_end, box); }},
      {"is_known_to_laws", [&] { plan::steepest_slopes(of_age, box); }},
      {"is_well_formed", [&] { plan::has_step(without_end, box, box); }},
      {"is_known_to_laws", [&] { plan::has_step(of_age, box, box); }},
      {"surface_mat",
       [] {
         viz::mats_of_surfaces(description_of({0, 0}));
       }},
      {"surface_mat", [] { viz::mats_of_surfaces(description_of({1})); }},
      {"share <= 1", [&] { guard.tick(0.0, {}, 1.5); }},
  };
  for (const Misuse& misuse : misuses) {
    EXPECT_DEATH(misuse.act(), "this does not hold: .*" + misuse.condition) << misuse.condition;
  }
}

TEST(Checked, NoneIsHurtByProperUse) {
  EXPECT_EQ(viz::round_length(0.07), 0.05);
  EXPECT_EQ(viz::mats_of_surfaces(description_of({0})), std::vector<std::uint32_t>{0});
  scene::Scene scene = scene_of_two();
  plan::take_out({false, false}, {}, scene);
  EXPECT_EQ(scene.network.mats.size(), 2u);
  EXPECT_EQ(sim::TickDivision(44100.0, 1000.0).max_steps(), 45u);
  EXPECT_EQ(sim::TickDivision(1000.0 * (1.0 - 1e-15), 1000.0).max_steps(), 1u);
}

}  // namespace
}  // namespace cordis
