// viz_node/render/surface_shape.cpp
#include "viz_node/render/surface_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "viz_node/render/number_text.h"

namespace cordis::viz {
namespace {

using Surface = msg::SurfaceDescription;

constexpr double kSurfaceRoom = 0.15;       // beyond the scene in space, in its diagonals
constexpr double kFlatRoom = 3.0;           // likewise of a flat one
constexpr double kPlaneCells = 12.0;        // across the larger side of a plane, at least
constexpr double kHatchLength = 0.7;        // length of a hatch, in cells
constexpr double kNearDiagonals = 10.0;     // diagonals, from which on nothing unbounded counts
constexpr std::size_t kCircleCorners = 48;  // of a circle
constexpr double kTurnCos = 0.9914448613738104;  // of an angle of 360 / 48 degrees
constexpr double kTurnSin = 0.13052619222005157;

Point point_of(const std::vector<double>& numbers) noexcept {
  return {numbers[0], numbers[1], numbers[2]};
}

/// Half of the extent of a box along an axis [m].
double half_extent(const Point& size, const Point& axis) noexcept {
  return 0.5 *
         (std::abs(axis[0]) * size[0] + std::abs(axis[1]) * size[1] + std::abs(axis[2]) * size[2]);
}

/// A unit vector across `axis`, along a coordinate axis where that is possible.
Point across(const Point& axis) noexcept {
  std::size_t least = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(axis[k]) < std::abs(axis[least]) - 1e-9) least = k;
  }
  Point along{};
  along[least] = 1.0;
  return normalized(along - dot(along, axis) * axis);
}

/// The side of a plane that matter can be on, or both.
struct HalfSpace {
  Point foot;
  Point normal;
  bool has_both_sides = false;

  double height(const Point& point) const noexcept { return dot(point - foot, normal); }
};

std::vector<HalfSpace> half_spaces_of(const std::vector<Surface>& surfaces) {
  std::vector<HalfSpace> planes;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].kind() != msg::SURFACE_PLANE) continue;
    const bool has_both_sides =
        i + 1 < surfaces.size() && surfaces[i + 1].kind() == msg::SURFACE_INNER_FACE;
    planes.push_back(
        {point_of(surfaces[i].centre_m()), point_of(surfaces[i].axis()), has_both_sides});
  }
  return planes;
}

std::vector<Point> clipped(const std::vector<Point>& corners, const HalfSpace& side) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point& from = corners[i];
    const Point& to = corners[(i + 1) % corners.size()];
    const double begins = side.height(from);
    const double ends = side.height(to);
    if (begins >= 0.0) kept.push_back(from);
    if ((begins >= 0.0) != (ends >= 0.0))
      kept.push_back(from + (begins / (begins - ends)) * (to - from));
  }
  return kept;
}

/// Takes a shape and leaves what is on the outer side of every plane with one side but its own.
class PlaneCutter {
 public:
  explicit PlaneCutter(std::vector<HalfSpace> planes) : planes_(std::move(planes)) {}

  void add_face(SurfaceShape& shape, std::size_t own, SurfaceFace face) const {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      if (cuts(i, own)) face.corners = clipped(face.corners, planes_[i]);
    }
    if (face.corners.size() >= 3) shape.faces.push_back(std::move(face));
  }

  void add_line(SurfaceShape& shape, std::size_t own, Point from, Point to) const {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      if (!cuts(i, own)) continue;
      const double begins = planes_[i].height(from);
      const double ends = planes_[i].height(to);
      if (begins < 0.0 && ends < 0.0) return;
      const Point cut = from + (begins / (begins - ends)) * (to - from);
      if (begins < 0.0) from = cut;
      if (ends < 0.0) to = cut;
    }
    shape.edges.push_back({from, to});
  }

 private:
  /// False for the plane itself, one with both sides, and one that faces the same way: it is no border.
  bool cuts(std::size_t other, std::size_t own) const noexcept {
    return own != other && !planes_[other].has_both_sides &&
           dot(planes_[own].normal, planes_[other].normal) <= 1.0 - 1e-9;
  }

  std::vector<HalfSpace> planes_;
};

