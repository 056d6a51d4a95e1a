// tests/fuzz/firefader.cpp -- what a board with two faders may send.
#include "device_node/drivers/firefader.h"

#include <vector>

#include "tests/fuzz/board_input.h"

namespace cordis::fuzz {
namespace {

/// An answer: its mark and six bytes, of which none is a mark.
void say_answer(PairedWire& wire, Bytes part) {
  std::vector<std::uint8_t> answer{255};
  for (std::size_t i = 0; i < 6; ++i)
    answer.push_back(i < part.size() ? static_cast<std::uint8_t>(part[i] % 255) : std::uint8_t{0});
  wire.say(answer);
}

}  // namespace
}  // namespace cordis::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis;
  constexpr int kFaders = 2;
  static constexpr double kFullScaleN = 2.0;
  fuzz::live_with_board(
      {data, size}, kFaders,
      [](std::unique_ptr<device::Wire> wire, const device::AxisLayout& layout) {
        return std::make_unique<device::FireFader>(std::move(wire), fuzz::impatient(), layout,
                                                   kFullScaleN);
      },
      fuzz::say_answer);
  return 0;
}
