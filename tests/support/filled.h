// tests/support/filled.h -- a text with named gaps, such as a scene of which one value changes.
#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace cordis::test {

/// The text with each `<name>` replaced by its value, in the order of the list.
/// @throws std::invalid_argument if the text holds no gap of that name.
[[nodiscard]] inline std::string filled(
    std::string text, std::initializer_list<std::pair<std::string_view, std::string>> values) {
  for (const auto& [name, value] : values) {
    std::string gap(1, '<');
    gap.append(name).append(1, '>');
    std::size_t begin = text.find(gap);
    if (begin == std::string::npos) throw std::invalid_argument("the text has no gap " + gap);
    for (; begin != std::string::npos; begin = text.find(gap, begin + value.size()))
      text.replace(begin, gap.size(), value);
  }
  return text;
}

}  // namespace cordis::test