struct Span {
  double low;
  double high;
};

/// From one round place to another, around a middle.
Span round_span(double middle, double half, double cell) noexcept {
  return {cell * std::floor((middle - half) / cell), cell * std::ceil((middle + half) / cell)};
}

/// What is left of `place` over whole cells, 0 or more.
double within_cell(double place, double cell) noexcept {
  return place - cell * std::floor(place / cell);
}

/// Places of the lines of a grid that goes along with its plane: both ends, and each whole cell from
/// `origin` between them.
std::vector<double> grid_places(const Span& span, double origin, double cell) {
  const long cells = std::lround((span.high - span.low) / cell);
  const double first = span.low + within_cell(origin, cell);
  std::vector<double> places{span.low};
  for (long k = 0; k < cells; ++k) {
    const double place = first + static_cast<double>(k) * cell;
    if (place > span.low && place < span.high) places.push_back(place);
  }
  places.push_back(span.high);
  return places;
}

SurfaceShape plane_of(const PlaneCutter& cutter, std::size_t own, const HalfSpace& plane,
                      const Box& home) {
  const Point u = across(plane.normal);
  const Point v = cross(plane.normal, u);
  const Point foot = home.centre() - plane.height(home.centre()) * plane.normal;
  const double room = kSurfaceRoom * std::max(home.diagonal(), 1e-6);
  const double half_u = half_extent(home.size(), u) + room;
  const double half_v = half_extent(home.size(), v) + room;
  const double cell = round_length(2.0 * std::max(half_u, half_v) / kPlaneCells);
  const Span spread_u = round_span(dot(foot, u), half_u, cell);
  const Span spread_v = round_span(dot(foot, v), half_v, cell);
  const Point base = dot(plane.foot, plane.normal) * plane.normal;
  const auto place_at = [&](double along_u, double along_v) {
    return base + along_u * u + along_v * v;
  };
  SurfaceShape shape;
  cutter.add_face(shape, own,
                  {{place_at(spread_u.low, spread_v.low), place_at(spread_u.high, spread_v.low),
                    place_at(spread_u.high, spread_v.high), place_at(spread_u.low, spread_v.high)},
                   plane.normal});
  if (plane.has_both_sides && !shape.faces.empty()) {
    SurfaceFace other = shape.faces.front();
    std::ranges::reverse(other.corners);
    other.normal = -1.0 * other.normal;
    shape.faces.push_back(std::move(other));
  }
  for (const double place : grid_places(spread_u, dot(plane.foot, u), cell))
    cutter.add_line(shape, own, place_at(place, spread_v.low), place_at(place, spread_v.high));
  for (const double place : grid_places(spread_v, dot(plane.foot, v), cell))
    cutter.add_line(shape, own, place_at(spread_u.low, place), place_at(spread_u.high, place));
  return shape;
}

/// A line far past the view, with short lines on the side where matter cannot be, if there is one. They go
/// along with the plane.
SurfaceShape line_of(const PlaneCutter& cutter, std::size_t own, const HalfSpace& plane,
                     const Box& home, double level) {
  const Point along{-plane.normal[1], plane.normal[0], 0.0};
  const Point size = home.size();
  const double reach_out = std::max({size[0], size[1], 1e-6});
  const double cell = round_length(reach_out / kPlaneCells);
  Point foot = home.centre() - plane.height(home.centre()) * plane.normal;
  foot[2] = level;
  SurfaceShape shape;
  cutter.add_line(shape, own, foot - kFlatRoom * reach_out * along,
                  foot + kFlatRoom * reach_out * along);
  if (shape.edges.empty() || plane.has_both_sides) return shape;
  const SurfaceEdge whole = shape.edges.front();
  const Point hatch = (-kHatchLength * cell) * normalized(plane.normal + along);
  const double length = dot(whole.to - whole.from, along);
  const double first = within_cell(dot(plane.foot - whole.from, along) + 0.5 * cell, cell);
  for (double place = first; place < length; place += cell) {
    const Point from = whole.from + place * along;
    shape.edges.push_back({from, from + hatch});
  }
  return shape;
}

