// viz_node/render/surface_painter.cpp
#include "viz_node/render/surface_painter.h"

#include <algorithm>
#include <utility>

namespace cordis::viz {
namespace {

constexpr double kBackdropZ = -1e19;      // behind all matter, before the grid
constexpr double kBackdropLineZ = -1e18;  // before the face of its plane
constexpr double kEdgeLift = 1.5;         // of an edge over its face, towards the viewer [pixels]
constexpr int kEdgePieces = 12;           // in perspective depth is straight in short pieces alone

Point middle_of(const SurfaceShape& shape) noexcept {
  Point sum{};
  double count = 0.0;
  for (const SurfaceFace& face : shape.faces) {
    for (const Point& corner : face.corners) {
      sum = sum + corner;
      count += 1.0;
    }
  }
  return (1.0 / std::max(count, 1.0)) * sum;
}

}  // namespace

SurfacePainter::SurfacePainter(const std::vector<msg::SurfaceDescription>& surfaces,
                               const Box& home, std::uint32_t space, const ViewCamera& camera,
                               const Rectangle& inner, double line_width,
                               const std::vector<SurfaceColours>& colours)
    : camera_(camera), inner_(inner), line_width_(line_width) {
  std::size_t surface = 0;
  for (SurfaceShape& shape : shapes_of(surfaces, home, space)) {
    const SurfaceColours& its = colours[surface++];
    if (shape.is_backdrop)
      backdrops_.push_back({std::move(shape), its});
    else
      add_solid(std::move(shape), its);
  }
  std::ranges::stable_sort(bodies_, {}, &Solid::z);
}

void SurfacePainter::add_solid(SurfaceShape shape, const SurfaceColours& colours) {
  std::vector<bool> is_seen;
  for (const SurfaceFace& face : shape.faces)
    is_seen.push_back(camera_.is_before(face.corners.front(), face.normal));
  const double z = camera_.project(middle_of(shape)).z;
  bodies_.push_back({std::move(shape), colours, std::move(is_seen), z});
}

Corner SurfacePainter::corner_of(const Point& point) const noexcept {
  const Projected place = camera_.project(point);
  return {{place.x + inner_.x, place.y + inner_.y, place.z}, place.scale};
}

void SurfacePainter::draw_face(Canvas& canvas, const SurfaceFace& face, const Colour& colour,
                               bool is_deep) const {
  std::vector<Corner> corners;
  for (const Point& point : face.corners) {
    corners.push_back(corner_of(point));
    if (corners.back().scale <= 0.0) return;
    if (!is_deep) corners.back().place.z = kBackdropZ;
  }
  canvas.polygon(corners, mix({0, 0, 0}, colour, light_on_surface(face.normal)));
}

void SurfacePainter::draw_edge(Canvas& canvas, const SurfaceEdge& edge, const Colour& colour,
                               bool is_deep) const {
  const int pieces = is_deep && !camera_.is_parallel() ? kEdgePieces : 1;
  const auto place_at = [&](int piece) {
    Corner corner =
        corner_of(edge.from + (static_cast<double>(piece) / pieces) * (edge.to - edge.from));
    corner.place.z = is_deep ? corner.place.z + kEdgeLift : kBackdropLineZ;
    return corner;
  };
  for (int piece = 0; piece < pieces; ++piece) {
    const Corner from = place_at(piece);
    const Corner to = place_at(piece + 1);
    if (from.scale > 0.0 && to.scale > 0.0) canvas.link(from.place, to.place, line_width_, colour);
  }
}

void SurfacePainter::draw_backdrops(Canvas& canvas) const {
  for (const auto& [shape, colours] : backdrops_) {
    for (const SurfaceFace& face : shape.faces) {
      if (camera_.is_before(face.corners.front(), face.normal))
        draw_face(canvas, face, colours.face, /*is_deep=*/false);
    }
  }
  for (const auto& [shape, colours] : backdrops_) {
    for (const SurfaceEdge& edge : shape.edges)
      draw_edge(canvas, edge, colours.edge, /*is_deep=*/false);
  }
}

void SurfacePainter::draw_body(Canvas& canvas, std::size_t index) const {
  const auto& [shape, colours, is_seen, z] = bodies_[index];
  for (std::size_t face = 0; face < shape.faces.size(); ++face) {
    if (is_seen[face]) draw_face(canvas, shape.faces[face], colours.face, /*is_deep=*/true);
  }
  for (const SurfaceEdge& edge : shape.edges) {
    const bool one = is_seen[edge.face];
    const bool other = is_seen[edge.other_face];
    if (edge.is_sharp ? one || other : one != other)
      draw_edge(canvas, edge, colours.edge, /*is_deep=*/true);
  }
}

std::size_t SurfacePainter::layer_of(const Point& place) const noexcept {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto& [shape, colours, is_seen, z] = bodies_[i];
    bool is_behind = true;
    for (std::size_t face = 0; is_behind && face < shape.faces.size(); ++face) {
      const SurfaceFace& side = shape.faces[face];
      is_behind = !is_seen[face] || dot(place - side.corners.front(), side.normal) <= 0.0;
    }
    if (is_behind) return i;
  }
  return bodies_.size();
}

}  // namespace cordis::viz
