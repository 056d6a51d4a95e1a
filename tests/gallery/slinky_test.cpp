#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

/// The same slinky with joints of a hundredth of a ring's mass, computed as it is written.
ChangedScene written_out() {
  return {"slinky", {{"mass_kg: 0,", "mass_kg: 8.0e-5,"}, {"reduce: all", "reduce: none"}}};
}

double largest_step(const Stage& stage) {
  return plan::plan_of(stage.scene().network, 100.0).stability.certified.step;
}

TEST(Slinky, IsComputedAsNoMoreThanItNeeds) {
  const Stage stage("slinky.yaml");
  EXPECT_EQ(stage.scene().space(), 1);
  EXPECT_EQ(stage.world().network().description().mats.size(), 31u);
  EXPECT_EQ(stage.world().network().description().links.size(), 30u);

  const ChangedScene changed = written_out();
  const Stage whole("slinky.yaml", changed.overrides());
  EXPECT_EQ(whole.scene().space(), 3);
  EXPECT_EQ(whole.world().network().description().mats.size(), 61u);
  EXPECT_EQ(whole.world().network().description().links.size(), 90u);
  EXPECT_GT(largest_step(stage), 9.0 * largest_step(whole));
}

TEST(Slinky, SwingsAsItDoesWithLightJoints) {
  const ChangedScene changed = written_out();
  Stage stage("slinky.yaml");
  Stage whole("slinky.yaml", changed.overrides());
  double difference = 0.0;
  double lowest = 0.0;
  double highest = -1.0;
  stage.play_until(1.5, [&] {
    whole.play_until(stage.time_s());
    const double y = stage.signal("lowest_y");
    difference = std::max(difference, std::abs(whole.signal("lowest_y") - y));
    lowest = std::min(lowest, y);
    highest = std::max(highest, y);
  });
  EXPECT_GT(highest - lowest, 0.4);
  EXPECT_LT(difference, 0.06 * (highest - lowest));  // the joints weigh a hundredth
}

}  // namespace
}  // namespace cordis::test
