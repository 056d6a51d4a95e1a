// tests/fuzz/message.cpp -- messages of DDS as they come over the wire, of every type.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "node/dds/payload.h"

namespace cordis::fuzz {
namespace {

/// What was read can be written, and read again as the same bytes.
template <class Message>
void read_and_write(std::span<const std::byte> payload) {
  Message message;
  if (!dds::decode(payload, message)) return;
  const std::vector<std::byte> written = dds::encode(message);
  Message again;
  if (!dds::decode(written, again) || dds::encode(again) != written) std::abort();
}

constexpr std::array kReadAndWrite{
    read_and_write<msg::GesturePositions>,  read_and_write<msg::GestureForces>,
    read_and_write<msg::DeviceDescription>, read_and_write<msg::SceneDescription>,
    read_and_write<msg::SceneFrame>,        read_and_write<msg::SceneSignals>,
    read_and_write<msg::SceneSound>,        read_and_write<msg::SceneEvents>,
    read_and_write<msg::SceneInputs>,       read_and_write<msg::ControlCommand>,
    read_and_write<msg::ControlReply>,      read_and_write<msg::NodeStatus>,
    read_and_write<msg::PointerTarget>,     read_and_write<msg::PointerState>,
};

}  // namespace
}  // namespace cordis::fuzz

/// The first byte chooses the type.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using cordis::fuzz::kReadAndWrite;
  if (size == 0) return 0;
  kReadAndWrite[data[0] % kReadAndWrite.size()](std::as_bytes(std::span(data, size)).subspan(1));
  return 0;
}
