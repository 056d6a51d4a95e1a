// sim_node/plan/stability/surface_bound.cpp
#include "sim_node/plan/stability/surface_bound.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

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
    if (surface.kind == SurfaceKind::kCylinder) {
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

/// True if a place may be nearer to both than the reach.
bool share_a_place(const Body& a, const Body& b, double reach, int dimension) {
  const bool a_is_plane = a.surface.kind == SurfaceKind::kPlane;
  const bool b_is_plane = b.surface.kind == SurfaceKind::kPlane;
  if (a_is_plane && b_is_plane) return planes_meet(a, b, reach);
  if (!a_is_plane && !b_is_plane) {
    if (a.surface.kind != SurfaceKind::kBox || b.surface.kind != SurfaceKind::kBox)
      return may_be_nearer(a, b, 2.0 * reach, dimension);
    const Vec3 gap = (b.centre - a.centre).cwiseAbs() - a.surface.half_size - b.surface.half_size;
    return gap.cwiseMax(0.0).norm() < 2.0 * reach;
  }
  const Body& plane = a_is_plane ? a : b;
  const Heights heights = heights_over(plane, a_is_plane ? b : a);
  return heights.lowest < 2.0 * reach &&
         (!plane.surface.both_sides || heights.highest > -2.0 * reach);
}

/// The largest group of a graph whose members are all joined to each other.
class LargestGroup {
 public:
  explicit LargestGroup(std::vector<std::vector<bool>> joined) : joined_(std::move(joined)) {
    std::vector<std::size_t> all(joined_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    extend(all, 0);
  }
  /// Where the search took too long, the most that any one is joined to.
  std::size_t size() const {
    if (work_ < kMaxWork) return largest_;
    std::size_t most = 0;
    for (const std::vector<bool>& row : joined_) {
      most = std::max(most, static_cast<std::size_t>(std::count(row.begin(), row.end(), true)) + 1);
    }
    return most;
  }

 private:
  static constexpr std::size_t kMaxWork = 20'000'000;

  void extend(const std::vector<std::size_t>& candidates, std::size_t size) {
    largest_ = std::max(largest_, size);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (size + candidates.size() - i <= largest_ || work_ >= kMaxWork) return;
      std::vector<std::size_t> left;
      for (std::size_t j = i + 1; j < candidates.size(); ++j) {
        if (joined_[candidates[i]][candidates[j]]) left.push_back(candidates[j]);
      }
      work_ += candidates.size() - i;
      extend(left, size + 1);
    }
  }

  std::vector<std::vector<bool>> joined_;
  std::size_t largest_ = 0;
  std::size_t work_ = 0;
};

}  // namespace

double max_surfaces_in_reach(const std::vector<Surface>& surfaces, const std::vector<Vec3>& centres,
                             double reach, int dimension, const std::vector<std::size_t>& group) {
  CORDIS_ASSERT(group.empty() || group.size() == surfaces.size());
  const std::size_t count = surfaces.size();
  std::vector<std::vector<bool>> joined(count, std::vector<bool>(count, false));
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      const bool together =
          (!group.empty() && group[a] != group[b]) ||
          share_a_place({surfaces[a], centres[a]}, {surfaces[b], centres[b]}, reach, dimension);
      joined[a][b] = joined[b][a] = together;
    }
  }
  return static_cast<double>(LargestGroup(std::move(joined)).size());
}

}  // namespace cordis::plan
