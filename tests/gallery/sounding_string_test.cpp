// tests/gallery/sounding_string_test.cpp
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kStepsPerSecond = 44'100.0;

/// The sound of a part of the session, step by step. Changes of the liaison of the bow are counted.
std::vector<double> bridge_until(GallerySession& session, double time_s) {
  std::vector<double> sound;
  while (!session.has_reached(time_s)) {
    EXPECT_TRUE(session.play_tick([&] {
      double value = 0.0;
      session.scene().signals.read_by_step(session.world(), &value);
      sound.push_back(value);
    }));
  }
  return sound;
}

/// The loudest frequency between two others, to 0.05 Hz.
double loudest_hz(const std::vector<double>& sound, double lowest_hz, double highest_hz) {
  double best = 0.0;
  double found = 0.0;
  for (double hz = lowest_hz; hz <= highest_hz; hz += 0.05) {
    const auto turn = std::polar(1.0, -2.0 * std::numbers::pi * hz / kStepsPerSecond);
    std::complex<double> phase = 1.0;
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < sound.size(); ++i, phase *= turn) {
      const double x = static_cast<double>(i) / static_cast<double>(sound.size());
      sum += sound[i] * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * x)) * phase;
    }
    if (std::abs(sum) > best) found = hz;
    best = std::max(best, std::abs(sum));
  }
  return found;
}

std::uint64_t slips(const GallerySession& session, std::uint32_t machine) {
  return session.world().change_count(machine, 1, 2);  // hooked to sliding
}

std::uint32_t machine_of_the_bow(const GallerySession& session) {
  const auto& machines = session.world().network().description().state_machines;
  for (std::uint32_t m = 0; m < machines.size(); ++m) {
    if (machines[m].states.size() == 3 && machines[m].states[1].name == "hooked") return m;
  }
  ADD_FAILURE() << "no bow";
  return 0;
}

TEST(SoundingString, SoundsAnAWhenItIsPluckedAndSlipsOnceASwingUnderTheBow) {
  GallerySession session("sounding_string.yaml");
  bridge_until(session, 0.6);
  const std::vector<double> plucked = bridge_until(session, 2.6);
  // Lowest frequency of 100 masses between fixed ends; the step raises it by 7e-6 of itself.
  const engine::NetworkDescription& network = session.world().network().description();
  const double note_hz = 2.0 * std::sqrt(network.links[0].stiffness / network.mats[1].mass) *
                         std::sin(std::numbers::pi / 202.0) / (2.0 * std::numbers::pi);
  EXPECT_NEAR(note_hz, 110.0, 0.1);
  EXPECT_NEAR(loudest_hz(plucked, 105.0, 115.0), note_hz, 0.11);
  const double loudest = *std::ranges::max_element(plucked);
  EXPECT_GT(loudest, 0.1);
  EXPECT_LT(loudest, 4.0) << "beyond full scale";

  const std::uint32_t bow = machine_of_the_bow(session);
  bridge_until(session, 3.4);
  const std::uint64_t before = slips(session, bow);
  const std::vector<double> bowed = bridge_until(session, 3.75);
  EXPECT_NEAR(static_cast<double>(slips(session, bow) - before), 0.35 * note_hz, 5.0);
  EXPECT_LT(*std::ranges::max_element(bowed), 4.0) << "beyond full scale";
}

TEST(SoundingString, StepsAsOftenAsItSays) {
  GallerySession session("sounding_string.yaml");
  session.play_until(1.0);
  EXPECT_EQ(session.world().step_count(), 44'100u);
}

}  // namespace
}  // namespace cordis::test
