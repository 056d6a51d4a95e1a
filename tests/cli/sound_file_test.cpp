// tests/cli/sound_file_test.cpp -- a string that is heard sounds as it was computed.
#include "cli/table/sound_file.h"

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/exit_code.h"
#include "cli/simulate/simulate_verb.h"
#include "tests/cli/captured_run.h"
#include "tests/support/filled.h"
#include "tests/support/reference_data.h"

namespace cordis::cli {
namespace {

using std::numbers::pi;

/// What a WAV file of one channel of 32-bit floating point says, read without the library that wrote
/// it.
struct WavData {
  std::uint32_t rate_hz = 0;
  std::uint16_t format = 0;
  std::string chunks;  // names, in their order
  std::uint16_t channels = 0;
  std::vector<float> samples;
};

template <class Number>
Number number_at(const std::string& bytes, std::size_t offset) {
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

WavData read_wav(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  WavData wav;
  if (bytes.substr(0, 4) != "RIFF" || bytes.substr(8, 4) != "WAVE") return wav;
  for (std::size_t offset = 12; offset + 8 <= bytes.size();) {
    const std::string name = bytes.substr(offset, 4);
    const auto size = number_at<std::uint32_t>(bytes, offset + 4);
    wav.chunks += name + " ";
    if (name == "fmt ") {
      wav.format = number_at<std::uint16_t>(bytes, offset + 8);
      wav.channels = number_at<std::uint16_t>(bytes, offset + 10);
      wav.rate_hz = number_at<std::uint32_t>(bytes, offset + 12);
    } else if (name == "data") {
      wav.samples.resize(size / sizeof(float));
      std::memcpy(wav.samples.data(), bytes.data() + offset + 8,
                  wav.samples.size() * sizeof(float));
    }
    offset += 8 + size + size % 2;
  }
  return wav;
}

/// Amplitude of a frequency in a sound, through a Hann window.
double amplitude(const WavData& wav, double frequency_hz) {
  const std::complex<double> turn = std::polar(1.0, -2.0 * pi * frequency_hz / wav.rate_hz);
  const auto count = static_cast<double>(wav.samples.size());
  const std::complex<double> window_turn = std::polar(1.0, 2.0 * pi / count);
  std::complex<double> phase = 1.0;
  std::complex<double> window = 1.0;
  std::complex<double> sum = 0.0;
  for (const float sample : wav.samples) {
    sum += static_cast<double>(sample) * (0.5 - 0.5 * window.real()) * phase;
    phase *= turn;
    window *= window_turn;
  }
  return std::abs(sum) / count;
}

constexpr double kRateOfModes = 2.0 * pi * 1000.0;  // sqrt(K / m) [rad/s]

/// Ten masses in line between two fixed ends, the first one out of its place; the force on an end is
/// the sound.
std::string chain_text(double step_rate_hz) {
  std::string text = test::filled(R"(cordis: 1
name: chain
space: 1
step: {rate_hz: <step_rate_hz>, integrator: cordis}
matter:
)",
                                  {{"step_rate_hz", std::to_string(step_rate_hz)}});
  for (int i = 0; i < 12; ++i) {
    const bool is_end = i == 0 || i == 11;
    text += "  m" + std::to_string(i) +
            (is_end ? ": {kind: fixed" : ": {kind: mass, mass_kg: 1.0") +
            ", at_m: " + std::to_string(0.1 * i + (i == 1 ? 0.01 : 0.0)) + "}\n";
  }
  text += "liaisons: {spring: {kind: spring_damper, stiffness_n_per_m: " +
          std::to_string(kRateOfModes * kRateOfModes) + ", viscosity_n_s_per_m: 0}}\nlinks:\n";
  for (int i = 0; i < 11; ++i)
    text += "  - {liaison: spring, between: [m" + std::to_string(i) + ", m" +
            std::to_string(i + 1) + "], rest_m: 0.1}\n";
  return text + "signals: {end: {of: m0, quantity: force, sound: true, full_scale: 1.0e+6}}\n";
}

class SoundOfAChain : public testing::TestWithParam<std::pair<double, std::uint32_t>> {};

TEST_P(SoundOfAChain, HasItsPartialsWithinACentOfTheDiscreteChain) {
  const auto [step_rate_hz, file_rate_hz] = GetParam();
  const std::string name = testing::TempDir() + "chain." + std::to_string(getpid());
  std::ofstream(name + ".yaml") << chain_text(step_rate_hz);
  CommandLine line("cordis", "", "1");
  add_simulate_verb(line);
  std::string out;
  std::string error;
  ASSERT_EQ(
      run_captured(line, {"simulate", name + ".yaml", "--duration", "4s", "--wav", name + ".wav"},
                   out, error),
      kSuccess)
      << error;
  const WavData wav = read_wav(name + ".wav");
  std::filesystem::remove(name + ".yaml");
  std::filesystem::remove(name + ".wav");
  ASSERT_EQ(wav.format, 3u);  // IEEE floating point
  ASSERT_EQ(wav.channels, 1u);
  ASSERT_EQ(wav.rate_hz, file_rate_hz);
  ASSERT_NEAR(static_cast<double>(wav.samples.size()), 4.0 * file_rate_hz, 2.0);

  const nlohmann::json& modes = test::reference("R03_chain_modes")["values"]["fixed-fixed_N10"];
  ASSERT_EQ(modes.size(), 10u);
  const double h = 1.0 / step_rate_hz;
  for (const auto& mode : modes) {
    const double w = test::number(mode) * kRateOfModes;
    const double expected_hz = 2.0 / h * std::asin(0.5 * w * h) / (2.0 * pi);
    double loudest = 0.0;
    double found_cents = -100.0;
    for (double cents = -6.0; cents <= 6.0; cents += 0.25) {
      const double now = amplitude(wav, expected_hz * std::exp2(cents / 1200.0));
      if (now > loudest) found_cents = cents;
      loudest = std::max(loudest, now);
    }
    EXPECT_LT(std::abs(found_cents), 1.0) << expected_hz << " Hz at " << step_rate_hz;
    EXPECT_GT(loudest, 1e-3) << expected_hz;
  }
}

INSTANTIATE_TEST_SUITE_P(StepRates, SoundOfAChain,
                         testing::Values(std::pair{44'100.0, 44'100U}, std::pair{50'000.0, 48'000U},
                                         std::pair{21'000.0, 48'000U}));

TEST(SoundFile, KeepsItsChannelsApartAndScalesThem) {
  const std::string path = testing::TempDir() + "two." + std::to_string(getpid()) + ".wav";
  SoundFile file(path, {{"a", 2.0}, {"b", 0.5}}, 48'000.0);
  for (int i = 0; i < 5000; ++i) {
    const std::array<double, 2> values{static_cast<double>(i), -1.0};
    file.write(values);
  }
  file.finish();
  EXPECT_EQ(file.peak(), 2499.5);
  const WavData wav = read_wav(path);
  std::filesystem::remove(path);
  EXPECT_EQ(wav.format, 3u) << "IEEE floating point, and not WAVE_FORMAT_EXTENSIBLE";
  EXPECT_TRUE(wav.chunks.ends_with("fmt  JUNK fact data ")) << wav.chunks;
  ASSERT_EQ(wav.channels, 2u);
  ASSERT_EQ(wav.samples.size(), 10'000u);
  for (std::size_t i = 0; i < 5000; ++i) {
    EXPECT_EQ(wav.samples[2 * i], static_cast<float>(i) / 2.0F);
    EXPECT_EQ(wav.samples[2 * i + 1], -2.0F);
  }
}

}  // namespace
}  // namespace cordis::cli
