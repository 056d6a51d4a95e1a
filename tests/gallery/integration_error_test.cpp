// tests/gallery/integration_error_test.cpp -- the steps of every launch file make and take next to
// nothing: none warns in 6 s.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

std::vector<std::string> launch_files() {
  std::vector<std::string> names;
  const std::string folder = std::string(CORDIS_SOURCE_DIR) + "/launch_configs";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class IntegrationError : public testing::TestWithParam<std::string> {};

TEST_P(IntegrationError, IsBelowAHundredthOfTheLargestEnergy) {
  Stage stage(GetParam() + ".yaml");
  double worst = 0.0;
  for (int half_seconds = 1; half_seconds <= 12; ++half_seconds) {
    stage.play_until(0.5 * half_seconds);
    const engine::Energy energy = stage.world().energy();
    if (energy.largest > 0.0)
      worst = std::max(worst, std::abs(energy.integration_error()) / energy.largest);
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 0.01);
}

INSTANTIATE_TEST_SUITE_P(LaunchFiles, IntegrationError, testing::ValuesIn(launch_files()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace cordis::test
