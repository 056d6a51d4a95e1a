// viz_node/render/palette.cpp
#include "viz_node/render/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "viz_node/render/colour_table.h"

namespace cordis::viz {
namespace {

using Json = nlohmann::json;

std::vector<Colour> list_of(const Json& theme, const char* key) {
  std::vector<Colour> colours;
  for (const Json& hex : theme.at(key)) colours.push_back(colour_of(hex.get<std::string>()));
  if (colours.empty()) throw std::invalid_argument(std::string(key) + " has no colour");
  return colours;
}

Palette read_palette(const char* name) {
  const Json table = Json::parse(kColourTable);
  const Json& theme = table.at(name);
  const auto one = [&theme](const char* key) { return colour_of(theme.at(key)); };
  return {.background = one("background"),
          .text = one("text"),
          .quiet = one("quiet"),
          .frame = one("frame"),
          .grid_fine = one("grid_fine"),
          .grid_coarse = one("grid_coarse"),
          .grid_axis = one("grid_axis"),
          .fixed = one("fixed"),
          .port = one("port"),
          .surface = one("surface"),
          .surface_edge = one("surface_edge"),
          .outline = one("outline"),
          .bodies = list_of(theme, "bodies"),
          .link_states = list_of(theme, "link_states"),
          .speeds = list_of(theme, "speeds"),
          .stretches = list_of(theme, "stretches"),
          .signals = list_of(theme, "signals")};
}

}  // namespace

const Palette& palette_of(Theme theme) {
  static const Palette kDarkPalette = read_palette("dark");
  static const Palette kLightPalette = read_palette("light");
  return theme == Theme::kDark ? kDarkPalette : kLightPalette;
}

Colour mix(const Colour& first, const Colour& second, double share) noexcept {
  const auto between = [share](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * share));
  };
  return {between(first.red, second.red), between(first.green, second.green),
          between(first.blue, second.blue)};
}

namespace {

/// Relative luminance of sRGB, 0..1.
double luminance(const Colour& colour) noexcept {
  const auto linear = [](std::uint8_t byte) {
    const double share = byte / 255.0;
    return share <= 0.03928 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

}  // namespace

double contrast(const Colour& first, const Colour& second) noexcept {
  const double a = luminance(first);
  const double b = luminance(second);
  return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

Colour readable(const Colour& wanted, const Palette& palette) noexcept {
  constexpr int kSteps = 20;
  for (int step = 0; step < kSteps; ++step) {
    const Colour colour = mix(wanted, palette.text, static_cast<double>(step) / kSteps);
    if (contrast(colour, palette.background) >= kMinContrast) return colour;
  }
  return palette.text;
}

std::string hex_of(const Colour& colour) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", colour.red, colour.green, colour.blue);
  return text.data();
}

Colour colour_of(const std::string& hex) {
  if (hex.size() != 7 || hex[0] != '#' ||
      hex.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) {
    throw std::invalid_argument("'" + hex + "' is no colour");
  }
  const unsigned long value = std::stoul(hex.substr(1), nullptr, 16);
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255u),
          static_cast<std::uint8_t>(value & 255u)};
}

}  // namespace cordis::viz
