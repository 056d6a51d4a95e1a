// tests/gallery/plucked_by_plectrum_test.cpp
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::uint32_t kPushing = 1;  // states of the quill
constexpr std::uint32_t kPlectrumPassed = 2;
constexpr double kQuillStiffness = 800.0;
constexpr double kRelease = 0.003;

constexpr double kMass = 0.02;
constexpr double kStringStiffness = 1100.0;
constexpr double kLinkViscosity = 0.02;
constexpr double kAirViscosity = 0.02;
constexpr std::uint32_t kStringLinks = 39;
constexpr double kStep = 1.0 / 4000.0;

/// One mode of the string: its amplitude and the change of it per second.
struct Mode {
  double amplitude = 0.0;
  double speed = 0.0;
};

struct Swing {
  double amplitude = 0.0;
  double envelope = 0.0;
};

double shape(int mode, std::uint32_t mat) {
  return std::sin(std::numbers::pi * mode * mat / kStringLinks);
}

Mode mode_of(const GallerySession& session, int number) {
  Mode mode;
  for (std::uint32_t i = 1; i < kStringLinks; ++i) {
    mode.amplitude += 2.0 / kStringLinks * shape(number, i) * session.position("string", i).x();
    mode.speed += 2.0 / kStringLinks * shape(number, i) * session.velocity("string", i).x();
  }
  return mode;
}

/// Follows q'' + 2 s q' + w^2 q = 0, with K and Z of the mode those of a link times
/// 4 sin^2(pi j / 2 (n + 1)), and Z of the medium besides.
Swing after(Mode mode, int number, double time_s) {
  const double sine = std::sin(0.5 * std::numbers::pi * number / kStringLinks);
  const double w2 = 4.0 * sine * sine * kStringStiffness / kMass;
  const double s = 0.5 * (kAirViscosity + 4.0 * sine * sine * kLinkViscosity) / kMass;
  const double w = std::sqrt(w2 - s * s);
  // the velocity of a world is that in the middle of the last step
  mode.speed += 0.5 * kStep * (-w2 * mode.amplitude - 2.0 * s * mode.speed);
  const double b = (mode.speed + s * mode.amplitude) / w;
  const double decay = std::exp(-s * time_s);
  return {decay * (mode.amplitude * std::cos(w * time_s) + b * std::sin(w * time_s)),
          decay * std::hypot(mode.amplitude, b)};
}

TEST(PluckedByPlectrum, LetsGoAtTheForceOfTheQuillOnceAStroke) {
  GallerySession session("plucked_by_plectrum.yaml");
  std::size_t released = 0;
  session.play_until(15.0, [&] {
    for (const engine::LinkEvent& event : session.events()) {
      if (event.from != kPushing || event.to != kPlectrumPassed) continue;
      ++released;
      EXPECT_GE(-event.value, kRelease);
      EXPECT_LT(-event.value, 1.01 * kRelease);  // the way of one step beyond
      const double stored = 0.5 * kQuillStiffness * kRelease * kRelease;
      EXPECT_NEAR(-event.energy, stored, 0.02 * stored);
    }
  });
  EXPECT_EQ(released, 3u);
}

TEST(PluckedByPlectrum, LeavesTheStringToItsOwnNotes) {
  GallerySession session("plucked_by_plectrum.yaml");
  session.play_until(1.2);  // the plectrum has passed
  const std::vector<int> numbers = {1, 2};
  std::vector<Mode> plucked;
  for (const int number : numbers) plucked.push_back(mode_of(session, number));
  EXPECT_LT(std::abs(mode_of(session, 3).amplitude), 0.02 * std::abs(plucked[0].amplitude));

  // Six swings later. Damping makes every mode of this scheme sharp by Z dt / (4 m): by 0.3 % of a
  // swing in that time, the second mode by twice that.
  session.play_until(3.2);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Swing expected = after(plucked[i], numbers[i], 2.0);
    EXPECT_NEAR(mode_of(session, numbers[i]).amplitude, expected.amplitude,
                0.006 * expected.envelope)
        << "mode " << numbers[i];
  }
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
