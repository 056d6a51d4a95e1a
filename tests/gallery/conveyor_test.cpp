// tests/gallery/conveyor_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kMass = 0.2;
constexpr double kPace = 0.2;
constexpr double kRub = 0.25 * kMass * 9.81;  // kinetic friction of a case [N]

TEST(Conveyor, BringsEachCaseToItsPaceAndLosesAsMuchAsItGives) {
  GallerySession session("conveyor.yaml");
  session.play_until(0.3);
  // A case that is at rest falls back by v^2 / (2 mu g) before it goes along.
  const double start = -0.02;
  const double behind = start + kPace * 0.3 - session.signal("first_x");
  EXPECT_NEAR(behind, 0.5 * kMass * kPace * kPace / kRub, 0.3e-3);
  const double kinetic = 3.0 * 0.5 * kMass * kPace * kPace;
  EXPECT_NEAR(session.signal("kinetic_energy"), kinetic, 1e-3 * kinetic);
  EXPECT_NEAR(session.signal("dissipated_energy"), kinetic, 0.01 * kinetic);
  EXPECT_NEAR(session.signal("port_work"), 2.0 * kinetic, 0.01 * 2.0 * kinetic);
}

TEST(Conveyor, PressesTheHandByTheFrictionOfEachCaseThatWaits) {
  GallerySession session("conveyor.yaml");
  session.play_until(0.5);
  EXPECT_EQ(session.signal("gate_force"), 0.0) << "the first one has not come yet";
  session.play_until(2.5);
  double force = 0.0;
  int count = 0;
  session.play_until(4.0, [&] { force += session.signal("gate_force"), ++count; });
  EXPECT_NEAR(force / count, 3.0 * kRub, 0.01 * 3.0 * kRub) << "what the hand feels";

  session.play_until(8.0);
  EXPECT_EQ(session.signal("gate_force"), 0.0);
  EXPECT_NEAR(session.signal("end_force"), 3.0 * kRub, 1e-3 * kRub);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
