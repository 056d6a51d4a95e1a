// viz_node/render/canvas.h -- what views, chronograms and plots are drawn on: pixels, SVG or PDF.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "viz_node/render/palette.h"

namespace cordis::viz {

/// A place [pixels]: x to the right, y down from the upper left corner, depth towards the viewer.
struct Place {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

/// A corner of a polygon: its place, and how many pixels a metre has there.
struct Corner {
  Place place;
  double scale = 1.0;
};

/// An upright rectangle [pixels].
struct Rectangle {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// Where the given x of a text is in it.
enum class Anchor : std::uint8_t { kStart, kMiddle, kEnd };

/// Marks are drawn in the order of the calls, from back to front. Widths and radii are in pixels.
class Canvas {
 public:
  virtual ~Canvas() = default;

  /// Until end_view() nothing is drawn outside of `area`; depths count from this call.
  /// @param words  attributes of the view that a reader of the file finds, as SVG writes them
  virtual void begin_view(const Rectangle& area, const std::string& words) = 0;
  virtual void end_view() = 0;

  virtual void fill(const Rectangle& area, const Colour& colour) = 0;
  /// A lit sphere.
  virtual void ball(const Place& centre, double radius, const Colour& colour) = 0;
  /// A ring in depth, as thimbles are. @param hole  radius of its hole, a share of its own, 0..1
  virtual void torus(const Place& centre, double radius, double hole, const Colour& colour) = 0;
  /// A circle, of which the line alone is drawn.
  virtual void ring(const Place& centre, double radius, double width, const Colour& colour) = 0;
  /// A straight line in depth.
  virtual void link(const Place& from, const Place& to, double width, const Colour& colour) = 0;
  /// A flat convex face in depth, without an outline.
  virtual void polygon(const std::vector<Corner>& corners, const Colour& colour) = 0;
  /// A line through all these places, in front of everything.
  virtual void line(const std::vector<Place>& places, double width, const Colour& colour) = 0;
  /// A line of text. @param at  its base line; @param size  of the font
  virtual void text(const Place& at, double size, Anchor anchor, const Colour& colour,
                    std::string_view words) = 0;
};

}  // namespace cordis::viz
