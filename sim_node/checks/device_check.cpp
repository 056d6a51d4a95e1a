// sim_node/checks/device_check.cpp
#include "sim_node/checks/device_check.h"

#include <algorithm>
#include <cmath>

#include "node/config/mapping_reader.h"
#include "node/config/nearest_word.h"
#include "sim_node/checks/port_check.h"

namespace cordis::sim {
namespace {

constexpr const char* kHowToSoften =
    "softer links at the port, or a 'coupling' between the device and a simulated tool";
constexpr const char* kHowToHaveIt = "a device that has it, or less in 'needs' of the port";
constexpr const char* kHowToCalm = "viscosity at the port, or a softer hand";

/// Warns that no node plays the device of a port.
void warn_of_nobody(const config::Launch& launch, const std::vector<LaunchedDevice>& devices,
                    const scene::Port& port, config::Problems& problems) {
  std::vector<std::string> names;
  for (const LaunchedDevice& device : devices) names.push_back(device.plays);
  const std::string near = config::nearest_word(port.device, names);
  problems.warning(
      port.place,
      "port '" + port.name + "' wants the device '" + port.device + "', and " + launch.file +
          " has no device_node of that name: it stays at rest until one joins the session",
      near.empty() ? "" : "did you mean '" + near + "'?");
}

void check_axes(const scene::Port& port, const config::DeviceLimits& limits,
                config::Problems& problems) {
  const int axis_count = limits.coordinate_count;
  const auto highest = *std::max_element(port.axes.begin(), port.axes.end());
  if (static_cast<int>(highest) < axis_count) return;
  problems.error(
      port.place,
      "port '" + port.name + "' wants axis " + std::to_string(highest) + " of the device '" +
          port.device + "', which has " + std::to_string(axis_count) +
          (axis_count == 1 ? " axis: 0" : " axes: 0 to " + std::to_string(axis_count - 1)));
}

/// A device of another rate than the scene counts on plays it in another time.
void check_rate(const scene::Port& port, const config::DeviceLimits& limits, double gesture_rate_hz,
                config::Problems& problems) {
  if (std::abs(limits.rate_hz - gesture_rate_hz) <= 1e-9 * gesture_rate_hz) return;
  problems.warning(port.place,
                   "the scene counts on " + config::number_text(gesture_rate_hz) +
                       " gestures per second, and the device '" + port.device + "' gives " +
                       config::number_text(limits.rate_hz),
                   "one rate in both: gesture_rate_hz in 'step' of the scene, rate_hz in the "
                   "device file");
}

void check_demand(const PortDemand& demand, const config::DeviceLimits& limits, int delay_periods,
                  config::Problems& problems) {
  const PortVerdict verdict = verdict_on(demand, limits, delay_periods);
  for (const std::string& lack : verdict.lacks) {
    problems.error(demand.needs.place, lack, kHowToHaveIt);
  }
  if (!verdict.refusal.empty()) problems.error(demand.place, verdict.refusal, kHowToSoften);
  const bool is_mass = demand.role == scene::Role::kMass;
  if (!verdict.uncertainty.empty()) {
    problems.warning(demand.place, verdict.uncertainty, is_mass ? kHowToSoften : kHowToCalm);
  }
}

}  // namespace

int delay_periods_of(config::Clock clock) noexcept {
  return clock == config::Clock::kLockstep ? 0 : 1;
}

std::vector<LaunchedDevice> launched_devices(const config::Launch& launch) {
  std::vector<LaunchedDevice> devices;
  for (const config::LaunchNode& node : launch.nodes) {
    if (node.program != "device_node") continue;
    config::Problems of_the_device;
    const config::Value mapping = config::device_mapping(launch, node, of_the_device);
    config::MappingReader reader(mapping, "device", of_the_device);
    LaunchedDevice device{&node, config::read_played_device(reader, node.name).name, {}};
    const config::DeviceLimits limits = config::read_device_limits(reader);
    if (!of_the_device.has_errors()) device.limits = limits;
    devices.push_back(std::move(device));
  }
  return devices;
}

void check_devices(const config::Launch& launch, const scene::Scene& scene,
                   config::Problems& problems) {
  const std::vector<LaunchedDevice> devices = launched_devices(launch);
  for (const scene::Port& port : scene.ports) {
    bool any = false;
    for (const LaunchedDevice& device : devices) {
      if (device.plays != port.device) continue;
      any = true;
      if (!device.limits) continue;
      check_axes(port, *device.limits, problems);
      check_rate(port, *device.limits, scene.gesture_rate_hz, problems);
    }
    if (!any) warn_of_nobody(launch, devices, port, problems);
  }
  for (const PortDemand& demand : demands_of(scene)) {
    for (const LaunchedDevice& device : devices) {
      if (device.plays != demand.device || !device.limits) continue;
      check_demand(demand, *device.limits, delay_periods_of(launch.clock), problems);
    }
  }
}

}  // namespace cordis::sim
