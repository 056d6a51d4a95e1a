// tests/gallery/golden_test.cpp -- every launch file, step for step as ever, with its energy
// accounted for.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

constexpr std::uint64_t kSteps = 10'000;

std::vector<std::string> launch_files() {
  std::vector<std::string> names;
  const std::string folder = std::string(CORDIS_SOURCE_DIR) + "/launch_configs";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Reads "name: 0x..." lines, the part of YAML that tests/golden/gallery.yaml keeps to.
std::map<std::string, std::string> golden_hashes() {
  std::ifstream file(std::string(CORDIS_GOLDEN_DIR) + "/gallery.yaml");
  if (!file) throw std::runtime_error("tests/golden/gallery.yaml cannot be read");
  std::map<std::string, std::string> hashes;
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.empty() || line[0] == '#' || colon == std::string::npos) continue;
    hashes[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return hashes;
}

class Gallery : public testing::TestWithParam<std::string> {};

TEST_P(Gallery, PlaysAsEverAndAccountsForItsEnergy) {
  Stage stage(GetParam() + ".yaml");
  stage.play_until(kSteps * stage.world().network().step());

  std::ostringstream hash;
  hash << "0x" << std::hex << stage.world().state_hash();
  EXPECT_EQ(hash.str(), golden_hashes()[GetParam()]) << "the numbers of this scene have changed";
  EXPECT_LT(std::abs(stage.energy_residual()), 1.0e-9);
}

INSTANTIATE_TEST_SUITE_P(LaunchFiles, Gallery, testing::ValuesIn(launch_files()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace cordis::test
