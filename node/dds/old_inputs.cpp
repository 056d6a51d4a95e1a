// node/dds/old_inputs.cpp
#include "node/dds/old_inputs.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include "node/assert.h"

namespace cordis::dds {
namespace {

using eprosima::fastcdr::Cdr;

constexpr std::uint32_t kLastOld = 9;  // version of the wire
constexpr std::size_t kPlace = 20;     // of wire_version, and of the clock before: 0..2

/// Kinds of version 9, in their order. Their verb and bound had a byte each.
enum class OldKind : std::uint32_t { kCommand, kHold, kRepeat, kLetGo };

/// Kinds of today of the verbs of version 9, in their order. `load` has none: a scene that was loaded
/// stands in a list of its own.
constexpr std::array<std::optional<msg::InputKind>, 7> kKindOfVerb{
    msg::INPUT_PAUSE, msg::INPUT_RESUME, msg::INPUT_STEP, msg::INPUT_RESET,
    std::nullopt,     msg::INPUT_SET,    msg::INPUT_STATE};

/// @return false when the kind, verb or bound does not exist
bool translate(std::uint32_t old_kind, std::uint8_t verb, std::uint8_t bound,
               msg::InputEvent& event) {
  switch (static_cast<OldKind>(old_kind)) {
    case OldKind::kCommand:
      if (verb >= kKindOfVerb.size() || !kKindOfVerb[verb]) return false;
      event.kind(*kKindOfVerb[verb]);
      return true;
    case OldKind::kHold:
      event.kind(msg::INPUT_HOLD);
      return true;
    case OldKind::kRepeat:
      event.kind(msg::INPUT_REPEAT);
      return true;
    case OldKind::kLetGo:
      event.kind(msg::INPUT_LET_GO);
      event.bound(static_cast<msg::SceneBound>(bound));
      return bound <= msg::BOUND_ENERGY;
  }
  return false;
}

template <class Value>
Value read(Cdr& cdr) {
  Value value{};
  cdr >> value;
  return value;
}

/// @return false when it is none
bool read_event(Cdr& cdr, msg::InputEvent& event) {
  event.number(read<std::uint64_t>(cdr));
  event.turn(read<std::uint64_t>(cdr));
  event.step(read<std::uint64_t>(cdr));
  const auto kind = read<std::uint32_t>(cdr);
  event.device_id(read<std::uint32_t>(cdr));
  const auto verb = read<std::uint8_t>(cdr);
  event.argument(read<std::string>(cdr));
  return translate(kind, verb, read<std::uint8_t>(cdr), event);
}

void write_event(Cdr& cdr, const msg::InputEvent& event) {
  cdr << event.number() << event.turn() << event.step();
  const auto* const verb = std::ranges::find(kKindOfVerb, std::optional(event.kind()));
  const bool is_command = verb != kKindOfVerb.end();
  const OldKind kind = is_command                          ? OldKind::kCommand
                       : event.kind() == msg::INPUT_HOLD   ? OldKind::kHold
                       : event.kind() == msg::INPUT_REPEAT ? OldKind::kRepeat
                                                           : OldKind::kLetGo;
  cdr << static_cast<std::uint32_t>(kind) << event.device_id();
  cdr << static_cast<std::uint8_t>(is_command ? verb - kKindOfVerb.begin() : 0);
  cdr << event.argument() << static_cast<std::uint8_t>(event.bound());
}

}  // namespace

bool is_old_inputs(std::span<const std::byte> payload) noexcept {
  if (payload.size() < kPlace + sizeof(std::uint32_t)) return false;
  const bool is_little_endian = (payload[1] & std::byte{1}) != std::byte{0};  // [DDSI 10.2]
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < sizeof word; ++i) {
    const std::size_t place = kPlace + (is_little_endian ? sizeof word - 1 - i : i);
    word = word << 8 | std::to_integer<std::uint32_t>(payload[place]);
  }
  return word <= msg::PACE_ASAP;
}

bool read_old_inputs(std::span<const std::byte> payload, msg::SceneInputs& message) {
  CORDIS_ASSERT(is_old_inputs(payload));
  std::vector<char> bytes(payload.size());
  std::memcpy(bytes.data(), payload.data(), payload.size());
  eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
  Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  cdr.read_encapsulation();
  message.epoch(read<std::uint64_t>(cdr));
  message.batch(read<std::uint64_t>(cdr));
  message.wire_version(kLastOld);
  message.clock(static_cast<msg::InputClock>(read<std::uint32_t>(cdr)));
  message.keeps_devices(read<bool>(cdr));
  message.engine_version(read<std::string>(cdr));
  message.hash_version(read<std::uint32_t>(cdr));
  message.turns(read<std::uint64_t>(cdr));
  message.lost(read<std::uint64_t>(cdr));
  cdr >> message.scene() >> message.reach() >> message.sample();
  const auto count = read<std::uint32_t>(cdr);
  message.event().clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!read_event(cdr, message.event().emplace_back())) return false;
  }
  return true;
}

std::vector<std::byte> encode_old_inputs(const msg::SceneInputs& message) {
  try {
    constexpr std::size_t kSpare = 64;
    constexpr std::size_t kSpareOfEvent = 8;  // its verb, and what aligns the next one
    std::vector<char> bytes(msg::SceneInputs::getCdrSerializedSize(message) + kSpare +
                            kSpareOfEvent * message.event().size());
    eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    cdr << message.epoch() << message.batch() << static_cast<std::uint32_t>(message.clock());
    cdr << message.keeps_devices() << message.engine_version() << message.hash_version();
    cdr << message.turns() << message.lost();
    cdr << message.scene() << message.reach() << message.sample();
    cdr << static_cast<std::uint32_t>(message.event().size());
    for (const msg::InputEvent& event : message.event()) write_event(cdr, event);
    const auto* const begin = reinterpret_cast<const std::byte*>(bytes.data());
    return {begin, begin + cdr.getSerializedDataLength()};
  } catch (const eprosima::fastcdr::exception::Exception& fault) {
    throw std::runtime_error(std::string("inputs cannot be written: ") + fault.what());
  }
}

}  // namespace cordis::dds
