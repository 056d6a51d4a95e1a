// sim_node/port_check.cpp
#include "sim_node/port_check.h"

#include <cmath>

#include "node/config/mapping_reader.h"

namespace cordis::sim {
namespace {

using config::number_text;

constexpr double kFingertip = 2000.0;  // stiffness of one that presses [N/m]

/// What a device bears at a port, and why. [N/m]
struct Bearable {
  double stiffness = 0.0;  // 0: nothing is known
  std::string reason;
};

Bearable bearable_by(const config::DeviceLimits& limits, double port_viscosity, int delay_periods) {
  if (limits.stiffness_limit_n_per_m > 0.0) return {limits.stiffness_limit_n_per_m, "declares it"};
  if (limits.viscosity_n_s_per_m <= 0.0) return {};
  const plan::PortLoop loop{1.0 / limits.rate_hz, delay_periods + limits.delay_periods};
  const plan::PortDevice device{limits.coordinate_mass_kg(),
                                limits.coordinate_viscosity_n_s_per_m()};
  return {std::max(plan::stable_port_stiffness(device, port_viscosity, loop), 1e-9),
          "with " + number_text(device.mass) + " kg, " + number_text(device.viscosity) +
              " N s/m and a delay of " + std::to_string(loop.delay) + " periods of " +
              number_text(loop.period) + " s"};
}

/// Empty when the device bears the load.
std::string trouble(const PortDemand& demand, const plan::PortLoad& load, const std::string& is,
                    const config::DeviceLimits& limits, int delay_periods) {
  const std::string port = "port '" + demand.port + "' " + is;
  const std::string device = ", and the device '" + demand.device + "' can bear ";
  const Bearable bearable = bearable_by(limits, load.viscosity, delay_periods);
  if (bearable.stiffness > 0.0 && load.stiffness > bearable.stiffness) {
    return port + " as stiff as " + number_text(std::ceil(load.stiffness)) + " N/m" + device +
           number_text(std::floor(bearable.stiffness)) + " N/m (" + bearable.reason + ")";
  }
  if (limits.damping_limit_n_s_per_m > 0.0 && load.viscosity > limits.damping_limit_n_s_per_m) {
    return port + " as viscous as " + number_text(load.viscosity) + " N s/m" + device +
           number_text(limits.damping_limit_n_s_per_m) + " N s/m (declares it)";
  }
  return {};
}

/// Empty when a fingertip on the device does not make the port swing.
std::string trouble_with_a_hand(const PortDemand& demand, const config::DeviceLimits& limits,
                                int delay_periods) {
  const plan::PortLoop loop{1.0 / limits.rate_hz, delay_periods + limits.delay_periods,
                            demand.sub_steps};
  const double bearable = plan::largest_hand_stiffness(demand.least, demand.mass, loop);
  if (bearable >= kFingertip) return {};
  return "port '" + demand.port + "' swings when the hand at the device '" + demand.device +
         "' is stiffer than " + number_text(std::floor(bearable)) +
         " N/m, and a fingertip has 2000 N/m (with a mass of " + number_text(demand.mass) +
         " kg, " + number_text(demand.least.viscosity) + " N s/m and a delay of " +
         std::to_string(loop.delay) + " periods of " + number_text(loop.period) + " s)";
}

}  // namespace

std::vector<PortDemand> demands_of(const scene::Scene& scene) {
  std::vector<PortDemand> demands;
  if (scene.ports.empty()) return demands;
  const plan::LiaisonGraph graph = plan::liaison_graph(scene.network);
  const auto sub_steps = static_cast<int>(std::lround(scene.step_rate_hz / scene.gesture_rate_hz));
  for (const scene::Port& port : scene.ports) {
    demands.push_back({port.name, port.device, port.device_id, port.place, port.role,
                       scene.network.mats[port.mat].mass, plan::least_port_load(graph, port.mat),
                       plan::port_load(graph, port.mat), sub_steps});
  }
  return demands;
}

PortVerdict verdict_on(const PortDemand& demand, const config::DeviceLimits& limits,
                       int delay_periods) {
  PortVerdict verdict;
  if (demand.role == scene::Role::kLiaison) {
    verdict.doubt = trouble_with_a_hand(demand, limits, delay_periods);
    return verdict;
  }
  verdict.refusal = trouble(demand, demand.least, "is", limits, delay_periods);
  if (verdict.refusal.empty()) {
    verdict.doubt = trouble(demand, demand.most, "may become", limits, delay_periods);
  }
  return verdict;
}

}  // namespace cordis::sim
