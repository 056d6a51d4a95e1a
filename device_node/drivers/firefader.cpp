// device_node/drivers/firefader.cpp
#include "device_node/drivers/firefader.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cordis::device {
namespace {

constexpr std::uint8_t kRequestMark = 127;
constexpr std::uint8_t kAnswerMark = 255;
constexpr double kLargestForce = 126.0;
constexpr double kLargestPosition = 254.0;
constexpr long kFirefaderBaud = 57600;
constexpr int kFaders = 2;

}  // namespace

FireFader::FireFader(std::unique_ptr<Wire> wire, const HardwareSettings& settings,
                     const AxisLayout& layout, double full_scale_n)
    : Hardware(std::move(wire), settings, layout),
      full_scale_n_(full_scale_n),
      jumps_(layout.rate_hz) {}

void FireFader::begin() noexcept {
  length_ = kAnswer + 1;
  jumps_.forget();
}

/// The mark restarts a request wherever the board is.
std::size_t FireFader::release(Message& message) const noexcept {
  message[0] = kRequestMark;
  std::fill_n(message.begin() + 1, kFaders, std::uint8_t{0});
  return 1 + kFaders;
}

std::size_t FireFader::request(const AxisValues& force_n, Message& message) noexcept {
  message[0] = kRequestMark;
  for (std::size_t a = 0; a < kFaders; ++a) {
    const double share = std::clamp(force_n[a] / full_scale_n_, -1.0, 1.0);
    message[1 + a] =
        static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lround(share * kLargestForce)));
  }
  return 1 + kFaders;
}

Hardware::Received FireFader::receive(std::uint8_t byte) noexcept {
  if (byte == kAnswerMark) {
    const bool cut_short = length_ < kAnswer;
    length_ = 0;
    return cut_short ? Received::kBad : Received::kNothing;
  }
  if (length_ >= kAnswer) return Received::kNothing;
  answer_[length_++] = byte;
  if (length_ < kAnswer) return Received::kNothing;
  AxisValues place{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(layout().count); ++a) {
    const double share = answer_[a] / kLargestPosition;
    place[a] = layout().lowest_m + share * (layout().highest_m - layout().lowest_m);
  }
  if (!jumps_.believes(place)) return Received::kBad;
  newest_ = place;
  return Received::kSample;
}

std::unique_ptr<Driver> make_firefader(const config::Value& section, const AxisLayout& layout,
                                       config::Problems& problems) {
  config::MappingReader reader(section, "firefader", problems);
  std::unique_ptr<Wire> wire = read_wire(reader, kFirefaderBaud);
  const HardwareSettings settings = read_hardware(reader, layout, problems);
  const double full_scale_n =
      reader.optional_number("full_scale_n", 2.0, config::Range::positive());
  reader.finish();
  if (layout.count > kFaders) {
    problems.error(section.place(), "firefader: it has at most two axes");
  }
  if (problems.has_errors()) return nullptr;
  return std::make_unique<FireFader>(std::move(wire), settings, layout, full_scale_n);
}

}  // namespace cordis::device
