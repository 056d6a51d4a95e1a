// device_node/drivers/kfb1.cpp
#include "device_node/drivers/kfb1.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <spdlog/spdlog.h>

#include "node/config/count_text.h"
#include "node/time.h"

namespace cordis::device {
namespace {

using Bytes = std::span<const std::uint8_t>;

enum Type : std::uint8_t { kState = 1, kForce = 2, kHello = 3, kInfo = 4, kConfig = 5, kEvent = 6 };

constexpr double kFullScale = 32767.0;
constexpr std::uint8_t kVersion = 1;
constexpr long kKfb1Baud = 1'000'000;

/// CRC-16/CCITT-FALSE.
std::uint16_t crc_of(Bytes bytes) noexcept {
  unsigned crc = 0xffff;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<unsigned>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000u) != 0 ? (crc << 1) ^ 0x1021u : crc << 1;
    crc &= 0xffffu;
  }
  return static_cast<std::uint16_t>(crc);
}

void put16(std::uint8_t* bytes, unsigned value) noexcept {
  bytes[0] = static_cast<std::uint8_t>(value & 0xffu);
  bytes[1] = static_cast<std::uint8_t>(value >> 8 & 0xffu);
}

void put32(std::uint8_t* bytes, std::uint32_t value) noexcept {
  put16(bytes, value & 0xffffu);
  put16(bytes + 2, value >> 16);
}

unsigned get16(Bytes bytes, std::size_t offset) noexcept {
  return bytes[offset] | static_cast<unsigned>(bytes[offset + 1]) << 8;
}

std::uint32_t get32(Bytes bytes, std::size_t offset) noexcept {
  return get16(bytes, offset) | static_cast<std::uint32_t>(get16(bytes, offset + 2)) << 16;
}

/// Adds the checksum, encodes and ends with 0. @return bytes written
template <class Message>
std::size_t seal(Message& payload, std::size_t count, Message& frame) noexcept {
  put16(payload.data() + count, crc_of({payload.data(), count}));
  count += 2;
  std::size_t length = 1;
  std::size_t code_at = 0;
  std::uint8_t code = 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (payload[i] != 0) {
      frame[length++] = payload[i];
      ++code;
      continue;
    }
    frame[code_at] = code;
    code_at = length++;
    code = 1;
  }
  frame[code_at] = code;
  frame[length++] = 0;
  return length;
}

/// Decodes in place. @return bytes of payload; 0 when the frame is damaged
template <class Message>
std::size_t unseal(Message& frame, std::size_t count) noexcept {
  std::size_t length = 0;
  std::size_t i = 0;
  while (i < count) {
    const std::size_t code = frame[i++];
    if (code == 0 || i + code - 1 > count) return 0;
    for (std::size_t k = 1; k < code; ++k) frame[length++] = frame[i++];
    if (i < count) frame[length++] = 0;
  }
  if (length < 3) return 0;
  const Bytes payload(frame.data(), length);
  return crc_of(payload.first(length - 2)) == get16(payload, length - 2) ? length - 2 : 0;
}

}  // namespace

void Kfb1::begin() noexcept {
  length_ = 0;
  board_asked_nsec_ = 0;
}

std::size_t Kfb1::greet(Message& message) noexcept {
  Message payload{};
  payload[0] = kHello;
  payload[1] = kVersion;
  return seal(payload, 2, message);
}

std::size_t Kfb1::configure(Message& message) noexcept {
  constexpr double kMaxForceMn = 4e9;
  compare_with_file();
  Message payload{};
  payload[0] = kConfig;
  put16(payload.data() + 1, static_cast<unsigned>(std::min(layout().rate_hz, 65535.0)));
  put32(payload.data() + 3,
        static_cast<std::uint32_t>(std::min(layout().force_limit_n * 1e3, kMaxForceMn)));
  return seal(payload, 7, message);
}

/// The 0 before it ends whatever frame has begun.
std::size_t Kfb1::release(Message& message) const noexcept {
  Message payload{};
  const auto count = static_cast<std::size_t>(layout().count);
  payload[0] = kForce;
  payload[2] = static_cast<std::uint8_t>(count);
  Message frame;
  const std::size_t length = seal(payload, 4 + 2 * count, frame);
  message[0] = 0;
  std::copy_n(frame.begin(), length, message.begin() + 1);
  return length + 1;
}

std::size_t Kfb1::request(const AxisValues& force_n, Message& message) noexcept {
  Message payload{};
  const auto count = static_cast<std::size_t>(layout().count);
  asked_nsec_ = node::monotonic_nsec();
  payload[0] = kForce;
  payload[1] = ++sequence_;
  payload[2] = static_cast<std::uint8_t>(count);
  for (std::size_t a = 0; a < count; ++a) {
    const double share = std::clamp(force_n[a] / force_n_, -1.0, 1.0);
    put16(payload.data() + 4 + 2 * a,
          static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(share * kFullScale))));
  }
  return seal(payload, 4 + 2 * count, message);
}

Hardware::Received Kfb1::receive(std::uint8_t byte) noexcept {
  if (byte != 0) {
    if (length_ < frame_.size()) frame_[length_] = byte;
    length_ = std::min(length_ + 1, frame_.size() + 1);  // one more: too long
    return Received::kNothing;
  }
  const Received received = length_ == 0 ? Received::kNothing : take_frame();
  length_ = 0;
  return received;
}

Hardware::Received Kfb1::take_frame() noexcept {
  if (length_ > frame_.size()) return Received::kBad;
  const std::size_t count = unseal(frame_, length_);
  if (count == 0) return Received::kBad;
  const Bytes payload(frame_.data(), count);
  if (payload[0] == kInfo) return take_info(payload);
  if (payload[0] == kState) return take_state(payload);
  if (payload[0] == kEvent && payload.size() > 1) return take_event(payload[1]);
  return Received::kNothing;  // or of a later version
}

