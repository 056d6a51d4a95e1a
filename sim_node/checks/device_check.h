// sim_node/checks/device_check.h -- whether the devices of a launch file support its scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "node/config/launch.h"
#include "node/config/problem.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// What a device of a launch file is for a port that it may play.
struct DeviceAtPort {
  std::size_t port = 0;                       ///< index in Scene::ports
  std::string node;                           ///< its name in the launch file
  int delay_periods = 0;                      ///< delay of its loop: that of the clock and its own
  bool is_supported = false;                  ///< for certain: else a problem says what is wrong
  std::optional<double> supported_stiffness;  ///< role mass; empty: nothing is known [N/m]
  std::optional<double> needed_delay_s;  ///< it is supported once its answers are measured so fast
};

/// Age of the position that a force answers when it reaches the motor, in periods of the device: 0
/// in lockstep. In real time it is measured; before that 1 is assumed.
int delay_periods_of(config::Clock clock) noexcept;

/// What a wrong name is: of the scene that a session begins with an error. A scene that is loaded later has what
/// devices there are.
enum class SceneUse { kFirst, kLater };

/// The names of the devices that nodes of the launch file play.
std::vector<std::string> played_devices(const config::Launch& launch);

/// Holds every port of the scene against every node that may play its device: axes, rate, travel,
/// and how stiff a port the device supports. A port that is too stiff for an answer a period late,
/// and not for a faster one, is a warning in real time. Until the answers are measured to be fast
/// enough the device is given no force. A node whose device file has faults reports them itself.
///
/// A port whose device no node has may wait for another program: that is a warning. Beside a required device_node
/// that no port plays it is a wrong name, an error for the first scene; likewise a `standby_for` that is nearly
/// the name of a node.
/// @return the others, port by port, in the order of the launch file
std::vector<DeviceAtPort> check_devices(const config::Launch& launch, const scene::Scene& scene,
                                        config::Problems& problems,
                                        SceneUse use = SceneUse::kLater);

}  // namespace cordis::sim
