// sim_node/plan/stability/surface_bound.cpp
#include "sim_node/plan/stability/surface_bound.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "node/assert.h"

namespace cordis::plan {
namespace {

using engine::Surface;
using engine::SurfaceKind;
using engine::Vec3;

constexpr double kNoEnd = std::numeric_limits<double>::infinity();
constexpr double kSameDirection = 1e-14;  // nothing is so far away that this shows
constexpr int kMaxFrankWolfe = 400;

struct Body {
  const Surface& surface;
  const Vec3& centre;
};

bool is_box(const Surface& surface) noexcept {
  return surface.kind == SurfaceKind::kBox;
}
bool is_plane(const Surface& surface) noexcept {
  return surface.kind == SurfaceKind::kPlane;
}

/// Where a surface is nearer than the reach: what is within a margin of a convex core. An inner face has the
/// layer of its body along it, without a margin.
struct Zone {
  Zone(const Surface& of, const Vec3& place, double reach)
      : surface(of), core(of), centre(place), margin(reach) {
    switch (surface.kind) {
      case SurfaceKind::kBoxFace:
        core.kind = SurfaceKind::kBox;
        for (int axis = 0; axis < 3; ++axis) {
          if (surface.axis[axis] != 0.0) keep_layer(axis, reach);
        }
        break;
      case SurfaceKind::kCylinderEnd:
        core.kind = SurfaceKind::kCylinder;
        keep_layer(1, reach);
        break;
      case SurfaceKind::kCylinderWall:
        core.kind = SurfaceKind::kCylinder;
        margin = 0.0;
        hole = surface.half_size[0] - reach;
        break;
      default:
        break;
    }
  }

  Body body() const { return {core, centre}; }
  bool is_outside() const {
    return surface.both_sides &&
           (surface.kind == SurfaceKind::kBox || surface.kind == SurfaceKind::kCylinder);
  }

  const Surface& surface;
  Surface core;
  Vec3 centre;
  double margin = 0.0;
  /// Nearer to the axis of a cylinder than this, its round wall is out of reach [m].
  double hole = -kNoEnd;

 private:
  /// Leaves of the core what is nearer than the reach to the face at its lower end, seen along its normal.
  void keep_layer(int size_index, double reach) {
    double& half = core.half_size[size_index];
    const double layer = std::min(0.5 * reach, half);
    centre -= (half - layer) * surface.axis;
    half = layer;
    margin = 0.0;
  }
};

/// Directions along which a distance does not count: beyond the dimension, and without an end.
class CountedDirections {
 public:
  explicit CountedDirections(int dimension) {
    for (int axis = dimension; axis < 3; ++axis) take_out(Vec3::Unit(axis));
  }
  void take_out(const Vec3& direction) {
    const Vec3 left = *this * direction;
    if (left.norm() < kSameDirection) return;
    const Vec3 unit = left.normalized();
    keeps_ -= unit * unit.transpose();
  }
  void take_out_endless(const Surface& surface) {
    if (surface.kind == SurfaceKind::kSegment) return;
    if (!is_box(surface)) {
      if (surface.half_size[1] == kNoEnd) take_out(surface.axis);
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (surface.half_size[axis] == kNoEnd) take_out(Vec3::Unit(axis));
    }
  }
  Vec3 operator*(const Vec3& vector) const { return keeps_ * vector; }

