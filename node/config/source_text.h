// node/config/source_text.h -- a text in lines, and places in it as a person counts them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "node/config/problem.h"

namespace cordis::config {

/// The text of a file or of one word, which must outlive this.
class SourceText {
 public:
  /// @param one_word  places have no line: the text stands on the command line, not in a file.
  SourceText(const std::string& text, std::string name, bool one_word);

  /// The place of a byte, both counted from 0. Asked in the order of the text, all places together
  /// cost one walk through it.
  Place place(std::size_t line_index, std::size_t byte);

  /// Place of the first byte that is not text: malformed UTF-8, a control character other than tab
  /// and line end, a carriage return alone.
  std::optional<Place> place_of_no_text();

  /// Empty when there is no such line.
  std::string_view line(std::size_t index) const noexcept;
  std::size_t line_count() const noexcept { return lines_.size(); }
  const std::string& name() const noexcept { return name_; }

 private:
  const std::string& text_;
  std::string name_;
  bool one_word_;
  std::vector<std::string_view> lines_;
  std::size_t line_index_ = 0;  // where the last place was, and its character
  std::size_t byte_ = 0;
  std::size_t character_ = 0;
};

}  // namespace cordis::config
