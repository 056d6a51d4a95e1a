// tests/gallery/piano_string_test.cpp
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kRate = 44'100.0;
constexpr int kIntervals = 60;

/// How loud a frequency is in a sound, through a window of Hann.
double loudness(const std::vector<double>& sound, double hz) {
  const auto turn = std::polar(1.0, -2.0 * std::numbers::pi * hz / kRate);
  std::complex<double> phase = 1.0;
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < sound.size(); ++i, phase *= turn) {
    const double x = static_cast<double>(i) / static_cast<double>(sound.size());
    sum += sound[i] * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * x)) * phase;
  }
  return std::abs(sum);
}

/// The loudest frequency within 6 Hz of another one, to 0.05 Hz.
double loudest_near(const std::vector<double>& sound, double hz) {
  double found = hz - 6.0;
  for (double step : {0.5, 0.05}) {
    const double middle = step == 0.5 ? hz : found;
    const double reach = step == 0.5 ? 6.0 : 0.5;
    double best = 0.0;
    for (double some = middle - reach; some <= middle + reach; some += step) {
      const double now = loudness(sound, some);
      if (now > best) found = some;
      best = std::max(best, now);
    }
  }
  return found;
}

/// A partial of masses on a stiff string between two hinges, as the scheme computes it. The masses
/// swing as sin(n pi j / N): m w^2 = 4 K s^2 + 16 B s^4 / h^2 with s = sin(n pi / 2 N).
double partial_hz(int n) {
  constexpr double kMass = 6.0e-5;
  constexpr double kStiffness = 10'450.0;
  constexpr double kBending = 0.19;
  constexpr double kSpacing = 0.01;
  const double s = std::sin(n * std::numbers::pi / (2.0 * kIntervals));
  const double square =
      (4.0 * kStiffness * s * s + 16.0 * kBending / (kSpacing * kSpacing) * s * s * s * s) / kMass;
  return kRate / std::numbers::pi * std::asin(0.5 * std::sqrt(square) / kRate);
}

TEST(PianoString, HasPartialsAsSharpAsItsStiffnessSays) {
  GallerySession session("piano_string.yaml");
  double largest = 0.0;
  session.play_until(0.6, [&] { largest = std::max(largest, -session.signal("felt_force")); });
  EXPECT_GT(largest, 0.5) << "the hammer has struck";
  EXPECT_LT(session.signal("hammer"), -0.003) << "and fallen back";
  EXPECT_EQ(session.signal("felt_force"), 0.0);

  std::vector<double> sound;
  while (!session.has_reached(2.6)) {
    ASSERT_TRUE(session.play_tick([&] {
      std::vector<double> values(session.scene().signals.by_step().size());
      session.scene().signals.read_by_step(session.world(), values.data());
      sound.push_back(values[0]);
    }));
  }
  for (const int n : {1, 2, 3, 5, 6, 10})
    EXPECT_NEAR(loudest_near(sound, partial_hz(n)), partial_hz(n), 0.1) << "partial " << n;
  EXPECT_GT(partial_hz(10), 10.1 * partial_hz(1)) << "sharper than a harmonic";
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