/// The range of a box along an axis, past the scene where it has no bound.
Span span_of(const Surface& box, const Box& home, std::size_t axis, double room) noexcept {
  const double size = box.size_m()[axis];
  const double centre = box.centre_m()[axis];
  if (size > 0.0) return {centre - 0.5 * size, centre + 0.5 * size};
  return {home.low[axis] - room, home.high[axis] + room};
}

/// Faces of a box: two for each axis, the lower one first.
SurfaceShape box_of(const Surface& box, const Box& home) {
  const double room = kSurfaceRoom * home.diagonal();
  const std::array<Span, 3> spans = {span_of(box, home, 0, room), span_of(box, home, 1, room),
                                     span_of(box, home, 2, room)};
  SurfaceShape shape;
  shape.is_backdrop = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3;
    const std::size_t last = (axis + 2) % 3;
    const auto place_at = [&](double a, double b, double c) {
      Point point{};
      point[axis] = a;
      point[next] = b;
      point[last] = c;
      return point;
    };
    const auto& [b0, b1] = spans[next];
    const auto& [c0, c1] = spans[last];
    const double low = spans[axis].low;
    const double high = spans[axis].high;
    Point normal{};
    normal[axis] = -1.0;
    shape.faces.push_back({{place_at(low, b0, c0), place_at(low, b0, c1), place_at(low, b1, c1),
                            place_at(low, b1, c0)},
                           normal});
    normal[axis] = 1.0;
    shape.faces.push_back({{place_at(high, b0, c0), place_at(high, b1, c0), place_at(high, b1, c1),
                            place_at(high, b0, c1)},
                           normal});
    for (const std::size_t upper_b : {0u, 1u}) {
      for (const std::size_t upper_c : {0u, 1u}) {
        const double b = upper_b == 1 ? b1 : b0;
        const double c = upper_c == 1 ? c1 : c0;
        shape.edges.push_back(
            {place_at(low, b, c), place_at(high, b, c), 2 * next + upper_b, 2 * last + upper_c});
      }
    }
  }
  return shape;
}

/// Directions of the corners of a circle across `axis`, from `from` on.
std::vector<Point> circle_of(const Point& axis, const Point& from) {
  const Point other = cross(axis, from);
  std::vector<Point> directions;
  double x = 1.0;
  double y = 0.0;
  for (std::size_t i = 0; i < kCircleCorners; ++i) {
    directions.push_back(x * from + y * other);
    const double next = x * kTurnCos - y * kTurnSin;
    y = x * kTurnSin + y * kTurnCos;
    x = next;
  }
  return directions;
}

/// The inner sides of a body: a viewer sees those behind what is inside, past the ones before it.
SurfaceShape hollow_of(SurfaceShape shape) {
  shape.is_backdrop = true;
  for (SurfaceFace& face : shape.faces) {
    std::ranges::reverse(face.corners);
    face.normal = -1.0 * face.normal;
  }
  std::erase_if(shape.edges, [](const SurfaceEdge& edge) { return !edge.is_sharp; });
  for (SurfaceEdge& edge : shape.edges) edge.face = edge.other_face = 0;
  return shape;
}

/// The outline of a section alone.
SurfaceShape outline_of(SurfaceShape shape) {
  shape.faces.clear();
  return shape;
}

