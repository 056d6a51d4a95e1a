// tests/gallery/verdict_test.cpp -- the step of every launch file is certain, but for a few.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// What nothing bounds, by launch file.
constexpr const char* kPassed =
    "a ball may be driven so deep into the surface that the normal flips";

const std::map<std::string, std::string> kNotCertain{
    // Grains fall from so high that their energy could press one through a thin wall.
    {"hourglass", kPassed},
    // A body could land with all its weight on one of its balls, at the edge of a stair or a pole.
    {"jelly_on_stairs", kPassed},
    {"thrown_balls", kPassed}};

class Verdict : public testing::TestWithParam<std::string> {};

TEST_P(Verdict, IsCertainOrHasTheReasonThatIsKnown) {
  const GallerySession session(GetParam() + ".yaml");
  const engine::NetworkDescription& network = session.scene().network;

  const plan::Stability stability = plan::stability_of(network, plan::liaison_graph(network));

  const auto known = kNotCertain.find(GetParam());
  if (known == kNotCertain.end()) {
    EXPECT_TRUE(stability.holds()) << (stability.uncertainty ? stability.uncertainty->why : "");
    EXPECT_FALSE(stability.uncertainty.has_value());
  } else {
    EXPECT_FALSE(stability.diverges());
    ASSERT_TRUE(stability.uncertainty.has_value());
    EXPECT_EQ(stability.uncertainty->why.find(known->second), 0U) << stability.uncertainty->why;
  }
}

INSTANTIATE_TEST_SUITE_P(LaunchFiles, Verdict, testing::ValuesIn(launch_files()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace cordis::test