 private:
  Eigen::Matrix3d keeps_ = Eigen::Matrix3d::Identity();
};

/// The farthest point of a box, cylinder or segment along a direction across all in which it has no end.
Vec3 farthest(const Body& body, const Vec3& direction) {
  const Vec3& size = body.surface.half_size;
  Vec3 point = body.centre;
  if (body.surface.kind == SurfaceKind::kBox) {
    for (int axis = 0; axis < 3; ++axis) {
      if (size[axis] < kNoEnd) point[axis] += direction[axis] < 0.0 ? -size[axis] : size[axis];
    }
    return point;
  }
  const Vec3& axis = body.surface.axis;
  const double along = axis.dot(direction);
  if (body.surface.kind == SurfaceKind::kSegment)
    return point + (along < 0.0 ? -size[0] : size[0]) * axis;
  if (size[1] < kNoEnd) point += (along < 0.0 ? -size[1] : size[1]) * axis;
  const Vec3 radial = direction - along * axis;
  const double length = radial.norm();
  if (length > kSameDirection * direction.norm()) point += size[0] / length * radial;
  return point;
}

/// True if two convex bodies may be nearer than this. Frank and Wolfe's iteration brings the nearest
/// points together; the plane across their line bounds the distance from below.
bool may_be_nearer(const Body& a, const Body& b, double distance, int dimension) {
  CountedDirections project(dimension);
  project.take_out_endless(a.surface);
  project.take_out_endless(b.surface);
  Vec3 apart = project * (b.centre - a.centre);
  for (int round = 0; round < kMaxFrankWolfe; ++round) {
    const double length = apart.norm();
    if (length < distance) return true;
    const Vec3 nearer = project * (farthest(b, -apart) - farthest(a, apart));
    if (nearer.dot(apart) >= distance * length) return false;
    const Vec3 way = nearer - apart;
    const double square = way.squaredNorm();
    if (!(square > 0.0)) break;
    apart += std::clamp(-apart.dot(way) / square, 0.0, 1.0) * way;
  }
  return true;
}

/// Heights of a body over a plane.
struct Heights {
  double lowest;
  double highest;
};

Heights heights_over(const Body& plane, const Body& body) {
  const Vec3& normal = plane.surface.axis;
  const Vec3& size = body.surface.half_size;
  double half = 0.0;
  const auto add = [&half](double extent, double share) {
    if (share > kSameDirection) half += extent * share;
  };
  if (body.surface.kind == SurfaceKind::kBox) {
    for (int axis = 0; axis < 3; ++axis) add(size[axis], std::abs(normal[axis]));
  } else if (body.surface.kind == SurfaceKind::kSegment) {
    add(size[0], std::abs(normal.dot(body.surface.axis)));
  } else {
    const double along = std::abs(normal.dot(body.surface.axis));
    add(size[1], along);
    add(size[0], std::sqrt(std::max(0.0, 1.0 - along * along)));
  }
  const double middle = normal.dot(body.centre - plane.centre);
  return {middle - half, middle + half};
}

bool planes_meet(const Body& a, const Body& b, double reach) {
  const double cosine = a.surface.axis.dot(b.surface.axis);
  if ((b.surface.axis - cosine * a.surface.axis).norm() > kSameDirection) return true;
  const double height = a.surface.axis.dot(b.centre - a.centre);  // of b
  const auto slab = [reach](bool both_sides, bool upwards, double middle) {
    return Heights{both_sides || !upwards ? middle - reach : -kNoEnd,
                   both_sides || upwards ? middle + reach : kNoEnd};
  };
  const Heights of_a = slab(a.surface.both_sides, true, 0.0);
  const Heights of_b = slab(b.surface.both_sides, cosine > 0.0, height);
  return std::max(of_a.lowest, of_b.lowest) < std::min(of_a.highest, of_b.highest);
}

/// The farthest that a point of a body may be from the axis of a cylinder, exact for what is along it [m].
double farthest_from_axis(const Body& cylinder, const Body& body) {
  const Vec3& axis = cylinder.surface.axis;
  const Vec3& size = body.surface.half_size;
  const auto across = [&axis](const Vec3& vector) {
    return Vec3(vector - axis.dot(vector) * axis);
  };
  const Vec3 middle = across(body.centre - cylinder.centre);
  if (is_plane(body.surface)) return kNoEnd;
  double farthest = 0.0;
  if (!is_box(body.surface)) {
    const bool is_round = body.surface.kind != SurfaceKind::kSegment;
    const double half = is_round ? size[1] : size[0];
    const Vec3 along = across(body.surface.axis);
    const bool is_parallel = along.norm() < kSameDirection;
    if (!is_parallel && half == kNoEnd) return kNoEnd;
    for (const double end : {-1.0, 1.0}) {
      const Vec3 place = is_parallel ? middle : Vec3(middle + end * half * along);
      farthest = std::max(farthest, place.norm());
    }
    return farthest + (is_round ? size[0] : 0.0);
  }
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 place = middle;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = across(Vec3::Unit(k));
      if (edge.norm() < kSameDirection) continue;
      if (size[k] == kNoEnd) return kNoEnd;
      place += (corner >> k & 1) != 0 ? Vec3(size[k] * edge) : Vec3(-size[k] * edge);
    }
    farthest = std::max(farthest, place.norm());
  }
  return farthest;
}

