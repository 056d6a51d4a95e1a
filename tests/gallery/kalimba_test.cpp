// tests/gallery/kalimba_test.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::size_t kKeys = 16;
constexpr std::uint32_t kPassed = 2;  // state of a quill

TEST(Kalimba, EachKeyPlucksItsOwnTineAQuarterOfASecondAfterTheOneBefore) {
  constexpr double kRelease = 400.0 * 0.003;  // [N]
  GallerySession session("kalimba.yaml");
  std::array<std::vector<double>, kKeys> plucks;  // [s]
  double strongest = 0.0;
  double loudest = 0.0;
  session.play_until(4.6, [&] {
    for (const engine::LinkEvent& event : session.events()) {
      if (event.to == kPassed) plucks.at(event.link).push_back(session.time_s());
    }
    strongest = std::max(strongest, session.signal("first_force"));
    loudest = std::max(loudest, std::abs(session.signal("board")));
  });

  for (std::size_t key = 0; key < kKeys; ++key) {
    ASSERT_FALSE(plucks[key].empty()) << key;
    if (key == 0) continue;
    EXPECT_NEAR(plucks[key].front() - plucks[key - 1].front(), 0.25, 0.002) << key;  // 2 samples
  }
  EXPECT_NEAR(strongest, kRelease,
              0.05 * kRelease);  // of it a sample each millisecond shows so much
  EXPECT_GT(loudest, kRelease);
  EXPECT_LT(session.energy_residual(), 1e-9);
}

TEST(Kalimba, EveryTineSwingsAtItsNoteInTheSchemeItself) {
  constexpr std::array<int, kKeys> kSemitones{0,  2,  4,  5,  7,  9,  11, 12,
                                              14, 16, 17, 19, 21, 23, 24, 26};  // above C4
  constexpr double kMiddleC = 261.6255653;                                      // [Hz]
  GallerySession session("kalimba.yaml");
  const engine::NetworkDescription& network = session.scene().network;
  for (std::size_t tine = 0; tine < kKeys; ++tine) {
    // x(n+1) = 2 c x(n) - x(n-1) swings with cos(w dt) = c = 1 - K dt^2 / (2 m)
    const double mass = network.mats.at(network.links.at(tine).mat_b).mass;
    const double cosine =
        1.0 - network.links.at(tine).stiffness * network.step * network.step / (2.0 * mass);
    const double pitch = std::acos(cosine) / (2.0 * std::numbers::pi * network.step);
    const double note = kMiddleC * std::exp2(kSemitones.at(tine) / 12.0);
    EXPECT_NEAR(1200.0 * std::log2(pitch / note), 0.0, 0.01)
        << tine;  // cents; masses have 7 digits
  }
}

}  // namespace
}  // namespace cordis::test
