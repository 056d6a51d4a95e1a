// device_node/device_config.h -- a device as its file describes it.
#pragma once

#include <memory>
#include <string>

#include "device_node/axis.h"
#include "device_node/drivers/driver.h"
#include "device_node/end_effector_map.h"
#include "device_node/force_guard.h"
#include "device_node/position_guard.h"
#include "device_node/traced_driver.h"
#include "idl/gesture.h"
#include "node/config/device_limits.h"
#include "node/config/launch.h"

namespace cordis::device {

/// What every device has, whoever drives it.
struct DeviceConfig {
  std::string name;  ///< what ports of a scene refer to: the node's name, or the device it is
                     ///< `standby_for`
  std::uint32_t device_id = 0;  ///< hash of the name
  int strength = 10;            ///< among the nodes that play this device
  config::DeviceLimits limits;  ///< as the file declares them, and as they are published
  AxisLayout layout;
  EndEffectorMap end_effector_map;       ///< between the axes and the coordinates on the wire
  ForceGuardSettings force_guard;        ///< applies in role mass
  PositionGuardSettings position_guard;  ///< applies in role liaison
  TraceSettings trace;
  std::string driver;  ///< its name in the driver table
};

/// What the device says of itself on the wire, but for its epoch and the roles that its driver has.
msg::DeviceDescription description_of(const DeviceConfig& config);

/// In words: how many axes or keys, how wide a keyboard is, and who drives it.
std::string what_it_is(const DeviceConfig& config);

/// A device ready to run.
struct LoadedDevice {
  DeviceConfig config;
  std::unique_ptr<Driver> driver;
};

/// Reads a device from its mapping, and builds its driver. The mappings of all drivers in it are
/// checked, not only that of the driver in use.
/// @param node  name of the node
/// @throws config::ConfigError with everything that is wrong.
LoadedDevice read_device(const config::Value& mapping, const std::string& node,
                         config::Problems& problems);

/// The device of a node: the device file that its section names (`device: FILE`), with the other
/// keys of the section laid on it.
/// @throws config::ConfigError with everything that is wrong.
LoadedDevice load_device(const config::Launch& launch, const config::LaunchNode& node,
                         config::Problems& problems);

}  // namespace cordis::device
