// tests/fuzz/message.cpp -- messages of DDS as they come over the wire, of every type.
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

}  // namespace
}  // namespace cordis::fuzz

/// The first byte chooses the type.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis;
  if (size == 0) return 0;
  const auto payload = std::as_bytes(std::span(data, size)).subspan(1);
  switch (data[0] % 9) {
    case 0:
      fuzz::read_and_write<msg::GesturePositions>(payload);
      break;
    case 1:
      fuzz::read_and_write<msg::GestureForces>(payload);
      break;
    case 2:
      fuzz::read_and_write<msg::DeviceDescription>(payload);
      break;
    case 3:
      fuzz::read_and_write<msg::SceneDescription>(payload);
      break;
    case 4:
      fuzz::read_and_write<msg::SceneFrame>(payload);
      break;
    case 5:
      fuzz::read_and_write<msg::SceneSignals>(payload);
      break;
    case 6:
      fuzz::read_and_write<msg::SceneSound>(payload);
      break;
    case 7:
      fuzz::read_and_write<msg::SceneEvents>(payload);
      break;
    default:
      fuzz::read_and_write<msg::SceneInputs>(payload);
      break;
  }
  return 0;
}
