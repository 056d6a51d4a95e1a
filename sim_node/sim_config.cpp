// sim_node/sim_config.cpp
#include "sim_node/sim_config.h"

#include <algorithm>

#include "node/config/mapping_reader.h"

namespace cordis::sim {
namespace {

/// Number of axes of a device of the launch file, from its section or its device file; 0 when
/// neither tells (then its own device_node will complain).
long axis_count_of(const config::Launch& launch, const config::LaunchNode& device) {
  config::Problems of_the_device;  // told by the device_node itself
  config::Value axes = device.section.find("axes");
  const config::Value file = device.section.find("device");
  if (!axes.exists() && file.exists()) {
    axes = config::load_file(launch.resolve(file.text()).string(), of_the_device).find("axes");
  }
  if (!axes.exists()) return 0;
  return static_cast<long>(
      config::read_number(axes, "axes", 0.0, config::Range::between(1, 16), of_the_device));
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
    const long axis_count = axis_count_of(launch, *device);
    const auto highest = *std::max_element(port.axes.begin(), port.axes.end());
    if (axis_count > 0 && static_cast<long>(highest) >= axis_count) {
      problems.error(
          port.place,
          "port '" + port.name + "' wants axis " + std::to_string(highest) + " of the device '" +
              port.device + "', which has " + std::to_string(axis_count) +
              (axis_count == 1 ? " axis: 0" : " axes: 0 to " + std::to_string(axis_count - 1)));
    }
  }
}

}  // namespace

SimConfig read_sim_config(const config::Launch& launch, const config::LaunchNode& node,
                          config::Problems& problems) {
  SimConfig sim;
  config::MappingReader reader(node.section, "node '" + node.name + "'", problems);
  const std::string scene_file = reader.required_text("scene");
  sim.duration_s = reader.optional_number("duration_s", 0.0, config::Range::not_negative());
  const config::Place scene_place = reader.place_of("scene");
  reader.finish();
  if (scene_file.empty()) return sim;

  sim.scene = load_checked_scene(launch, scene_file, scene_place, problems);
  return sim;
}

scene::Scene load_checked_scene(const config::Launch& launch, const std::string& path,
                                const config::Place& referrer, config::Problems& problems) {
  scene::Scene scene = scene::load_scene(launch.resolve(path).string(), problems, referrer);
  if (!problems.has_errors()) check_devices(launch, scene, problems);
  return scene;
}

}  // namespace cordis::sim