/// True if all of a zone is inside of a body, where its outside does not act.
bool is_within(const Zone& zone, const Zone& body) {
  constexpr double kRounding = 1e-12;
  if (is_plane(zone.surface)) return false;
  const auto fits = [&](double extent, double half) {
    return extent + zone.margin <= half * (1.0 + kRounding);
  };
  const auto fits_along = [&](const Vec3& axis, double half) {
    Surface across;
    across.axis = axis;
    if (half == kNoEnd) return true;
    const Heights heights = heights_over({across, body.centre}, zone.body());
    return fits(std::max(heights.highest, -heights.lowest), half);
  };
  const Vec3& size = body.core.half_size;
  if (is_box(body.core)) {
    return fits_along(Vec3::UnitX(), size[0]) && fits_along(Vec3::UnitY(), size[1]) &&
           fits_along(Vec3::UnitZ(), size[2]);
  }
  return fits_along(body.core.axis, size[1]) &&
         fits(farthest_from_axis(body.body(), zone.body()), size[0]);
}

/// True if the cores and the margins of two zones may have a place in common.
bool may_overlap(const Zone& a, const Zone& b, int dimension) {
  constexpr double kOverlap = 1e-12;  // of the sizes: of two layers without margins
  const double margin = a.margin + b.margin;
  if (!is_plane(a.surface) && !is_plane(b.surface)) {
    const bool are_boxes = is_box(a.core) && is_box(b.core);
    const Vec3 gap = (b.centre - a.centre).cwiseAbs() - a.core.half_size - b.core.half_size;
    if (are_boxes) return margin > 0.0 ? gap.cwiseMax(0.0).norm() < margin : gap.maxCoeff() < 0.0;
    const double least = kOverlap * (a.core.half_size[0] + b.core.half_size[0]);
    return may_be_nearer(a.body(), b.body(), std::max(margin, least), dimension);
  }
  const Zone& plane = is_plane(a.surface) ? a : b;
  const Heights heights = heights_over(plane.body(), (is_plane(a.surface) ? b : a).body());
  return heights.lowest < margin && (!plane.surface.both_sides || heights.highest > -margin);
}

/// True if a place may be nearer to both than the reach.
bool share_a_place(const Body& of_a, const Body& of_b, double reach, int dimension) {
  if (is_plane(of_a.surface) && is_plane(of_b.surface)) return planes_meet(of_a, of_b, reach);
  const Zone a(of_a.surface, of_a.centre, reach);
  const Zone b(of_b.surface, of_b.centre, reach);
  if ((a.is_outside() && is_within(b, a)) || (b.is_outside() && is_within(a, b))) return false;
  const auto is_in_hole = [](const Zone& wall, const Zone& other) {
    return wall.hole > 0.0 &&
           farthest_from_axis(wall.body(), other.body()) + other.margin <= wall.hole;
  };
  return !is_in_hole(a, b) && !is_in_hole(b, a) && may_overlap(a, b, dimension);
}

/// What is within the reach of a surface lies between these along the axes [m].
struct Extent {
  Vec3 low = Vec3::Constant(-kNoEnd);
  Vec3 high = Vec3::Constant(kNoEnd);

