// viz_node/render/view_camera.h -- where the viewer stands, as in the page.
#pragma once

#include <cstdint>

#include "viz_node/render/vectors.h"

namespace cordis::viz {

/// A box along the axes [m].
struct Box {
  Point low{};
  Point high{};

  Point centre() const noexcept;
  Point size() const noexcept;
  double diagonal() const noexcept;
  /// The smallest box that holds both.
  Box united(const Box& other) const noexcept;
};

/// The directions of the page's keys 1 to 4.
enum class ViewPreset : std::uint8_t { kFront, kSide, kTop, kFree };

/// A place in the view [pixels]: x to the right, y down, depth towards the viewer.
struct Projected {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double scale = 0.0;  ///< pixels per metre at this place; 0 behind the viewer
};

/// Parallel or in perspective with 40 degrees of height. It computes with + - * / and square roots
/// alone, so a place is the same on every machine.
class ViewCamera {
 public:
  /// Looks at the middle of `box` from so far that all of it is in view.
  /// @param width, height  of the view [pixels], > 0
  ViewCamera(ViewPreset preset, bool is_parallel, const Box& box, double width, double height);

  /// Width by height of a box in this view.
  static double aspect_of(ViewPreset preset, const Box& box);

  Projected project(const Point& point) const noexcept;
  /// Radius of a sphere of `radius` [m] around a projected centre [pixels].
  double radius_of(const Projected& centre, double radius) const noexcept;
  /// True if the viewer is on the side of a plane to which its normal points.
  /// @param at  a point of the plane
  bool is_before(const Point& at, const Point& normal) const noexcept;
  /// Length of a pixel at the middle of the box [m].
  double metres_per_pixel() const noexcept { return metres_per_pixel_; }
  bool is_parallel() const noexcept { return is_parallel_; }

 private:
  Point centre_;
  Point right_;
  Point up_;
  Point towards_;  // the viewer
  double half_width_;
  double half_height_;
  double metres_per_pixel_;
  double distance_;  // of the viewer [m]
  bool is_parallel_;
};

}  // namespace cordis::viz
