// sim_node/sim_config.cpp
#include "sim_node/sim_config.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include "node/config/device_limits.h"
#include "node/config/mapping_reader.h"
#include "node/config/regular_file.h"
#include "sim_node/checks/port_check.h"
#include "sim_node/checks/rate_choice.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/plan/reduction/reduce.h"

namespace cordis::sim {
namespace {

constexpr const char* kHowToSoften =
    "softer links at the port, or a 'coupling' between the device and a simulated tool";
constexpr const char* kHowToHaveIt = "a device that has it, or less in 'needs' of the port";
constexpr std::size_t kMaxSceneBytes = std::size_t{16} << 20;
constexpr const char* kHowToCalm = "viscosity at the port, or a softer hand";

/// A device_node of the launch, and what its device file promises.
struct LaunchedDevice {
  const config::LaunchNode* node = nullptr;
  std::string plays;                           // name of the device
  std::optional<config::DeviceLimits> limits;  // empty when the file cannot be read, of which the
                                               // node itself tells
};

std::vector<LaunchedDevice> devices_of(const config::Launch& launch) {
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

/// Every port against every node that may play its device.
void check_devices(const config::Launch& launch, const scene::Scene& scene,
                   config::Problems& problems) {
  const std::vector<LaunchedDevice> devices = devices_of(launch);
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

/// Where the launch file lies, links and `..` resolved; empty when it is no longer there.
std::filesystem::path folder_of(const config::Launch& launch) {
  std::error_code failure;
  return std::filesystem::canonical(std::filesystem::absolute(launch.file).parent_path(), failure);
}

/// The file of a path as it lies below a folder; empty when it does not. The folder is resolved.
std::filesystem::path below(const std::filesystem::path& folder, const std::string& path) {
  std::error_code failure;
  const std::filesystem::path file = std::filesystem::weakly_canonical(folder / path, failure);
  if (failure || folder.empty()) return {};
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && rest != file.end() ? file : std::filesystem::path();
}

/// True if a file says that it is written for Cordis, or cannot be read, which the reader tells.
/// What is wrong in another file would tell what stands in it.
bool is_of_cordis(const std::filesystem::path& file) {
  const config::FileBytes read = config::read_regular_file(file.string(), kMaxSceneBytes);
  if (!read.reason.empty()) return true;
  constexpr std::string_view kMark = "cordis:";
  for (std::size_t at = read.bytes.find(kMark); at != std::string::npos;
       at = read.bytes.find(kMark, at + 1)) {
    if (at == 0 || read.bytes[at - 1] == '\n') return true;
  }
  return false;
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
  if (!problems.has_errors()) scene = plan::reduce(std::move(scene), problems);
  if (!problems.has_errors()) select_rate(scene, problems);
  if (!problems.has_errors()) check_devices(launch, scene, problems);
  if (!problems.has_errors()) check_stability(scene, force, problems);
  return scene;
}

scene::Scene load_next_scene(const config::Launch& launch, const std::string& path, bool force,
                             config::Problems& problems) {
  const std::filesystem::path folder = folder_of(launch);
  const std::filesystem::path file = below(folder, path);
  if (file.empty()) {
    problems.error({},
                   "'" + path + "' is not below '" + folder.string() +
                       "', the folder of the launch file, from where alone scenes are loaded",
                   "start the session with it: sim.scene=" + path);
    return {};
  }
  std::error_code unknown;
  if (!std::filesystem::exists(file.parent_path(), unknown)) {
    problems.error({}, "there is no such file, neither where `cordis ctl` was called nor in '" +
                           folder.string() + "', the folder of the launch file");
    return {};
  }
  if (!is_of_cordis(file)) {
    problems.error({path, 0, 0}, "this is no scene: it has no line that begins with 'cordis: 1'");
    return {};
  }
  return load_checked_scene(launch, file.string(), {}, force, problems);
}

}  // namespace cordis::sim
