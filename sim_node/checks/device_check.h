// sim_node/checks/device_check.h -- whether the devices of a launch file support its scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "node/config/device_limits.h"
#include "node/config/launch.h"
#include "node/config/problem.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// A device_node of a launch file, and what its device file promises.
struct LaunchedDevice {
  const config::LaunchNode* node = nullptr;
  std::string plays;  ///< name of the device
  /// Empty when the device file has faults, which the node itself reports.
  std::optional<config::DeviceLimits> limits;
};

/// All of a launch file, which outlives them.
std::vector<LaunchedDevice> launched_devices(const config::Launch& launch);

/// Age of the position that a force answers when it reaches the motor, in periods of the device.
int delay_periods_of(config::Clock clock) noexcept;

/// Holds every port of the scene against every node that may play its device: axes, rate, travel,
/// and how stiff a port the device supports.
void check_devices(const config::Launch& launch, const scene::Scene& scene,
                   config::Problems& problems);

}  // namespace cordis::sim
