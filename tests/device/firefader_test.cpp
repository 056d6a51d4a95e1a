// tests/device/firefader_test.cpp -- the driver against an emulated FireFader on a pseudo-terminal.
#include <array>
#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/device/plug.h"
#include "tests/device/wired.h"

namespace cordis::device {
namespace {

using test::Plug;

/// Answers each request as the faders' firmware does.
class Faders {
 public:
  Faders() : plug([this](std::uint8_t byte) { hear(byte); }, [] {}) {}

  std::array<std::atomic<int>, 2> forces{};              // -126..126
  std::array<std::atomic<std::uint8_t>, 2> positions{};  // 0..254

 private:
  void hear(std::uint8_t byte) {
    if (byte == 127) {
      count_ = 0;
      return;
    }
    if (count_ >= 2) return;
    forces[count_++] = static_cast<std::int8_t>(byte);
    if (count_ < 2) return;
    const std::uint8_t answer[] = {255, positions[0], positions[1], 0, 0, 1, 1};
    plug.say(answer);
  }
  std::size_t count_ = 2;

 public:
  Plug plug;  // last: its thread uses the rest
};

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

TEST_F(FireFaderTest, GoesOnAfterDamagedDroppedAndLateAnswers) {
  Faders faders;
  faders.plug.harm = [](int n) {
    if (n % 10 == 4) return Plug::Harm::kDropped;
    if (n % 10 == 7) return Plug::Harm::kLate;
    return Plug::Harm::kNone;
  };
  faders.positions[0] = 127;
  faders.positions[1] = 127;
  faders.plug.into_serial_line(link());
  const auto driven = driver("firefader", port(), two_faders());
  auto& hardware = dynamic_cast<Hardware&>(*driven);
  driven->start(Role::kMass);
  ASSERT_TRUE(until(*driven, {}, [](bool there) { return there; }));

  AxisValues sensed{};
  int present = 0;
  for (int n = 0; n < 1000; ++n) {
    present += driven->write({0.5, 0.5});
    ASSERT_TRUE(driven->read(sensed));
    ASSERT_NEAR(sensed[0], 0.0, 1e-9);
  }
  EXPECT_EQ(present, 1000);
  EXPECT_GT(hardware.late_count(), 50u);
}

TEST_F(FireFaderTest, IsLostWhenUnpluggedAndRecoversWhenPluggedInAgain) {
  const auto driven = driver("firefader", port(), two_faders());
  driven->start(Role::kMass);
  for (int time = 0; time < 3; ++time) {
    Faders faders;
    faders.plug.into_serial_line(link());
    ASSERT_TRUE(
        until(*driven, {2.0, 2.0}, [&](bool there) { return there && faders.forces[0] > 0; }));
    faders.plug.pull();
    ASSERT_TRUE(until(*driven, {2.0, 2.0}, [](bool there) { return !there; }));
  }
}

}  // namespace
}  // namespace cordis::device
