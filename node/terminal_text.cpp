// node/terminal_text.cpp
#include "node/terminal_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace cordis::node {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t length = 0;  // [bytes]; 0: no UTF-8
};

/// The first character of a text that is not empty.
Character first_of(std::string_view text) noexcept {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80U) return {lead, 1};
  const std::size_t length = lead >= 0xf0U ? 4 : lead >= 0xe0U ? 3 : 2;
  if (lead < 0xc2U || lead > 0xf4U || text.size() < length) return {};
  std::uint32_t code = lead & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return {};
    code = code << 6U | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t kMinCode[] = {0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800U && code <= 0xdfffU;
  if (code < kMinCode[length - 2] || code > 0x10ffffU || is_surrogate) return {};
  return {code, length};
}

bool acts_on_a_terminal(std::uint32_t code) noexcept {
  if (code == '\n' || code == '\t') return false;
  const bool is_control = code < 0x20U || (code >= 0x7fU && code < 0xa0U);
  const bool turns_direction = code == 0x200eU || code == 0x200fU || code == 0x061cU ||
                               (code >= 0x202aU && code <= 0x202eU) ||
                               (code >= 0x2066U && code <= 0x2069U);
  const bool ends_a_line = code == 0x2028U || code == 0x2029U;
  return is_control || turns_direction || ends_a_line;
}

}  // namespace

std::string terminal_text(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const Character first = first_of(text);
    const std::size_t length = first.length == 0 ? 1 : first.length;
    if (first.length == 0 || acts_on_a_terminal(first.code)) {
      shown += '?';
    } else {
      shown += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return shown;
}

std::string terminal_line(std::string_view text) {
  std::string line = terminal_text(text);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\t'; }, '?');
  return line;
}

void print_text(std::FILE* stream, std::string_view text) {
  const std::string shown = terminal_text(text);
  std::fwrite(shown.data(), 1, shown.size(), stream);
}

}  // namespace cordis::node
