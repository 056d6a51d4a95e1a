// viz_node/render/text_shape.cpp
#include "viz_node/render/text_shape.h"

#include <algorithm>

namespace cordis::viz {
namespace {

const Letter* find_letter(std::uint32_t code) noexcept {
  const auto found = std::ranges::lower_bound(kLetterTable.letters, code, {}, &Letter::code);
  return found == kLetterTable.letters.end() || found->code != code ? nullptr : &*found;
}

const Letter& letter_of(std::uint32_t code) noexcept {
  const Letter* letter = find_letter(code);
  return letter != nullptr ? *letter : *find_letter('?');
}

/// Takes one code off the front of a text in UTF-8; a byte that is none counts as itself.
std::uint32_t next_code(std::string_view& text) noexcept {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t first = byte(0);
  std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
  if (more >= text.size()) more = 0;
  std::uint32_t code = more == 0 ? first : first & (0x3fu >> more);
  for (std::size_t i = 1; i <= more; ++i) code = code << 6 | (byte(i) & 0x3fu);
  text.remove_prefix(1 + more);
  return code;
}

}  // namespace

std::vector<OutlineStep> text_outline(std::string_view text, double size) {
  const double scale = size / kLetterTable.units_per_size;
  std::vector<OutlineStep> outline;
  double advance = 0.0;
  while (!text.empty()) {
    const Letter& letter = letter_of(next_code(text));
    for (const LetterStep& step : kLetterTable.steps.subspan(letter.first, letter.count)) {
      outline.push_back({static_cast<OutlineStep::Kind>(step.kind), scale * (advance + step.x),
                         scale * step.y, scale * (advance + step.control_x),
                         scale * step.control_y});
    }
    advance += letter.advance;
  }
  return outline;
}

double text_width(std::string_view text, double size) {
  double units = 0.0;
  while (!text.empty()) units += letter_of(next_code(text)).advance;
  return units * size / kLetterTable.units_per_size;
}

}  // namespace cordis::viz
