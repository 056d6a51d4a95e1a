// viz_node/render/view_camera.cpp
#include "viz_node/render/view_camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "node/assert.h"

namespace cordis::viz {
namespace {

constexpr double kHalfField = 0.36397023426620234;  // tan 20 degrees
constexpr double kMargin = 1.12;                    // of a fitted scene, all around

Point direction_of(ViewPreset preset) noexcept {
  switch (preset) {
    case ViewPreset::kFront:
      return {0.0, 0.0, 1.0};
    case ViewPreset::kSide:
      return {1.0, 0.0, 0.0};
    case ViewPreset::kTop:
      return normalized({0.0, 1.0, 1e-4});  // not quite along the up axis
    case ViewPreset::kFree:
      break;
  }
  return normalized({0.75, 0.6, 1.0});
}

/// Half of the extent of a box along an axis [m].
double reach(const Point& half, const Point& axis) noexcept {
  return std::abs(axis[0]) * half[0] + std::abs(axis[1]) * half[1] + std::abs(axis[2]) * half[2];
}

}  // namespace

Point Box::centre() const noexcept {
  return {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])};
}

Point Box::size() const noexcept {
  return {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
}

double Box::diagonal() const noexcept {
  const Point edges = size();
  return std::sqrt(dot(edges, edges));
}

Box Box::united(const Box& other) const noexcept {
  Box both = *this;
  for (std::size_t k = 0; k < 3; ++k) {
    both.low[k] = std::min(low[k], other.low[k]);
    both.high[k] = std::max(high[k], other.high[k]);
  }
  return both;
}

ViewCamera::ViewCamera(ViewPreset preset, bool is_parallel, const Box& box, double width,
                       double height)
    : centre_(box.centre()),
      towards_(direction_of(preset)),
      half_width_(0.5 * width),
      half_height_(0.5 * height),
      is_parallel_(is_parallel) {
  CORDIS_ASSERT(width > 0.0 && height > 0.0);
  right_ = normalized(cross({0.0, 1.0, 0.0}, towards_));
  up_ = cross(towards_, right_);
  const Point size = box.size();
  const Point half = {0.5 * size[0], 0.5 * size[1], 0.5 * size[2]};
  const double extent = std::max(std::sqrt(dot(half, half)), 1e-9);
  metres_per_pixel_ = std::max({2.0 * kMargin * reach(half, right_) / width,
                                2.0 * kMargin * reach(half, up_) / height, 0.02 * extent / width});
  distance_ = metres_per_pixel_ * height / (2.0 * kHalfField) + reach(half, towards_);
}

double ViewCamera::aspect_of(ViewPreset preset, const Box& box) {
  const ViewCamera camera(preset, /*is_parallel=*/true, box, 1.0, 1.0);
  const Point size = box.size();
  const Point half = {0.5 * size[0], 0.5 * size[1], 0.5 * size[2]};
  const double least = 1e-3 * std::max(box.diagonal(), 1e-9);
  return std::max(reach(half, camera.right_), least) / std::max(reach(half, camera.up_), least);
}

Projected ViewCamera::project(const Point& point) const noexcept {
  const Point from = {point[0] - centre_[0], point[1] - centre_[1], point[2] - centre_[2]};
  const double towards = dot(from, towards_);
  double scale = 1.0 / metres_per_pixel_;
  if (!is_parallel_) {
    const double away = distance_ - towards;
    // What is nearer than a hundredth of the distance is not in view.
    if (away < 0.01 * distance_) return {};
    scale = half_height_ / (kHalfField * away);
  }
  return {half_width_ + scale * dot(from, right_), half_height_ - scale * dot(from, up_),
          towards / metres_per_pixel_, scale};
}

bool ViewCamera::is_before(const Point& at, const Point& normal) const noexcept {
  const Point to_viewer = is_parallel_ ? towards_ : centre_ + distance_ * towards_ - at;
  return dot(to_viewer, normal) > 0.0;
}

double ViewCamera::radius_of(const Projected& centre, double radius) const noexcept {
  if (is_parallel_) return radius * centre.scale;
  // In perspective the outline of a sphere is a little larger than its radius.
  const double away = half_height_ / (kHalfField * centre.scale);
  const double square = away * away - radius * radius;
  return square > 0.0 ? radius * centre.scale * away / std::sqrt(square) : radius * centre.scale;
}

}  // namespace cordis::viz
