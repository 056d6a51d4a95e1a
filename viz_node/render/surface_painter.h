// viz_node/render/surface_painter.h -- the surfaces of a scene in a view, and what they hide
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "idl/scene.h"
#include "viz_node/render/canvas.h"
#include "viz_node/render/palette.h"
#include "viz_node/render/surface_shape.h"
#include "viz_node/render/view_camera.h"

namespace cordis::viz {

/// The colours of a surface.
struct SurfaceColours {
  Colour face;
  Colour edge;
};

/// Draws the surfaces around one box, as one camera sees them. Canvases without depth draw matter
/// between the bodies: layer 0, body 0, layer 1, body 1 and so on, from back to front.
class SurfacePainter {
 public:
  /// @param inner       where the camera's view lies in the canvas
  /// @param line_width  of edges [pixels]
  /// @param colours     per surface
  SurfacePainter(const std::vector<msg::SurfaceDescription>& surfaces, const Box& home,
                 std::uint32_t space, const ViewCamera& camera, const Rectangle& inner,
                 double line_width, const std::vector<SurfaceColours>& colours);

  /// Draws planes and sections, behind everything else.
  void draw_backdrops(Canvas& canvas) const;
  void draw_body(Canvas& canvas, std::size_t body) const;
  /// Boxes and cylinders, from back to front.
  std::size_t body_count() const noexcept { return bodies_.size(); }
  /// The layer of a place outside of all bodies: below the first body that may hide it.
  std::size_t layer_of(const Point& place) const noexcept;

 private:
  /// A box or a cylinder, and which of its faces the viewer sees.
  struct Solid {
    SurfaceShape shape;
    SurfaceColours colours;
    std::vector<bool> is_seen;
    double z;  // of its middle [pixels]
  };

  /// A plane or a section.
  struct Backdrop {
    SurfaceShape shape;
    SurfaceColours colours;
  };

  void add_solid(SurfaceShape shape, const SurfaceColours& colours);
  void draw_face(Canvas& canvas, const SurfaceFace& face, const Colour& colour, bool is_deep) const;
  void draw_edge(Canvas& canvas, const SurfaceEdge& edge, const Colour& colour, bool is_deep) const;
  Corner corner_of(const Point& point) const noexcept;

  const ViewCamera& camera_;
  const Rectangle inner_;
  const double line_width_;
  std::vector<Backdrop> backdrops_;
  std::vector<Solid> bodies_;
};

}  // namespace cordis::viz
