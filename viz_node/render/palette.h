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
  Colour quiet;  ///< colour of what stands beside the scene
  Colour frame;  ///< colour of lines around views and plots
  Colour grid_fine;
  Colour grid_coarse;
  Colour grid_axis;
  Colour fixed;
  Colour port;
  Colour surface;  ///< colour of what is fixed and touched
  Colour surface_edge;
  Colour outline;  ///< around balls
  std::vector<Colour> bodies;
  std::vector<Colour> link_states;  ///< by the number of the state; the first without states
  std::vector<Colour> speeds;       ///< from rest to the fastest
  std::vector<Colour> stretches;    ///< from the shortest to the longest
  std::vector<Colour> signals;
};

const Palette& palette_of(Theme theme);

/// The colour between two, `share` of the way from the first, 0..1.
Colour mix(const Colour& first, const Colour& second, double share) noexcept;

/// The ratio of contrast of two colours, 1 to 21 (WCAG 2.1).
double contrast(const Colour& first, const Colour& second) noexcept;

/// The least contrast of a mark of a view to its background (WCAG 2.1, 1.4.11).
inline constexpr double kMinContrast = 3.0;

/// A colour that a scene asks for, as a theme shows it: as far towards that of texts as it takes to
/// be seen on the background.
Colour readable(const Colour& wanted, const Palette& palette) noexcept;

/// "#6bb8fa"
std::string hex_of(const Colour& colour);
/// @throws std::invalid_argument unless the text is # and six hexadecimal digits.
Colour colour_of(const std::string& hex);

}  // namespace cordis::viz
