// tests/device/firefader_test.cpp -- the driver against an emulated FireFader on a pseudo-terminal.
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

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

TEST_F(FireFaderTest, LivesThroughEveryHarmAndUnpluggingAtOneKilohertz) {
  AxisLayout layout = two_faders();
  layout.rate_hz = 1000.0;
  const auto driven = driver("firefader", port() + ", full_scale_n: 2", layout);
  driven->start(Role::kMass);
  EXPECT_FALSE(driven->write({}));  // nothing is there yet
  for (const int up : {64, 200, 127}) {
    Faders faders;
    faders.positions[0] = static_cast<std::uint8_t>(up);
    faders.positions[1] = static_cast<std::uint8_t>(254 - up);
    const double place = 0.1 * up / 254.0 - 0.05;
    // Without a checksum a damaged place is believed when a hand could be there: 10 m/s.
    constexpr double kBelieved = 0.01;

    live_through_harm(*driven, faders.plug, link(), {1.0, 1.0}, [place](const AxisValues& sensed) {
      EXPECT_NEAR(sensed[0], place, kBelieved + 1e-12);
      EXPECT_NEAR(sensed[1], -place, kBelieved + 1e-12);
    });

    EXPECT_EQ(faders.forces[0], 63);
  }
}

TEST_F(FireFaderTest, LetsGoOfItsMotorsWhenASceneInLockstepIsSilent) {
  Faders faders;
  faders.plug.into_serial_line(link());
  const auto driven = driver("firefader", port() + ", full_scale_n: 2", two_faders());
  driven->start(Role::kMass);
  ASSERT_TRUE(until(*driven, {1.0, 1.0}, [&](bool) { return faders.forces[0] == 63; }));

  ASSERT_TRUE(driven->has_motors());
  driven->let_go();

  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (faders.forces[0] != 0 && std::chrono::steady_clock::now() < limit) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(faders.forces[0], 0);
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
