// sim_node/sim_config.cpp
#include "sim_node/sim_config.h"

#include <algorithm>
#include <optional>

#include "node/config/device_limits.h"
#include "node/config/mapping_reader.h"
#include "sim_node/scene/port_limit.h"
#include "sim_node/stability_check.h"

namespace cordis::sim {
namespace {

constexpr const char* kHowToSoften =
    "softer links at the port, or a 'coupling' between the device and a simulated tool";

/// What the device file behind a node promises; empty when it cannot be read, of which the node
/// itself tells.
std::optional<config::DeviceLimits> limits_of(const config::Launch& launch,
                                              const config::LaunchNode& device) {
  config::Problems of_the_device;
  const config::Value mapping = config::device_mapping(launch, device, of_the_device);
  config::MappingReader reader(mapping, "device", of_the_device);
  const config::DeviceLimits limits = config::read_device_limits(reader);
  if (of_the_device.has_errors()) return {};
  return limits;
}

void check_devices(const config::Launch& launch, const scene::Scene& scene,
                   config::Problems& problems) {
  for (const scene::Port& port : scene.ports) {
    const config::LaunchNode* device = launch.find(port.device);
    if (device == nullptr || device->program != "device_node") {
      std::vector<std::string> names;
      for (const auto& node : launch.nodes) {
        if (node.program == "device_node") names.push_back(node.name);
      }
      const std::string near = config::nearest_word(port.device, names);
      problems.warning(
          port.place,
          "port '" + port.name + "' wants the device '" + port.device + "', and " + launch.file +
              " has no device_node of that name: it stays at rest until one joins the session",
          near.empty() ? "" : "did you mean '" + near + "'?");
      continue;
    }
    const std::optional<config::DeviceLimits> limits = limits_of(launch, *device);
    if (!limits) continue;
    const int axis_count = limits->coordinate_count;
    const auto highest = *std::max_element(port.axes.begin(), port.axes.end());
    const std::string refusal =
        scene::refusal_of(scene, port, *limits, delay_periods_of(launch.clock));
    if (!refusal.empty()) problems.error(port.place, refusal, kHowToSoften);
    if (static_cast<int>(highest) >= axis_count) {
      problems.error(
          port.place,
          "port '" + port.name + "' wants axis " + std::to_string(highest) + " of the device '" +
              port.device + "', which has " + std::to_string(axis_count) +
              (axis_count == 1 ? " axis: 0" : " axes: 0 to " + std::to_string(axis_count - 1)));
    }
  }
}

}  // namespace

int delay_periods_of(config::Clock clock) noexcept {
  return clock == config::Clock::kLockstep ? 0 : 1;
}

SimConfig read_sim_config(const config::Launch& launch, const config::LaunchNode& node,
                          config::Problems& problems) {
  SimConfig sim;
  config::MappingReader reader(node.section, "node '" + node.name + "'", problems);
  const std::string scene_file = reader.required_text("scene");
  sim.duration_s = reader.optional_number("duration_s", 0.0, config::Range::not_negative());
  sim.force = reader.optional_truth("force", false);
  const config::Place scene_place = reader.place_of("scene");
  reader.finish();
  if (scene_file.empty()) return sim;

  sim.scene = load_checked_scene(launch, scene_file, scene_place, sim.force, problems);
  return sim;
}

scene::Scene load_checked_scene(const config::Launch& launch, const std::string& path,
                                const config::Place& referrer, bool force,
                                config::Problems& problems) {
  scene::Scene scene = scene::load_scene(launch.resolve(path).string(), problems, referrer);
  if (!problems.has_errors()) check_devices(launch, scene, problems);
  if (!problems.has_errors()) check_stability(scene, force, problems);
  return scene;
}

}  // namespace cordis::sim
