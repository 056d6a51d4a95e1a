// sim_node/plan/reference/input_trajectory.cpp
#include "sim_node/plan/reference/input_trajectory.h"

#include <algorithm>
#include <cmath>

namespace cordis::plan {
namespace {

using engine::Vec3;

const Vec3& entry(const Channel& track, std::size_t index) {
  return track.value[std::min(index, track.value.size() - 1)];
}

}  // namespace

Vec3 value_at(const InputTrajectory& course, const Channel& track, double time) {
  constexpr double kRounding = 1e-9;  // of a period
  const double periods = time / course.period + kRounding;
  const double whole = std::floor(periods);
  const auto index = static_cast<std::size_t>(whole);
  const Vec3& from = entry(track, index);
  if (track.is_force) return from;
  return from + (periods - whole) * (entry(track, index + 1) - from);
}

Vec3 velocity_in(const InputTrajectory& course, const Channel& track, std::size_t period) {
  if (track.is_force) return Vec3::Zero();
  return (entry(track, period + 1) - entry(track, period)) / course.period;
}

bool goes_on(const InputTrajectory& course, std::size_t period) {
  if (period == 0) return false;
  return std::all_of(course.tracks.begin(), course.tracks.end(), [&](const Channel& track) {
    if (track.is_force) return entry(track, period) == entry(track, period - 1);
    return velocity_in(course, track, period) == velocity_in(course, track, period - 1);
  });
}

}  // namespace cordis::plan