/// The sides of a cylinder, then the cap towards its axis and the other one.
SurfaceShape cylinder_of(const Surface& cylinder, const Box& home) {
  const Point axis = point_of(cylinder.axis());
  const Point centre = point_of(cylinder.centre_m());
  const double radius = cylinder.size_m()[0];
  Span span{-0.5 * cylinder.size_m()[1], 0.5 * cylinder.size_m()[1]};
  if (cylinder.size_m()[1] == 0.0) {
    const double middle = dot(home.centre() - centre, axis);
    const double half = half_extent(home.size(), axis) + kSurfaceRoom * home.diagonal();
    span = {middle - half, middle + half};
  }
  const Point low = centre + span.low * axis;
  const Point high = centre + span.high * axis;
  const std::vector<Point> around = circle_of(axis, across(axis));
  SurfaceShape shape;
  shape.is_backdrop = false;
  SurfaceFace upper{{}, axis};
  SurfaceFace lower{{}, -1.0 * axis};
  for (std::size_t i = 0; i < kCircleCorners; ++i) {
    const std::size_t next = (i + 1) % kCircleCorners;
    const std::size_t before = (i + kCircleCorners - 1) % kCircleCorners;
    const Point here = radius * around[i];
    const Point there = radius * around[next];
    shape.faces.push_back({{low + here, low + there, high + there, high + here},
                           normalized(around[i] + around[next])});
    shape.edges.push_back({high + here, high + there, i, kCircleCorners});
    shape.edges.push_back({low + here, low + there, i, kCircleCorners + 1});
    shape.edges.push_back({low + here, high + here, before, i, false});
    upper.corners.push_back(high + here);
    lower.corners.insert(lower.corners.begin(), low + here);
  }
  shape.faces.push_back(std::move(upper));
  shape.faces.push_back(std::move(lower));
  return shape;
}

/// A filled outline at `level`, behind the matter of a flat scene.
SurfaceShape section_of(std::vector<Point> corners, double level) {
  for (Point& corner : corners) corner[2] = level;
  SurfaceShape shape;
  for (std::size_t i = 0; i < corners.size(); ++i)
    shape.edges.push_back({corners[i], corners[(i + 1) % corners.size()]});
  shape.faces.push_back({std::move(corners), {0.0, 0.0, 1.0}});
  return shape;
}

SurfaceShape box_section(const Surface& box, const Box& home, double level) {
  const Point size = home.size();
  const double room = kFlatRoom * std::max({size[0], size[1], 1e-6});
  const Span x = span_of(box, home, 0, room);
  const Span y = span_of(box, home, 1, room);
  return section_of(
      {{x.low, y.low, 0.0}, {x.high, y.low, 0.0}, {x.high, y.high, 0.0}, {x.low, y.high, 0.0}},
      level);
}

/// A disc where the axis points to the viewer, else a strip.
SurfaceShape cylinder_section(const Surface& cylinder, const Box& home, double level) {
  const Point centre = point_of(cylinder.centre_m());
  const Point axis = point_of(cylinder.axis());
  const double radius = cylinder.size_m()[0];
  if (std::abs(axis[2]) > 0.5) {
    std::vector<Point> corners;
    for (const Point& direction : circle_of({0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}))
      corners.push_back(centre + radius * direction);
    return section_of(std::move(corners), level);
  }
  const Point along = normalized({axis[0], axis[1], 0.0});
  const Point aside = radius * Point{-along[1], along[0], 0.0};
  const Point size = home.size();
  const bool is_bounded = cylinder.size_m()[1] > 0.0;
  const double half =
      is_bounded ? 0.5 * cylinder.size_m()[1] : kFlatRoom * std::max({size[0], size[1], 1e-6});
  const Point middle = is_bounded ? centre : centre + dot(home.centre() - centre, along) * along;
  return section_of({middle - half * along - aside, middle + half * along - aside,
                     middle + half * along + aside, middle - half * along + aside},
                    level);
}

/// Its two ends.
std::array<Point, 2> ends_of(const Surface& segment) noexcept {
  const Point centre = point_of(segment.centre_m());
  const Point half = 0.5 * segment.size_m()[0] * point_of(segment.axis());
  return {centre - half, centre + half};
}

SurfaceShape segment_of(const Surface& segment, double level) {
  auto [from, to] = ends_of(segment);
  from[2] = to[2] = level;
  SurfaceShape shape;
  shape.edges.push_back({from, to});
  return shape;
}

/// The box around a cylinder; of an infinite one, around a disc of it at `near`.
Box box_around(const Surface& cylinder, const Point& near) noexcept {
  const Point axis = point_of(cylinder.axis());
  const double radius = cylinder.size_m()[0];
  const double half = 0.5 * cylinder.size_m()[1];
  Box box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double extent =
        half * std::abs(axis[k]) + radius * std::sqrt(std::max(0.0, 1.0 - axis[k] * axis[k]));
    box.low[k] = near[k] - extent;
    box.high[k] = near[k] + extent;
  }
  return box;
}

}  // namespace

