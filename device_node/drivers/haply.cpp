// device_node/drivers/haply.cpp
#include "device_node/drivers/haply.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace cordis::device {
namespace {

constexpr std::uint8_t kConfigure = 1;
constexpr std::uint8_t kTorques = 2;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFarthestTurn = 4.0 * std::numbers::pi;  // no arm is wound up like that
constexpr long kHaplyBaud = 57600;                        // without meaning: native USB

void put_float(std::uint8_t* bytes, double value) noexcept {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  for (int i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(bits >> (8 * i) & 0xffu);
}

double get_float(const std::uint8_t* bytes) noexcept {
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
  return std::bit_cast<float>(bits);
}

}  // namespace

Haply::Haply(std::unique_ptr<Wire> wire, const HardwareSettings& settings, const AxisLayout& layout,
             const HaplySettings& haply)
    : Hardware(std::move(wire), settings, layout), haply_(haply), jumps_(layout.rate_hz) {}

std::array<std::size_t, 2> Haply::by_port() const noexcept {
  if (haply_.ports[0] < haply_.ports[1]) return {0, 1};
  return {1, 0};
}

void Haply::begin() noexcept {
  length_ = 0;
  configured_ = false;
  jumps_.forget();
  pose_.exists = false;
}

/// Nothing is asked: the configuration has no answer. It goes out before the first torques.
std::size_t Haply::greet(Message&) noexcept {
  return 0;
}

/// Nothing marks the beginning of a request. So first go as many bytes as the longest one may lack,
/// of a value that is no type, and that makes a torque that lacks its last byte as good as 0. (A 0
/// would be the type that makes the board forget its motors, with the torque that they have.)
std::size_t Haply::release(Message& message) const noexcept {
  constexpr std::size_t kLongestRest = 25;  // of a configuration
  constexpr std::uint8_t kNoType = 3;       // and as the last byte of a float: below 1e-36
  constexpr std::size_t kTorqueBytes = 8;
  auto end = std::fill_n(message.begin(), kLongestRest, kNoType);
  *end++ = kTorques;
  *end++ = haply_.device_id;
  end = std::fill_n(end, kTorqueBytes, std::uint8_t{0});
  return static_cast<std::size_t>(end - message.begin());
}

std::size_t Haply::request(const AxisValues& force_n, Message& message) noexcept {
  std::size_t count = 0;
  const auto add = [&](std::uint8_t byte) { message[count++] = byte; };
  const auto add_float = [&](double value) {
    put_float(message.data() + count, value);
    count += 4;
  };
  const auto order = by_port();
  if (!std::exchange(configured_, true)) {
    add(kConfigure);
    add(haply_.device_id);
    const unsigned mask = 1u << (haply_.ports[0] - 1) | 1u << (haply_.ports[1] - 1);
    for (const auto* turns : {&haply_.motor_turns, &haply_.encoder_turns}) {
      add(static_cast<std::uint8_t>(mask));
      for (const std::size_t arm : order) add(static_cast<std::uint8_t>((*turns)[arm]));
    }
    add(0);  // sensors
    add(0);  // pulses
    for (const std::size_t arm : order) {
      add_float(haply_.offsets_deg[arm]);
      add_float(haply_.counts_per_turn[arm]);
    }
  }
  const Pantograph::Pair torque =
      pose_.exists ? Pantograph::torques(pose_, {force_n[0], force_n[1]}, haply_.torque_limit_n_m)
                   : Pantograph::Pair{};
  add(kTorques);
  add(haply_.device_id);
  for (const std::size_t arm : order) add_float(torque[arm]);
  return count;
}

Hardware::Received Haply::receive(std::uint8_t byte) noexcept {
  if (length_ == 0 && byte != haply_.device_id) return Received::kBad;
  answer_[length_++] = byte;
  if (length_ < kAnswer) return Received::kNothing;
  length_ = 0;
  return take_angles();
}

Hardware::Received Haply::take_angles() noexcept {
  Pantograph::Pair angle{};
  const auto order = by_port();
  for (std::size_t i = 0; i < 2; ++i) {
    angle[order[i]] = get_float(answer_.data() + 1 + 4 * i) * kDegree;
  }
  const bool sane = std::abs(angle[0]) < kFarthestTurn && std::abs(angle[1]) < kFarthestTurn;
  const Pantograph::Pose pose = sane ? haply_.arms.forward(angle) : Pantograph::Pose{};
  if (!pose.exists || !jumps_.believes({pose.pen_m[0], pose.pen_m[1]})) return Received::kBad;
  pose_ = pose;
  return Received::kSample;
}

void Haply::position(AxisValues& position_m) const noexcept {
  for (std::size_t i = 0; i < 2; ++i) position_m[i] = pose_.pen_m[i] - haply_.rest_m[i];
}

std::unique_ptr<Driver> make_haply(const config::Value& section, const AxisLayout& layout,
                                   config::Problems& problems) {
  using config::Range;
  config::MappingReader reader(section, "haply", problems);
  std::unique_ptr<Wire> wire = read_wire(reader, kHaplyBaud);
  const HardwareSettings settings = read_hardware(reader, layout, problems);
  HaplySettings haply;
  haply.device_id = static_cast<std::uint8_t>(reader.optional_integer("device_id", 5, 1, 254));
  const auto pair = [&](const char* key, Pantograph::Pair fallback) {
    const std::vector<double> two = reader.optional_numbers(key, {fallback[0], fallback[1]}, 2);
    return Pantograph::Pair{two[0], two[1]};
  };
  haply.rest_m = pair("rest_m", haply.rest_m);
  haply.offsets_deg = pair("offsets_deg", haply.offsets_deg);
  haply.counts_per_turn = pair("counts_per_turn", haply.counts_per_turn);
  if (!(std::min(haply.counts_per_turn[0], haply.counts_per_turn[1]) > 0.0)) {
    reader.error_at("counts_per_turn", "counts_per_turn must be > 0, of both encoders");
  }
  haply.arms.inner_m = reader.optional_number("inner_m", haply.arms.inner_m, Range::positive());
  haply.arms.outer_m = reader.optional_number("outer_m", haply.arms.outer_m, Range::positive());
  haply.arms.base_m = reader.optional_number("base_m", haply.arms.base_m, Range::not_negative());
  haply.torque_limit_n_m = reader.optional_number(
      "torque_limit_n_m", layout.force_limit_n * (haply.arms.inner_m + haply.arms.outer_m),
      Range::positive());
  reader.finish();
  if (layout.count != 2) problems.error(section.place(), "haply: it has two axes, x and y");
  Pantograph::Pair angle{};
  if (!haply.arms.inverse(haply.rest_m, angle)) {
    problems.error(section.place(), "haply: rest_m is out of the reach of its arms");
  }
  if (problems.has_errors()) return nullptr;
  return std::make_unique<Haply>(std::move(wire), settings, layout, haply);
}

}  // namespace cordis::device
