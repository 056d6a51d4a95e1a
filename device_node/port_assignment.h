// device_node/port_assignment.h -- the part that a scene gives to a device.
#pragma once

#include <string>

#include "device_node/device_config.h"
#include "idl/scene.h"

namespace cordis::device {

/// What the ports of a scene need of one device.
struct PortAssignment {
  bool wanted = false;       ///< the scene has a port for the device
  Role role = Role::kMass;   ///< in all its ports
  std::string impossible;    ///< why the device cannot play it, one sentence; empty when it can
  std::string questionable;  ///< what a person should know though it can; empty when nothing
};

/// Finds the ports with the device's id in a scene, and compares them with what the device has.
PortAssignment part_of(const msg::SceneDescription& scene, const DeviceConfig& device,
                       const Driver& driver);

}  // namespace cordis::device
