// cli/check/scene_check.cpp
#include "cli/check/scene_check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "cli/command_line.h"
#include "node/config/file_kind.h"
#include "sim_node/checks/planned_scene.h"
#include "sim_node/checks/port_body.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/plan/reference/load.h"
#include "sim_node/plan/reference/trial_run.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "sim_node/sim_config.h"

namespace cordis::cli {
namespace {

PortCheck check_port(const SceneCheck& check, const plan::LiaisonGraph& graph,
                     const scene::Port& port, std::vector<sim::DeviceAtPort> devices) {
  const scene::Scene& scene = check.scene;
  PortCheck result;
  result.port = &port;
  result.delay_periods = check.delay_periods;
  for (const sim::DeviceAtPort& device : devices)
    result.delay_periods = std::max(result.delay_periods, device.delay_periods);
  result.devices = std::move(devices);
  const plan::PortLoop loop{
      1.0 / scene.gesture_rate_hz, static_cast<double>(result.delay_periods),
      static_cast<int>(std::lround(scene.step_rate_hz / scene.gesture_rate_hz))};
  result.load = sim::max_load_of(graph, scene, port);
  if (port.role == scene::Role::kMass) {
    result.min_device_viscosity = plan::min_device_viscosity(result.load, loop);
  } else {
    // The most limits the step, and what damps for certain the delay.
    const double mass = sim::mass_of(scene, port);
    result.largest_hand_stiffness =
        std::min(plan::largest_hand_stiffness(result.load, mass, loop),
                 plan::largest_hand_stiffness(sim::min_load_of(graph, scene, port), mass, loop));
  }
  return result;
}

/// The launch file of these options, as far as it can be read; empty when their file is a scene.
/// What is wrong with it goes to `problems`, but for a file that is no YAML, which throws.
std::optional<config::Launch> launch_of(const CheckOptions& options, config::Problems& problems) {
  const bool is_launch = options.text ? config::is_launch_text(*options.text, options.file)
                                      : config::is_launch_file(options.file);
  if (!is_launch) {
    if (!options.overrides.empty())
      throw UsageError("'" + options.overrides[0] + "' changes a launch file, and " + options.file +
                       " is a scene");
    return {};
  }
  config::Launch launch =
      options.text
          ? config::load_launch_text(*options.text, options.file, options.overrides, problems)
          : config::load_launch(options.file, options.overrides, problems);
  config::check_domain(launch, problems);
  return launch;
}

const config::LaunchNode& sim_node_of(const config::Launch& launch,
                                      const config::Problems& problems) {
  const auto found =
      std::find_if(launch.nodes.begin(), launch.nodes.end(),
                   [](const config::LaunchNode& node) { return node.program == "sim_node"; });
  if (found == launch.nodes.end()) problems.throw_if_any();
  if (found == launch.nodes.end())
    throw std::runtime_error(launch.file + " has no sim_node, whose scene could be checked");
  return *found;
}

}  // namespace

double SceneCheck::real_time_rate() const noexcept {
  return std::floor(1e9 / step_nsec / scene.gesture_rate_hz) * scene.gesture_rate_hz;
}

SceneCheck check_scene(const CheckOptions& options) {
  SceneCheck check;
  check.options = options;
  check.launch = launch_of(options, check.problems);
  const std::optional<config::Launch>& launch = check.launch;
  std::string scene_file = options.file;
  config::Place referrer;
  bool force = options.force;
  if (launch) {
    const sim::SimSection section =
        sim::read_sim_section(sim_node_of(*launch, check.problems), check.problems);
    if (section.scene_file.empty()) check.problems.throw_if_any();
    scene_file = launch->resolve(section.scene_file).string();
    referrer = section.scene_place;
    force = force || section.force;
    check.delay_periods = sim::delay_periods_of(launch->clock);
  }
  sim::PlannedScene planned =
      options.text && !launch
          ? sim::plan_scene(scene::load_scene_text(*options.text, scene_file, check.problems),
                            check.problems)
          : sim::plan_scene(scene_file, referrer, check.problems);
  check.problems.throw_if_any();
  check.scene = std::move(planned.scene);
  check.choice = std::move(planned.rate);
  std::vector<std::vector<sim::DeviceAtPort>> devices(check.scene.ports.size());
  if (launch) {
    for (sim::DeviceAtPort& device :
         sim::check_devices(*launch, check.scene, check.problems, sim::SceneUse::kFirst))
      devices[device.port].push_back(std::move(device));
  }
  constexpr double kBand = 100.0;
  if (check.options.band_hz == 0.0) {
    check.options.band_hz = check.scene.accuracy ? check.scene.accuracy->band_hz : kBand;
  }
  const engine::NetworkDescription& network = check.scene.network;
  check.plan = plan::plan_of(network, check.options.band_hz);
  sim::check_stability(check.scene, check.plan.stability, force, check.problems);
  if (!check.scene.ports.empty()) {
    const plan::LiaisonGraph graph = plan::liaison_graph(network);
    for (std::size_t port = 0; port < devices.size(); ++port) {
      check.ports.push_back(
          check_port(check, graph, check.scene.ports[port], std::move(devices[port])));
    }
  }
  if (options.plan_alone) return check;
  const plan::StepLoad load = plan::measure_steps(network);
  check.step_nsec = load.median_nsec;
  check.worst_step_nsec = load.worst_nsec;
  check.measured_steps = load.step_count;
  return check;
}

}  // namespace cordis::cli
