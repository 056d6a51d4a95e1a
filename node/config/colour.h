// node/config/colour.h -- a colour as a file says it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cordis::config {

/// sRGB, 0..255.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  friend bool operator==(const Colour&, const Colour&) = default;
};

/// The colour of "#ff8800", or of a name of CSS in small letters. Nothing for any other word.
std::optional<Colour> colour_of(std::string_view word);

/// The names of CSS (CSS Color Module Level 4, named colors), in alphabetical order.
std::vector<std::string> colour_names();

}  // namespace cordis::config
