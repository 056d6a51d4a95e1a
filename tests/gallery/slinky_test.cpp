// tests/gallery/slinky_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// A slinky with joints of a hundredth of a ring's mass, computed as it is written.
ChangedScene written_out() {
  return {"slinky", {{"mass_kg: 0,", "mass_kg: 8.0e-5,"}, {"reduce: all", "reduce: none"}}};
}

double largest_step(const GallerySession& session) {
  return plan::plan_of(session.scene().network, 100.0).stability.certified.step;
}

TEST(Slinky, IsComputedAsNoMoreThanItNeeds) {
  const GallerySession session("slinky.yaml");
  EXPECT_EQ(session.scene().space(), 1);
  EXPECT_EQ(session.world().network().description().mats.size(), 31u);
  EXPECT_EQ(session.world().network().description().links.size(), 30u);

  const ChangedScene changed = written_out();
  const GallerySession whole("slinky.yaml", changed.overrides());
  EXPECT_EQ(whole.scene().space(), 3);
  EXPECT_EQ(whole.world().network().description().mats.size(), 61u);
  EXPECT_EQ(whole.world().network().description().links.size(), 90u);
  EXPECT_GT(largest_step(session), 9.0 * largest_step(whole));
}

TEST(Slinky, SwingsAsItDoesWithLightJoints) {
  const ChangedScene changed = written_out();
  GallerySession session("slinky.yaml");
  GallerySession whole("slinky.yaml", changed.overrides());
  double difference = 0.0;
  double lowest = 0.0;
  double highest = -1.0;
  session.play_until(1.5, [&] {
    whole.play_until(session.time_s());
    const double y = session.signal("lowest_y");
    difference = std::max(difference, std::abs(whole.signal("lowest_y") - y));
    lowest = std::min(lowest, y);
    highest = std::max(highest, y);
  });
  EXPECT_GT(highest - lowest, 0.4);
  EXPECT_LT(difference, 0.06 * (highest - lowest));  // the joints weigh a hundredth
}

}  // namespace
}  // namespace cordis::test
