// tests/cli/accuracy_test.cpp -- what the plan promises for `accuracy`, held against the reference integrator.
#include <cmath>

#include <gtest/gtest.h>

#include "cli/lab/lab_scene.h"
#include "sim_node/plan/rate_selection.h"
#include "sim_node/plan/reference/reference.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::cli {
namespace {

class Accuracy : public testing::TestWithParam<const char*> {};

TEST_P(Accuracy, IsKeptByThePlanAndByNothingAtHalfTheCost) {
  const LabScene lab = load_lab_scene(
      std::string(CORDIS_SOURCE_DIR) + "/launch_configs/lab/" + GetParam() + ".yaml", 0.0);
  const scene::Scene& scene = lab.scene;
  ASSERT_TRUE(scene.accuracy);
  const double tolerance = scene.accuracy->tolerance;
  const double period = 1.0 / scene.gesture_rate_hz;
  const plan::Reference reference = plan::make_reference(
      scene.network, lab.course,
      {{period, static_cast<int>(std::lround(lab.duration_s / period))}, 1e-10, 60.0, 0.0, {}});
  ASSERT_TRUE(reference.by_reference);
  ASSERT_EQ(reference.compared, reference.sampling.count);
  ASSERT_LT(reference.doubt, 0.02 * tolerance);
  const auto error = [&](const std::string& integrator, double rate_hz) {
    const plan::TrialResult run =
        plan::try_out(scene.network, integrator, rate_hz, lab.course, reference);
    return run.blown_up ? 1e9 : run.error;
  };

  const std::string chosen = to_string(scene.network.integrator);
  EXPECT_LE(error(chosen, scene.step_rate_hz), tolerance) << scene.step_rate_hz << " Hz";
  const double cost = scene.step_rate_hz * plan::cost_of_a_step(chosen);
  for (const std::string& integrator : plan::integrators_for(scene.network)) {
    const double half = 0.499 * cost / plan::cost_of_a_step(integrator);
    const double rate = std::floor(half / scene.gesture_rate_hz) * scene.gesture_rate_hz;
    if (rate > 0.0) {
      EXPECT_GT(error(integrator, rate), tolerance) << integrator << " at " << rate << " Hz";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(LabScenes, Accuracy,
                         testing::Values("soft", "stiff", "agglomerate", "bowed"),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace cordis::cli