  bool meets(const Extent& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

Extent extent_of(const Body& body, double reach) {
  constexpr double kSlack = 1e-9;  // of coordinates: more than they are rounded by
  Extent extent;
  if (is_plane(body.surface)) return extent;
  const Zone zone(body.surface, body.centre, reach);
  for (int axis = 0; axis < 3; ++axis) {
    Surface across;
    across.axis = Vec3::Unit(axis);
    const Heights heights = heights_over({across, Vec3::Zero()}, zone.body());
    extent.low[axis] = heights.lowest - zone.margin - kSlack * std::abs(heights.lowest);
    extent.high[axis] = heights.highest + zone.margin + kSlack * std::abs(heights.highest);
  }
  return extent;
}

/// Which of so many things are in a set, 64 in each word.
using Bits = std::vector<std::uint64_t>;

/// A graph by the others that each is joined to.
class JoinedBits {
 public:
  static constexpr std::size_t kBits = 64;

  explicit JoinedBits(std::size_t count) : words_((count + kBits - 1) / kBits), rows_(count) {
    for (Bits& row : rows_) row.resize(words_, 0);
  }
  void join(std::size_t a, std::size_t b) {
    rows_[a][b / kBits] |= std::uint64_t{1} << (b % kBits);
    rows_[b][a / kBits] |= std::uint64_t{1} << (a % kBits);
  }
  std::size_t count() const { return rows_.size(); }
  const Bits& row(std::size_t a) const { return rows_[a]; }
  Bits all() const {
    Bits bits(words_, 0);
    for (std::size_t i = 0; i < count(); ++i) bits[i / kBits] |= std::uint64_t{1} << (i % kBits);
    return bits;
  }
  static std::size_t size_of(const Bits& bits) {
    std::size_t size = 0;
    for (const std::uint64_t word : bits) size += static_cast<std::size_t>(std::popcount(word));
    return size;
  }

 private:
  std::size_t words_;
  std::vector<Bits> rows_;
};

/// The largest group of a graph whose members are all joined to each other.
class LargestGroup {
 public:
  explicit LargestGroup(JoinedBits joined) : joined_(std::move(joined)) {
    extend(joined_.all(), 0);
  }
  /// Where the search took too long, the most that any one is joined to.
  std::size_t size() const {
    if (work_ < kMaxWork) return largest_;
    std::size_t most = 0;
    for (std::size_t i = 0; i < joined_.count(); ++i)
      most = std::max(most, JoinedBits::size_of(joined_.row(i)) + 1);
    return most;
  }

 private:
  static constexpr std::size_t kMaxWork = 20'000'000;  // words

  /// @param left  candidates, of which each that has been looked at is taken out
  void extend(Bits left, std::size_t size) {
    largest_ = std::max(largest_, size);
    std::size_t count = JoinedBits::size_of(left);
    for (std::size_t word = 0; word < left.size(); ++word) {
      while (left[word] != 0) {
        if (size + count <= largest_ || work_ >= kMaxWork) return;
        const auto bit = static_cast<std::size_t>(std::countr_zero(left[word]));
        left[word] &= left[word] - 1;
        --count;
        const Bits& row = joined_.row(JoinedBits::kBits * word + bit);
        Bits both = left;
        for (std::size_t i = word; i < both.size(); ++i) both[i] &= row[i];
        work_ += both.size();
        extend(std::move(both), size + 1);
      }
    }
  }

  JoinedBits joined_;
  std::size_t largest_ = 0;
  std::size_t work_ = 0;
};

}  // namespace

double max_surfaces_in_reach(const std::vector<Surface>& surfaces, const std::vector<Vec3>& centres,
                             double reach, int dimension, const std::vector<std::size_t>& group) {
  CORDIS_ASSERT(group.empty() || group.size() == surfaces.size());
  const std::size_t count = surfaces.size();
  std::vector<Extent> extents;
  for (std::size_t i = 0; i < count; ++i)
    extents.push_back(extent_of({surfaces[i], centres[i]}, reach));
  JoinedBits joined(count);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      const bool may_meet = !group.empty() && group[a] != group[b];
      if (!may_meet && !extents[a].meets(extents[b])) continue;
      if (may_meet ||
          share_a_place({surfaces[a], centres[a]}, {surfaces[b], centres[b]}, reach, dimension))
        joined.join(a, b);
    }
  }
  return static_cast<double>(LargestGroup(std::move(joined)).size());
}

}  // namespace cordis::plan
