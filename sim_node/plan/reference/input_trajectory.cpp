// sim_node/plan/reference/input_trajectory.cpp
#include "sim_node/plan/reference/input_trajectory.h"

#include <algorithm>
#include <cmath>

#include "node/assert.h"

namespace cordis::plan {
namespace {

using engine::Vec3;

const Vec3& entry(const Channel& channel, std::size_t index) {
  return channel.value[std::min(index, channel.value.size() - 1)];
}

}  // namespace

Vec3 value_at(const InputTrajectory& trajectory, const Channel& channel, double time) {
  CORDIS_ASSERT(time >= 0.0);
  constexpr double kRounding = 1e-9;  // of a period
  const double periods = time / trajectory.period + kRounding;
  const double whole = std::floor(periods);
  const auto index = static_cast<std::size_t>(whole);
  const Vec3& from = entry(channel, index);
  if (channel.is_force) return from;
  return from + (periods - whole) * (entry(channel, index + 1) - from);
}

Vec3 velocity_in(const InputTrajectory& trajectory, const Channel& channel, std::size_t period) {
  if (channel.is_force) return Vec3::Zero();
  return (entry(channel, period + 1) - entry(channel, period)) / trajectory.period;
}

bool goes_on(const InputTrajectory& trajectory, std::size_t period) {
  if (period == 0) return false;
  return std::all_of(trajectory.channels.begin(), trajectory.channels.end(),
                     [&](const Channel& channel) {
                       if (channel.is_force)
                         return entry(channel, period) == entry(channel, period - 1);
                       return velocity_in(trajectory, channel, period) ==
                              velocity_in(trajectory, channel, period - 1);
                     });
}

}  // namespace cordis::plan
