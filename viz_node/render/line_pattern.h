// viz_node/render/line_pattern.h -- solid, dashed and dotted links, as in the page
#pragma once

#include <cstdint>

#include "viz_node/render/canvas.h"

namespace cordis::viz {

enum class LinePattern : std::uint8_t { kSolid, kDashed, kDotted };
inline constexpr std::size_t kLinePatternCount = 3;

/// A line in depth with a pattern, which is counted from `to` on.
struct PatternedLine {
  Place from;
  Place to;
  double width = 1.0;  ///< [pixels]
  LinePattern pattern = LinePattern::kSolid;
  double scale = 1.0;  ///< factor on the lengths of dashes and dots
};

/// Draws what of a line may be seen in `area`.
void draw_line(Canvas& canvas, const Rectangle& area, const PatternedLine& line,
               const Colour& colour);

}  // namespace cordis::viz
