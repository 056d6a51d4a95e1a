// tests/gallery/ruler_test.cpp
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::uint32_t kSlipped = 2;
constexpr double kSlip = 0.3;         // [N]
constexpr double kRigidity = 0.05;    // E I [N m^2]
constexpr double kPerLength = 0.06;   // [kg/m]
constexpr double kFreeLength = 0.25;  // [m]
constexpr double kSpacing = 0.0125;   // [m]

TEST(Ruler, SlipsOffWhereTheForceOfABeamIsReached) {
  GallerySession session("ruler.yaml");
  std::size_t slips = 0;
  session.play_until(9.0, [&] {
    for (const engine::LinkEvent& event : session.events()) {
      if (event.to != kSlipped) continue;
      ++slips;
      // The last MAT has gone as far as F L^3 / 3 E I. The finger pulls it outwards too, by a fifth of that force.
      const double length = kFreeLength - 0.5 * kSpacing;
      const double way = kSlip * length * length * length / (3.0 * kRigidity);
      EXPECT_NEAR(session.signal("tip"), way, 0.07 * way);
    }
  });
  EXPECT_EQ(slips, 2u);
}

TEST(Ruler, TwangsAtTheNoteOfEulersBeam) {
  GallerySession session("ruler.yaml");
  session.play_until(1.5);
  double first = 0.0;
  double last = 0.0;
  int crossings = 0;
  double before = session.signal("tip");
  session.play_until(3.5, [&] {
    const double now = session.signal("tip");
    const double height = std::exchange(before, now);
    if (!(height < 0.0 && now >= 0.0)) return;
    last = static_cast<double>(session.world().step_count()) * session.world().network().step();
    if (crossings++ == 0) first = last;
  });

  ASSERT_GT(crossings, 10);
  constexpr double kRoot = 1.875104068711961;  // of cos(x) cosh(x) = -1
  const double wave = kRoot / kFreeLength;
  const double exact = wave * wave * std::sqrt(kRigidity / kPerLength) / (2.0 * std::numbers::pi);
  EXPECT_NEAR((crossings - 1) / (last - first), exact, 0.01 * exact);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
