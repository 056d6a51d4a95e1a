// tests/fuzz/haply.cpp -- what the board of a pantograph may send.
#include "device_node/drivers/haply.h"

#include <vector>

#include "tests/fuzz/board_input.h"

namespace cordis::fuzz {
namespace {

/// An answer: its identity and eight bytes.
void say_angles(PairedWire& wire, Bytes part) {
  std::vector<std::uint8_t> answer{device::HaplySettings{}.device_id};
  for (std::size_t i = 0; i < 8; ++i) answer.push_back(i < part.size() ? part[i] : std::uint8_t{0});
  wire.say(answer);
}

}  // namespace
}  // namespace cordis::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis;
  constexpr int kAxes = 2;
  fuzz::live_with_board(
      {data, size}, kAxes,
      [](std::unique_ptr<device::Wire> wire, const device::AxisLayout& layout) {
        return std::make_unique<device::Haply>(std::move(wire), fuzz::impatient(), layout,
                                               device::HaplySettings{});
      },
      fuzz::say_angles);
  return 0;
}
