// viz_node/render/line_pattern.cpp
#include "viz_node/render/line_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cordis::viz {
namespace {

/// Lengths [pixels], as in the page: viz_node/web/page/mat_material.ts.
struct Dashes {
  double period;
  double inked;
};
constexpr std::array<Dashes, kLinePatternCount> kDashes{{{0.0, 0.0}, {9.0, 5.5}, {4.0, 1.7}}};

/// The shares of a line, counted from `to`, between which it is inside of a rectangle; first > second
/// where it is outside.
std::pair<double, double> shares_within(const PatternedLine& line, const Rectangle& area) {
  double first = 0.0;
  double last = 1.0;
  const auto clip = [&](double start, double way, double low, double high) {
    if (way == 0.0) {
      if (start < low || start > high) last = -1.0;
      return;
    }
    const double a = (low - start) / way;
    const double b = (high - start) / way;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  };
  const double room = line.width;
  clip(line.to.x, line.from.x - line.to.x, area.x - room, area.x + area.width + room);
  clip(line.to.y, line.from.y - line.to.y, area.y - room, area.y + area.height + room);
  return {first, last};
}

}  // namespace

void draw_line(Canvas& canvas, const Rectangle& area, const PatternedLine& line,
               const Colour& colour) {
  if (line.pattern == LinePattern::kSolid) {
    canvas.link(line.from, line.to, line.width, colour);
    return;
  }
  const double x = line.from.x - line.to.x;
  const double y = line.from.y - line.to.y;
  const double length = std::sqrt(x * x + y * y);
  const Dashes& dashes = kDashes[static_cast<std::size_t>(line.pattern)];
  const double period = dashes.period * line.scale;
  const auto [first, last] = shares_within(line, area);
  if (first >= last || length <= 0.0) return;
  const auto place_at = [&](double along) {
    const double share = along / length;
    return Place{line.to.x + share * x, line.to.y + share * y,
                 line.to.z + share * (line.from.z - line.to.z)};
  };
  // The round ends of a line are part of a dash.
  const double cap = std::min(0.5 * line.width, 0.45 * dashes.inked * line.scale);
  const auto first_dash = static_cast<long>(std::floor(first * length / period));
  const auto dash_end = static_cast<long>(std::ceil(last * length / period));
  for (long dash = first_dash; dash < dash_end; ++dash) {
    const double begin = static_cast<double>(dash) * period + cap;
    const double end =
        std::min(static_cast<double>(dash) * period + dashes.inked * line.scale, length) - cap;
    if (end > begin) canvas.link(place_at(begin), place_at(end), line.width, colour);
  }
}

}  // namespace cordis::viz
