// cli/check/scene_check.cpp
#include "cli/check/scene_check.h"

#include <cmath>
#include <utility>

#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/plan/reference/load.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::cli {
namespace {

PortCheck check_port(const scene::Scene& scene, const plan::LiaisonGraph& graph,
                     const scene::Port& port, const CheckOptions& options) {
  const plan::PortLoop loop{
      1.0 / scene.gesture_rate_hz, options.delay_periods,
      static_cast<int>(std::lround(scene.step_rate_hz / scene.gesture_rate_hz))};
  PortCheck check;
  check.port = &port;
  check.load = plan::port_load(graph, port.mat);
  if (port.role == scene::Role::kMass) {
    check.min_device_viscosity = plan::min_device_viscosity(check.load, loop);
    check.largest_stiffness =
        plan::largest_port_stiffness(options.device_viscosity, check.load.viscosity, loop);
  } else {
    check.largest_hand_stiffness =
        plan::largest_hand_stiffness(check.load, scene.network.mats[port.mat].mass, loop);
  }
  return check;
}

}  // namespace

double SceneCheck::rate_above(double rate_hz) const noexcept {
  return (std::floor(rate_hz / scene.gesture_rate_hz) + 1.0) * scene.gesture_rate_hz;
}

double SceneCheck::real_time_rate() const noexcept {
  return std::floor(1e9 / step_nsec / scene.gesture_rate_hz) * scene.gesture_rate_hz;
}

SceneCheck check_scene(const CheckOptions& options) {
  config::Problems problems;
  SceneCheck check;
  check.options = options;
  check.scene = scene::load_scene(options.scene_file, problems);
  problems.throw_if_any();
  check.scene = plan::reduce(std::move(check.scene), problems);
  problems.throw_if_any();
  if (check.scene.accuracy) {
    const scene::Accuracy& asked = *check.scene.accuracy;
    check.choice = plan::choose(
        check.scene.network, {asked.tolerance, asked.band_hz, asked.contact_energy, asked.over_s},
        check.scene.gesture_rate_hz,
        check.scene.integrator_is_open
            ? plan::integrators_for(check.scene.network)
            : std::vector<std::string>{to_string(check.scene.network.integrator)},
        !check.scene.ports.empty());
    if (check.scene.rate_is_open) {
      scene::set_step(check.scene, check.choice->rate_hz,
                      engine::integrator_named(check.choice->integrator));
    }
  }
  constexpr double kBand = 100.0;
  if (check.options.band_hz == 0.0) {
    check.options.band_hz = check.scene.accuracy ? check.scene.accuracy->band_hz : kBand;
  }
  const engine::NetworkDescription& network = check.scene.network;
  check.plan = plan::plan_of(network, check.options.band_hz);
  if (!check.scene.ports.empty()) {
    const plan::LiaisonGraph graph = plan::liaison_graph(network);
    for (const scene::Port& port : check.scene.ports) {
      check.ports.push_back(check_port(check.scene, graph, port, options));
    }
  }
  check.step_nsec = plan::measure_step_nsec(network);
  return check;
}

}  // namespace cordis::cli
