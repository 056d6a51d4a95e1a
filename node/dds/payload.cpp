// node/dds/payload.cpp
#include "node/dds/payload.h"

#include <array>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include <fastdds/rtps/common/SerializedPayload.h>

#include "node/assert.h"
#include "node/cdr.h"
#include "node/dds/message_types.h"
#include "node/dds/old_inputs.h"

namespace cordis::dds {
namespace {

constexpr std::size_t kMaxInputs = std::size_t{16} << 20;  // [bytes]

template <class Message>
constexpr bool kIsGesture =
    std::is_same_v<Message, msg::GesturePositions> || std::is_same_v<Message, msg::GestureForces>;

/// Bytes that a message of wire version 2 lacks at its end: gestures had no answer_delay_s, which
/// then reads as 0.
template <class Message>
std::size_t missing_bytes(typename TypeOf<Message>::Type& type, Message& message,
                          std::size_t size) {
  if constexpr (!kIsGesture<Message>) return 0;
  const bool is_older = size + sizeof(double) == type.getSerializedSizeProvider(&message)();
  return is_older ? sizeof(double) : 0;
}

/// The last wire versions whose SceneDescription ends without `sets`, `surface_mat`, `colours`,
/// `surfaces`, `port_frames`: each lacks what stands before it in this list as well.
constexpr std::array<std::uint32_t, 5> kLastWithout{8, 7, 5, 4, 3};

constexpr std::size_t kCount = 4;  // bytes of the count of a sequence

/// Bytes that a SceneFrame of wire version 8 lacks: the counts of `bond_ends`, `bond_state`,
/// `bond_count` and `port_force_n`, and `bonds_left_out`.
constexpr std::size_t kFrameTail = 5 * kCount;

/// True if nothing of what a SceneFrame has had since version 9 is in it.
bool has_no_tail(const msg::SceneFrame& frame) noexcept {
  return frame.bond_ends().empty() && frame.bond_state().empty() && frame.bond_count().empty() &&
         frame.bonds_left_out() == 0 && frame.port_force_n().empty();
}

/// Bytes of an empty sequence behind a payload of `size` bytes, alignment included.
constexpr std::size_t empty_sequence_bytes(std::size_t size) noexcept {
  return kCount + (kCount - size % kCount) % kCount;
}

template <class Type, class Message>
bool decode_padded(Type& type, std::span<const std::byte> payload, std::size_t missing,
                   Message& message) {
  const auto length = static_cast<std::uint32_t>(payload.size() + missing);
  eprosima::fastrtps::rtps::SerializedPayload_t bytes(length);
  std::memcpy(bytes.data, payload.data(), payload.size());
  std::memset(bytes.data + payload.size(), 0, missing);
  bytes.length = length;
  return type.deserialize(&bytes, &message);
}

}  // namespace

template <class Message>
bool decode(std::span<const std::byte> payload, Message& message) noexcept {
  if (payload.size() < kEncapsulationBytes) return false;
  if (std::is_same_v<Message, msg::SceneInputs> && payload.size() > kMaxInputs) return false;
  try {
    if constexpr (std::is_same_v<Message, msg::SceneInputs>) {
      if (is_old_inputs(payload)) return read_old_inputs(payload, message);
    }
    typename TypeOf<Message>::Type type;
    const std::size_t missing = missing_bytes(type, message, payload.size());
    if (decode_padded(type, payload, missing, message)) return true;
    if constexpr (std::is_same_v<Message, msg::SceneDescription>) {
      std::size_t missing_sequences = empty_sequence_bytes(payload.size());
      for (const std::uint32_t last_version : kLastWithout) {
        if (decode_padded(type, payload, missing_sequences, message))
          return message.wire_version() <= last_version;
        missing_sequences += kCount;
      }
    }
    if constexpr (std::is_same_v<Message, msg::SceneFrame>)
      return decode_padded(type, payload, kFrameTail, message) && has_no_tail(message);
    return false;
  } catch (...) {  // lengths of sequences are as hostile as any other number
    return false;
  }
}

template <class Message>
std::vector<std::byte> encode(Message& message) {
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;
  if constexpr (std::is_same_v<Message, msg::SceneInputs>)
    CORDIS_ASSERT(message.wire_version() > msg::PACE_ASAP);
  typename TypeOf<Message>::Type type;
  Payload bytes(type.getSerializedSizeProvider(&message)());
  if (!type.serialize(&message, &bytes)) throw std::runtime_error("a message cannot be serialized");
  std::vector<std::byte> payload(bytes.length);
  std::memcpy(payload.data(), bytes.data, bytes.length);
  return payload;
}

#define CORDIS_PAYLOAD(Message)                                                           \
  template bool decode<msg::Message>(std::span<const std::byte>, msg::Message&) noexcept; \
  template std::vector<std::byte> encode<msg::Message>(msg::Message&);
CORDIS_PAYLOAD(GesturePositions)
CORDIS_PAYLOAD(GestureForces)
CORDIS_PAYLOAD(DeviceDescription)
CORDIS_PAYLOAD(SceneDescription)
CORDIS_PAYLOAD(SceneFrame)
CORDIS_PAYLOAD(SceneSignals)
CORDIS_PAYLOAD(SceneSound)
CORDIS_PAYLOAD(SceneEvents)
CORDIS_PAYLOAD(SceneInputs)
CORDIS_PAYLOAD(ControlCommand)
CORDIS_PAYLOAD(ControlReply)
CORDIS_PAYLOAD(NodeStatus)
CORDIS_PAYLOAD(PointerTarget)
CORDIS_PAYLOAD(PointerState)
#undef CORDIS_PAYLOAD

}  // namespace cordis::dds