/// While the board repeats an event because it lasts, that is one event.
Hardware::Received Kfb1::take_event(std::uint8_t code) noexcept {
  constexpr std::uint8_t kSaturated = 3;
  constexpr std::uint8_t kWatchdogFired = 4;
  constexpr std::int64_t kOver = 500'000'000;  // not repeated for so long [ns]
  constexpr std::array<const char*, 5> kWords = {"", "it is too hot", "emergency stop",
                                                 "a motor is saturated",
                                                 "its watchdog has fired: no FORCE for 20 ms"};
  if (code == 0 || code >= kWords.size()) return Received::kNothing;
  const std::int64_t now = node::monotonic_nsec();
  const bool goes_on = code == logged_ && now - event_nsec_ < kOver;
  logged_ = code;
  event_nsec_ = now;
  if (!goes_on && events_[code].record(now))
    spdlog::warn("kfb1: the board reports: {}", kWords[code]);
  if (code == kSaturated) return Received::kNothing;
  return code == kWatchdogFired ? Received::kLetGoOnce : Received::kLetGo;
}

Hardware::Received Kfb1::take_info(Bytes payload) noexcept {
  if (payload.size() < 17) return Received::kBad;
  const int keys = payload[2];
  if (payload[1] != kVersion || keys != layout().count || get32(payload, 7) == 0) {
    if (!wrong_boards_.record(node::monotonic_nsec())) return Received::kWrong;
    spdlog::error("kfb1: the device has {} and speaks version {}; the device file says {}",
                  config::count_text(payload[2], "key"), payload[1],
                  config::count_text(static_cast<std::size_t>(layout().count), "axis", "axes"));
    return Received::kWrong;
  }
  travel_m_ = get32(payload, 3) * 1e-6;
  force_n_ = get32(payload, 7) * 1e-3;
  return Received::kGreeted;
}

/// Reports where the device is not what its file promises to scenes. A device that is stronger than
/// the file says is asked to stay within it.
void Kfb1::compare_with_file() noexcept {
  constexpr double kUnit = 1e-6;  // in which it reports its travel [m]
  const double travel_m = layout().highest_m - layout().lowest_m;
  const bool other_travel = std::abs(travel_m_ - travel_m) > kUnit;
  const bool less_force = force_n_ < layout().force_limit_n;
  if (!other_travel && !less_force) return;
  if (!comparisons_.record(node::monotonic_nsec())) return;
  if (other_travel) {
    spdlog::warn(
        "kfb1: the keys have a travel of {:.6g} m, and travel_m of the device file is "
        "{:.6g} m: scenes are held against that",
        travel_m_, travel_m);
  }
  if (less_force) {
    spdlog::warn(
        "kfb1: the motors give {:.6g} N at most, and force_limit_n of the device file is "
        "{:.6g} N: forces above their most are cut off",
        force_n_, layout().force_limit_n);
  }
}

Hardware::Received Kfb1::take_state(Bytes payload) noexcept {
  const auto count = static_cast<std::size_t>(layout().count);
  if (payload.size() < 10 + 2 * count || payload[2] != count) return Received::kBad;
  for (std::size_t a = 0; a < count; ++a) {
    const double share = static_cast<std::int16_t>(get16(payload, 8 + 2 * a)) / kFullScale;
    newest_[a] = layout().lowest_m + 0.5 * (share + 1.0) * travel_m_;
  }
  const bool newest = payload[1] == sequence_;
  if (has_restarted(get32(payload, 4))) return Received::kRestarted;
  if (newest) {
    board_usec_ = get32(payload, 4);
    board_asked_nsec_ = asked_nsec_;
  }
  return newest ? Received::kSample : Received::kOldSample;
}

/// The time of a board goes on by no more than has passed since its last STATE was asked for. That
/// of a board that has restarted is earlier, which looks like up to 71 minutes later.
bool Kfb1::has_restarted(std::uint32_t board_usec) noexcept {
  constexpr std::int64_t kClockError = 1'000'000;  // [us]
  constexpr std::int64_t kReordered = 10'000;      // an older datagram [us]
  if (board_asked_nsec_ == 0) return false;
  const std::int64_t passed_usec = (node::monotonic_nsec() - board_asked_nsec_) / 1000;
  const std::int64_t board_passed_usec = static_cast<std::uint32_t>(board_usec - board_usec_);
  const bool is_older = board_passed_usec > 0xffffffff - kReordered;
  if (is_older || board_passed_usec <= passed_usec + kClockError) return false;
  if (restarts_.record(node::monotonic_nsec()))
    spdlog::warn("kfb1: the board has restarted; it is greeted and configured again");
  return true;
}

void Kfb1::report_repeats(std::int64_t now_nsec) noexcept {
  for (node::RepeatedEvent& event : events_) event.report(now_nsec);
  for (node::RepeatedEvent* event : {&restarts_, &wrong_boards_, &comparisons_})
    event->report(now_nsec);
}

std::unique_ptr<Driver> make_kfb1(const config::Value& section, const AxisLayout& layout,
                                  config::Problems& problems) {
  config::MappingReader reader(section, "kfb1", problems);
  std::unique_ptr<Wire> wire = read_wire(reader, kKfb1Baud);
  const HardwareSettings settings = read_hardware(reader, layout, problems);
  reader.finish();
  if (problems.has_errors()) return nullptr;
  return std::make_unique<Kfb1>(std::move(wire), settings, layout);
}

}  // namespace cordis::device
