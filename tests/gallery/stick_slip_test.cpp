// tests/gallery/stick_slip_test.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

double number(const nlohmann::json& value) {
  return std::stod(value.get<std::string>());
}

/// What one block does: when it begins to slip, and how far its spring is stretched since it first did.
struct Slips {
  std::vector<double> began;
  std::vector<double> lasted;
  double longest = -1.0;
  double shortest = 1.0;
  bool slips = false;

  void see(double time, double speed, double stretch) {
    constexpr double kSlow = 0.005;  // [m/s], of the 0.1 of the hand
    const bool now = speed > kSlow;
    if (now && !slips) began.push_back(time);
    if (!now && slips) lasted.push_back(time - began.back());
    slips = now;
    if (began.empty()) return;
    longest = std::max(longest, stretch);
    shortest = std::min(shortest, stretch);
  }
};

TEST(StickSlip, GoesByTheClosedFormWithTwoCoefficientsAndWithTwoStates) {
  const nlohmann::json data = reference("R15_stick_slip_coulomb");
  const double period = number(data["period"]);
  GallerySession session("stick_slip.yaml");
  const std::array<std::string, 2> names{"first", "second"};
  std::array<Slips, 2> blocks;
  session.play_until(4.85, [&] {
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      blocks[i].see(session.time_s(), session.signal(names[i] + "_speed"),
                    session.signal(names[i] + "_stretch"));
    }
  });
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Slips& block = blocks[i];
    ASSERT_GE(block.began.size(), 5u) << names[i];
    for (std::size_t n = 2; n < block.began.size(); ++n)
      EXPECT_NEAR(block.began[n] - block.began[n - 1], period, 0.005 * period) << names[i];
    for (std::size_t n = 1; n < block.lasted.size(); ++n)
      EXPECT_NEAR(block.lasted[n], number(data["t_slip"]), 0.02 * period) << names[i];
    EXPECT_NEAR(block.longest, number(data["x_max"]), 1e-4) << names[i];
    EXPECT_NEAR(block.shortest, number(data["x_min"]), 1e-4) << names[i];
  }
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
