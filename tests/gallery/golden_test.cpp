// tests/gallery/golden_test.cpp -- every launch file, step for step as ever, with its energy
// accounted for.

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"
#include "tests/support/golden_hashes.h"

namespace cordis::test {
namespace {

constexpr std::uint64_t kSteps = 10'000;

class Gallery : public testing::TestWithParam<std::string> {};

TEST_P(Gallery, PlaysAsEverAndAccountsForItsEnergy) {
  GallerySession session(GetParam() + ".yaml");
  session.play_until(kSteps * session.world().network().step());

  EXPECT_EQ(hexadecimal(session.world().state_hash()), golden_hashes("gallery.yaml")[GetParam()])
      << "the numbers of this scene have changed";
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

INSTANTIATE_TEST_SUITE_P(LaunchFiles, Gallery, testing::ValuesIn(launch_files()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace cordis::test
