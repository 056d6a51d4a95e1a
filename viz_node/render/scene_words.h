// viz_node/render/scene_words.h -- the legend of a scene and its ruler
#pragma once

#include "viz_node/render/canvas.h"
#include "viz_node/render/scene_painter.h"

namespace cordis::viz {

inline constexpr int kLegendRows = 2;  ///< at most

/// Draws the legend of bodies, fixed points, ports and links, in rows one above the other, as many
/// entries as there is room for.
/// @param at     the left end of the lowest row, on its base line
/// @param size   of the font [pixels]
/// @param width  of the row [pixels]
void draw_legend(Canvas& canvas, const ScenePainter& painter, const Place& at, double size,
                 double width);

/// Draws the scale of the colours, if there is one: its ends on both sides, its meaning below.
/// @param at    the middle of the lower edge of its strip
/// @param size  of the font [pixels]
void draw_scale(Canvas& canvas, const ScenePainter& painter, const Place& at, double size);

/// Draws a ruler of a round length, at most `longest` pixels, with its length behind it.
void draw_ruler(Canvas& canvas, const Palette& palette, double metres_per_pixel, const Place& at,
                double size, double longest);

}  // namespace cordis::viz
