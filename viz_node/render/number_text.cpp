// viz_node/render/number_text.cpp
#include "viz_node/render/number_text.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "node/assert.h"

namespace cordis::viz {
namespace {

constexpr std::array<Prefix, 7> kPrefixes = {
    {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1.0, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}}};

}  // namespace

Prefix prefix_of(double size) noexcept {
  const double magnitude = std::abs(size) * (1.0 + 1e-9);
  if (magnitude == 0.0 || !std::isfinite(size)) return {};
  for (const Prefix& prefix : kPrefixes) {
    if (magnitude >= prefix.factor) return prefix;
  }
  return kPrefixes.back();
}

std::string with_unit(double value, const std::string& unit) {
  if (unit.empty() || unit == "1") return fmt::format("{:.3g}", value);
  const Prefix prefix = prefix_of(value);
  return fmt::format("{:.3g} {}{}", value / prefix.factor, prefix.letter, unit);
}

std::string percent_text(double share) {
  const double percent = 100.0 * share;
  if (percent >= 9.95 || percent == 0.0) return fmt::format("{:.0f} %", percent);
  if (percent >= 0.01) return fmt::format("{:#.2g} %", percent);
  return fmt::format("{:.1e} %", percent);
}

std::string short_text(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

double round_length(double length) noexcept {
  CORDIS_ASSERT(length > 0.0 && std::isfinite(length));
  double decade = 1.0;
  while (decade > length) decade /= 10.0;
  while (10.0 * decade <= length) decade *= 10.0;
  const double digit = length / decade;
  return decade * (digit >= 5.0 ? 5.0 : digit >= 2.0 ? 2.0 : 1.0);
}

}  // namespace cordis::viz