double light_on_surface(const Point& normal) noexcept {
  const double key = dot(normal, normalized({-0.45, 0.75, 0.6}));
  return std::min(1.0, 0.7 + 0.1 * normal[1] + 0.3 * std::max(key, 0.0));
}

std::vector<SurfaceShape> shapes_of(const std::vector<Surface>& surfaces, const Box& home,
                                    std::uint32_t space) {
  const std::vector<HalfSpace> planes = half_spaces_of(surfaces);
  const PlaneCutter cutter(planes);
  const bool is_flat = space < 3;
  const double level = home.low[2] - 0.0005 * std::max({home.size()[0], home.size()[1], 1e-6});
  std::vector<SurfaceShape> shapes;
  std::size_t plane = 0;
  for (const Surface& surface : surfaces) {
    switch (surface.kind()) {
      case msg::SURFACE_PLANE:
        shapes.push_back(is_flat ? line_of(cutter, plane, planes[plane], home, level)
                                 : plane_of(cutter, plane, planes[plane], home));
        ++plane;
        break;
      case msg::SURFACE_BOX:
        shapes.push_back(is_flat ? box_section(surface, home, level) : box_of(surface, home));
        break;
      case msg::SURFACE_CYLINDER:
        shapes.push_back(is_flat ? cylinder_section(surface, home, level)
                                 : cylinder_of(surface, home));
        break;
      case msg::SURFACE_SEGMENT:
        shapes.push_back(segment_of(surface, level));
        break;
      case msg::SURFACE_HOLLOW_BOX:
        shapes.push_back(is_flat ? outline_of(box_section(surface, home, level))
                                 : hollow_of(box_of(surface, home)));
        break;
      case msg::SURFACE_HOLLOW_CYLINDER:
        shapes.push_back(is_flat ? outline_of(cylinder_section(surface, home, level))
                                 : hollow_of(cylinder_of(surface, home)));
        break;
      case msg::SURFACE_INNER_FACE:
        shapes.emplace_back();
        break;
    }
  }
  return shapes;
}

Box bounds_with(const std::vector<Surface>& surfaces, const Box& matter, std::uint32_t space) {
  Box box = matter;
  const Point middle = matter.centre();
  const double farthest = kNearDiagonals * matter.diagonal();
  const auto unite_near = [&](const Point& foot, const Box& there) {
    const Point away = foot - middle;
    if (std::sqrt(dot(away, away)) <= farthest) box = box.united(there);
  };
  for (const Surface& surface : surfaces) {
    if (surface.kind() == msg::SURFACE_INNER_FACE) continue;
    const Point centre = point_of(surface.centre_m());
    if (surface.kind() == msg::SURFACE_BOX || surface.kind() == msg::SURFACE_HOLLOW_BOX) {
      Box there = matter;
      for (std::size_t k = 0; k < space; ++k) {
        const Span span = span_of(surface, matter, k, 0.0);
        there.low[k] = span.low;
        there.high[k] = span.high;
      }
      box = box.united(there);
      continue;
    }
    if (surface.kind() == msg::SURFACE_SEGMENT) {
      for (const Point& end : ends_of(surface)) box = box.united({end, end});
      continue;
    }
    const Point axis = point_of(surface.axis());
    const double along = dot(middle - centre, axis);
    if (surface.kind() == msg::SURFACE_PLANE) {
      const Point foot = middle - along * axis;
      unite_near(foot, {foot, foot});
    } else if (surface.size_m()[1] > 0.0) {
      box = box.united(box_around(surface, centre));
    } else {
      const Point foot = centre + along * axis;
      unite_near(foot, box_around(surface, foot));
    }
  }
  for (std::size_t k = space < 3 ? 2 : 3; k < 3; ++k) {
    box.low[k] = matter.low[k];
    box.high[k] = matter.high[k];
  }
  return box;
}

}  // namespace cordis::viz
