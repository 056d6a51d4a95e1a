// tests/fuzz/page_message.cpp -- what a page may say over its WebSocket.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "viz_node/page_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis::viz;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(read_acknowledgement(text));
  static_cast<void>(read_sound_request(text));
  const auto command = read_page_command(text);
  if (command && !std::isfinite(command->value)) std::abort();
  return 0;
}
