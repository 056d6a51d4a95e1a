// tests/device/firefader_test.cpp -- the driver against an emulated FireFader on a pseudo-terminal.
#include "device_node/drivers/firefader.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/device/faders.h"
#include "tests/device/plug.h"
#include "tests/device/wired.h"

namespace cordis::device {
namespace {

using test::Faders;
using test::Plug;

AxisLayout two_faders() {
  AxisLayout layout;
  layout.count = 2;
  layout.lowest_m = -0.05;
  layout.highest_m = 0.05;
  layout.rate_hz = 500.0;
  return layout;
}

class FireFaderTest : public Wired {};

TEST_F(FireFaderTest, CarriesPositionsAndForcesBothWays) {
  Faders faders;
  faders.positions[0] = 0;
  faders.positions[1] = 254;
  faders.plug.into_serial_line(link());
  const auto driven = driver("firefader", port() + ", full_scale_n: 2", two_faders());
  driven->start(Role::kMass);

  AxisValues sensed{};
  ASSERT_TRUE(until(*driven, {1.0, -5.0}, [&](bool there) {
    return there && driven->read(sensed) && faders.forces[0] == 63 && faders.forces[1] == -126;
  }));
  EXPECT_NEAR(sensed[0], -0.05, 1e-12);
  EXPECT_NEAR(sensed[1], 0.05, 1e-12);
}

TEST_F(FireFaderTest, LivesThroughEveryHarmAndUnpluggingAtOneKilohertz) {
  AxisLayout layout = two_faders();
  layout.rate_hz = 1000.0;
  const auto driven = std::make_unique<FireFader>(wire_at(port()), patient(), layout, 2.0);
  driven->start(Role::kMass);
  EXPECT_FALSE(driven->write({}));  // nothing is there yet
  for (const int up : {64, 200, 127}) {
    Faders faders;
    faders.positions[0] = static_cast<std::uint8_t>(up);
    faders.positions[1] = static_cast<std::uint8_t>(254 - up);
    const double place = 0.1 * up / 254.0 - 0.05;
    // Without a checksum a damaged place is believed when a hand could be there: 10 m/s.
    constexpr double kBelieved = 0.01;

    const auto check = [place](const AxisValues& sensed) {
      EXPECT_NEAR(sensed[0], place, kBelieved + 1e-12);
      EXPECT_NEAR(sensed[1], -place, kBelieved + 1e-12);
    };
    live_through_harm(*driven, faders.plug, link(), {1.0, 1.0}, check,
                      [&] { return faders.forces[0] == 63; });
  }
}

TEST_F(FireFaderTest, TakesTheForceAwayBeforeItGivesUpADevice) {
  Faders faders;
  faders.plug.harm = [](int n) { return n < 200 ? Plug::Harm::kNone : Plug::Harm::kDropped; };
  faders.plug.into_serial_line(link());
  const auto driven =
      driver("firefader", port() + ", full_scale_n: 2", two_faders(), "retry_s: 60");
  driven->start(Role::kMass);
  ASSERT_TRUE(until(*driven, {1.0, 1.0}, [&](bool) { return faders.forces[0] == 63; }));

  ASSERT_TRUE(until(*driven, {1.0, 1.0}, [](bool there) { return !there; }));

  EXPECT_TRUE(test::eventually([&] { return faders.forces[0] == 0 && faders.forces[1] == 0; }))
      << "the board still receives, though it says nothing";
}

TEST_F(FireFaderTest, WaitsNoLongerForAnAnswerThatWasLost) {
  Faders faders;
  faders.plug.harm = [](int n) { return n == 20 ? Plug::Harm::kDropped : Plug::Harm::kNone; };
  faders.plug.into_serial_line(link());
  const auto driven = driver("firefader", port(), two_faders());
  auto& hardware = dynamic_cast<Hardware&>(*driven);
  driven->start(Role::kMass);

  ASSERT_TRUE(until(*driven, {}, [&](bool) { return hardware.late_count() > 0; }));
  // The next are in time again, sooner or later one after the other.
  std::uint64_t late = hardware.late_count();
  int in_time = 0;
  EXPECT_TRUE(until(*driven, {}, [&](bool) {
    in_time = hardware.late_count() == late ? in_time + 1 : 0;
    late = hardware.late_count();
    return in_time == 20;
  }));
}

}  // namespace
}  // namespace cordis::device
