// viz_node/render/palette.h -- the colours of views, from viz_node/colours.json.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cordis::viz {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Dark as the page, or light for print.
enum class Theme : std::uint8_t { kDark, kLight };

/// The colours of one theme. The lists are never empty.
struct Palette {
  Colour background;
  Colour text;
  Colour quiet;  ///< of what stands beside the scene
  Colour frame;  ///< of lines around views and plots
  Colour grid_fine;
  Colour grid_coarse;
  Colour grid_axis;
  Colour fixed;
  Colour port;
  Colour surface;  ///< of what is fixed and touched
  Colour surface_edge;
  Colour outline;  ///< around balls
  std::vector<Colour> bodies;
  std::vector<Colour> link_states;  ///< by the number of the state; the first without states
  std::vector<Colour> speeds;       ///< from rest to the fastest
  std::vector<Colour> signals;
};

const Palette& palette_of(Theme theme);

/// The colour between two, `share` of the way from the first, 0..1.
Colour mix(const Colour& first, const Colour& second, double share) noexcept;

/// "#6bb8fa"
std::string hex_of(const Colour& colour);
/// @throws std::invalid_argument unless the text is # and six hexadecimal digits.
Colour colour_of(const std::string& hex);

}  // namespace cordis::viz
