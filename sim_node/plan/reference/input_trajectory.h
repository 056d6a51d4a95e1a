// sim_node/plan/reference/input_trajectory.h -- what the ports of a scene are given while it is
// tried out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// What one MAT is given from outside: positions of a port, or forces on a mass.
struct Channel {
  std::uint32_t mat = 0;
  bool is_force = false;
  /// At 0, one period, two periods, ...: a position goes straight from one to the next [m], a force
  /// is held [N]; after the last both stay.
  std::vector<engine::Vec3> value;
};

/// A gesture as a function of time alone, equal for every step.
struct InputTrajectory {
  double period = 1e-3;  ///< [s]
  std::vector<Channel> channels;
};

/// Value of a channel at a time >= 0.
engine::Vec3 value_at(const InputTrajectory& trajectory, const Channel& channel, double time);
/// Velocity of a position in one period [m/s]; 0 for a force.
engine::Vec3 velocity_in(const InputTrajectory& trajectory, const Channel& channel,
                         std::size_t period);
/// True if every channel goes on from one period to the next as it did.
bool goes_on(const InputTrajectory& trajectory, std::size_t period);

}  // namespace cordis::plan
