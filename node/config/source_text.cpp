// node/config/source_text.cpp
#include "node/config/source_text.h"

#include <algorithm>
#include <utility>

namespace cordis::config {

namespace {

bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

/// Bytes of the character at `start`; 0 when it is not text.
std::size_t character_length(std::string_view text, std::size_t start) {
  const auto lead = static_cast<unsigned char>(text[start]);
  if (lead < 0x80) {
    const bool line_end = lead == '\n' || text.substr(start, 2) == "\r\n";
    return (lead < 0x20 && lead != '\t' && !line_end) || lead == 0x7f ? 0 : 1;
  }
  if (lead < 0xc2 || lead > 0xf4) return 0;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  const std::string_view rest = text.substr(start + 1, length - 1);
  const bool whole =
      rest.size() == length - 1 && std::all_of(rest.begin(), rest.end(), continues_character);
  return whole ? length : 0;
}

}  // namespace

SourceText::SourceText(const std::string& text, std::string name, bool one_word)
    : text_(text), name_(std::move(name)), one_word_(one_word) {
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    lines_.push_back(std::string_view(text).substr(start, end - start));
    start = end + 1;
  }
}

Place SourceText::place(std::size_t line_index, std::size_t byte) {
  if (one_word_) return {name_, 0, 0};
  if (line_index != line_index_ || byte < byte_) {
    line_index_ = line_index;
    byte_ = 0;
    character_ = 0;
  }
  const std::string_view text = line(line_index);
  for (; byte_ < byte; ++byte_) {
    if (byte_ >= text.size() || !continues_character(text[byte_])) ++character_;
  }
  return {name_, static_cast<int>(line_index) + 1, static_cast<int>(character_) + 1};
}

std::optional<Place> SourceText::place_of_no_text() {
  std::size_t line_index = 0;
  std::size_t line_start = 0;
  for (std::size_t i = 0; i < text_.size();) {
    const std::size_t length = character_length(text_, i);
    if (length == 0) return place(line_index, i - line_start);
    if (text_[i] == '\n') {
      ++line_index;
      line_start = i + 1;
    }
    i += length;
  }
  return std::nullopt;
}

std::string_view SourceText::line(std::size_t index) const noexcept {
  return index < lines_.size() ? lines_[index] : std::string_view{};
}

}  // namespace cordis::config
