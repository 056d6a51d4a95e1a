// tests/fuzz/kfb1.cpp -- what a self-built keyboard may send.
#include "device_node/drivers/kfb1.h"

#include <vector>

#include "tests/fuzz/board_input.h"

namespace cordis::fuzz {
namespace {

/// CRC-16/CCITT-FALSE, bit by bit.
unsigned checksum(Bytes bytes) {
  unsigned crc = 0xffff;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      const bool odd = ((crc >> 15) & 1u) != ((static_cast<unsigned>(byte) >> bit) & 1u);
      crc = ((crc << 1) & 0xffffu) ^ (odd ? 0x1021u : 0u);
    }
  }
  return crc;
}

/// A frame of docs/kfb1.md: the checksum is right whatever the payload is.
void say_frame(PairedWire& wire, Bytes payload) {
  std::vector<std::uint8_t> content(payload.begin(), payload.end());
  const unsigned crc = checksum(payload);
  content.push_back(static_cast<std::uint8_t>(crc & 0xffu));
  content.push_back(static_cast<std::uint8_t>(crc >> 8));
  std::vector<std::uint8_t> frame{0};
  std::vector<std::uint8_t> block;
  content.push_back(0);
  for (const std::uint8_t byte : content) {
    if (byte != 0) {
      block.push_back(byte);
      continue;
    }
    frame.push_back(static_cast<std::uint8_t>(block.size() + 1));
    frame.insert(frame.end(), block.begin(), block.end());
    block.clear();
  }
  frame.push_back(0);
  wire.say(frame);
}

}  // namespace
}  // namespace cordis::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis;
  constexpr int kKeys = 2;
  fuzz::live_with_board(
      {data, size}, kKeys,
      [](std::unique_ptr<device::Wire> wire, const device::AxisLayout& layout) {
        return std::make_unique<device::Kfb1>(std::move(wire), fuzz::impatient(), layout);
      },
      fuzz::say_frame);
  return 0;
}
