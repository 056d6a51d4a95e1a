// tests/gallery/integration_error_test.cpp -- the steps of every launch file make and take next to
// nothing, and stay within what is certified: none warns in 6 s.
#include <string>

#include <gtest/gtest.h>

#include "sim_node/run/shadow_world.h"
#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

class IntegrationError : public testing::TestWithParam<std::string> {};

TEST_P(IntegrationError, IsBelowAHundredthOfTheLargestEnergy) {
  GallerySession session(GetParam() + ".yaml");
  for (int half_seconds = 1; half_seconds <= 12; ++half_seconds) {
    session.play_until(0.5 * half_seconds);
    const engine::Energy energy = session.world().energy();
    EXPECT_FALSE(sim::is_error_large(energy))
        << energy.integration_error() << " of " << energy.largest << " J";
    EXPECT_EQ(session.bound_text(), "");
  }
}

INSTANTIATE_TEST_SUITE_P(LaunchFiles, IntegrationError, testing::ValuesIn(launch_files()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace cordis::test
