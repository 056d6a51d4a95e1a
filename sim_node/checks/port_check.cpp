// sim_node/checks/port_check.cpp
#include "sim_node/checks/port_check.h"

#include <algorithm>
#include <cmath>

#include "node/config/mapping_reader.h"
#include "sim_node/checks/port_body.h"

namespace cordis::sim {
namespace {

using config::number_text;

constexpr double kFingertip = 2000.0;     // stiffness of one that presses [N/m]
constexpr double kDelayAccuracy = 0.005;  // of the largest delay that is supported

/// What a device supports at a port, and why.
struct ImpedanceLimit {
  double most = 0.0;  // [N/m] or [N s/m]; 0: nothing is known
  std::string reason;
};

/// Three digits, not above the number.
double rounded_down(double number) {
  const double scale = std::pow(10.0, 2.0 - std::floor(std::log10(number)));
  return std::floor(number * scale) / scale;
}

/// The wall that a device supports because of its mass and viscosity. Nothing is known of a device
/// without viscosity.
class ImpedanceLimits {
 public:
  ImpedanceLimits(const config::DeviceLimits& limits, double delay_periods)
      : limits_(limits),
        loop_{1.0 / limits.rate_hz, delay_periods + limits.delay_periods, 1},
        device_{limits.coordinate_mass_kg(), limits.coordinate_viscosity_n_s_per_m()} {}

  ImpedanceLimit stiffness(double port_viscosity) const {
    if (limits_.stiffness_limit_n_per_m > 0.0) return declared(limits_.stiffness_limit_n_per_m);
    if (limits_.viscosity_n_s_per_m <= 0.0) return {};
    const double most = plan::stable_port_stiffness(device_, port_viscosity, loop_);
    return {std::max(most, 1e-9), reason()};
  }
  ImpedanceLimit viscosity() const {
    if (limits_.damping_limit_n_s_per_m > 0.0) return declared(limits_.damping_limit_n_s_per_m);
    if (limits_.viscosity_n_s_per_m <= 0.0) return {};
    const double most = plan::stable_port_viscosity(device_, loop_);
    if (!std::isfinite(most)) return {};
    return {rounded_down(most), reason()};
  }

 private:
  static ImpedanceLimit declared(double limit) { return {limit, "declares it"}; }
  std::string reason() const {
    return "with " + number_text(device_.mass) + " kg, " + number_text(device_.viscosity) +
           " N s/m and a delay of " + periods_text(loop_.delay) + " of " +
           number_text(loop_.period) + " s";
  }

  const config::DeviceLimits& limits_;
  plan::PortLoop loop_;
  plan::PortDevice device_;
};

/// Empty when the device supports the load.
std::string trouble(const PortDemand& demand, const plan::PortLoad& load, const std::string& is,
                    const config::DeviceLimits& limits, double delay_periods) {
  const std::string port = "port '" + demand.port + "' " + is;
  const std::string device = ", and the device '" + demand.device + "' supports ";
  const ImpedanceLimits supported(limits, delay_periods);
  // First: where the viscosity alone is too much, no stiffness is little enough.
  const ImpedanceLimit viscosity = supported.viscosity();
  if (viscosity.most > 0.0 && load.viscosity > viscosity.most) {
    return port + " as viscous as " + number_text(load.viscosity) + " N s/m" + device +
           number_text(viscosity.most) + " N s/m (" + viscosity.reason + ")";
  }
  const ImpedanceLimit stiffness = supported.stiffness(load.viscosity);
  if (stiffness.most > 0.0 && load.stiffness > stiffness.most) {
    return port + " as stiff as " + number_text(std::ceil(load.stiffness)) + " N/m" + device +
           number_text(std::floor(stiffness.most)) + " N/m (" + stiffness.reason + ")";
  }
  return {};
}

/// What the port needs and an axis of the device does not have, a sentence each.
std::vector<std::string> lacks_of(const PortDemand& demand, const config::DeviceLimits& limits) {
  constexpr double kRounding = 1e-9;
  std::vector<std::string> lacks;
  const auto compare = [&](double needed, const auto& known, const auto& of_axes, const char* what,
                           const char* unit) {
    for (const std::uint32_t axis : demand.axes) {
      if (axis >= of_axes.size() || known[axis] <= 0.0) continue;
      if (of_axes[axis] >= needed * (1.0 - kRounding)) continue;
      lacks.push_back("port '" + demand.port + "' needs a " + what + " of " + number_text(needed) +
                      unit + ", and axis " + std::to_string(axis) + " of the device '" +
                      demand.device + "' has " + number_text(of_axes[axis]) + unit);
      return;  // one sentence about all axes
    }
  };
  const auto& highest = limits.coordinate_highest_m;
  auto depth = limits.coordinate_lowest_m;
  auto reach = highest;
  for (std::size_t axis = 0; axis < depth.size(); ++axis) {
    depth[axis] = -depth[axis];
    reach[axis] = highest[axis] + depth[axis];
  }
  const auto& travel = limits.coordinate_travel_m;
  compare(demand.needs.travel, travel, travel, "travel", " m");
  compare(demand.needs.up, reach, highest, "travel", " m above its rest");
  compare(demand.needs.down, reach, depth, "travel", " m below its rest");
  const auto& force = limits.coordinate_force_n;
  compare(demand.needs.force, force, force, "force", " N");
  return lacks;
}

/// Empty when a fingertip on the device does not make the port swing.
std::string trouble_with_a_hand(const PortDemand& demand, const config::DeviceLimits& limits,
                                double delay_periods) {
  const plan::PortLoop loop{1.0 / limits.rate_hz, delay_periods + limits.delay_periods,
                            demand.sub_steps};
  const double bearable = plan::largest_hand_stiffness(demand.least, demand.mass, loop);
  if (bearable >= kFingertip) return {};
  return "port '" + demand.port + "' swings when the hand at the device '" + demand.device +
         "' is stiffer than " + number_text(std::floor(bearable)) +
         " N/m, and a fingertip has 2000 N/m (with a mass of " + number_text(demand.mass) +
         " kg, " + number_text(demand.least.viscosity) + " N s/m and a delay of " +
         periods_text(loop.delay) + " of " + number_text(loop.period) + " s)";
}

}  // namespace

std::vector<PortDemand> demands_of(const scene::Scene& scene) {
  std::vector<PortDemand> demands;
  if (scene.ports.empty()) return demands;
  const plan::LiaisonGraph graph = plan::liaison_graph(scene.network);
  const auto sub_steps = static_cast<int>(std::lround(scene.step_rate_hz / scene.gesture_rate_hz));
  for (const scene::Port& port : scene.ports) {
    demands.push_back({port.name, port.device, port.device_id, port.place, port.role,
                       mass_of(scene, port), min_load_of(graph, scene, port),
                       max_load_of(graph, scene, port), sub_steps, port.axes, port.needs});
  }
  return demands;
}

PortVerdict verdict_on(const PortDemand& demand, const config::DeviceLimits& limits,
                       double delay_periods) {
  PortVerdict verdict;
  verdict.lacks = lacks_of(demand, limits);
  if (demand.role == scene::Role::kLiaison) {
    verdict.uncertainty = trouble_with_a_hand(demand, limits, delay_periods);
    return verdict;
  }
  verdict.refusal = trouble(demand, demand.least, "is", limits, delay_periods);
  if (verdict.refusal.empty()) {
    verdict.uncertainty = trouble(demand, demand.most, "may become", limits, delay_periods);
  }
  return verdict;
}

std::optional<double> largest_supported_delay(const PortDemand& demand,
                                              const config::DeviceLimits& limits,
                                              double delay_periods) {
  const auto is_supported = [&](double delay) {
    return trouble(demand, demand.least, "is", limits, delay).empty();
  };
  if (demand.role == scene::Role::kLiaison) return delay_periods;  // never refused
  double low = kFastestAnswer * limits.rate_hz;
  double high = delay_periods;
  if (low >= high || !is_supported(low)) return {};
  if (is_supported(high)) return high;
  for (int i = 0; i < 10 || high - low > kDelayAccuracy * high; ++i) {
    const double middle = 0.5 * (low + high);
    (is_supported(middle) ? low : high) = middle;
  }
  return low;
}

std::uint64_t enough_answers(double rate_hz) noexcept {
  return static_cast<std::uint64_t>(std::clamp(2.0 * rate_hz, 20.0, 1000.0));
}

std::string needed_answer_text(double delay_periods, double rate_hz,
                               std::optional<double> measured_s) {
  const double needed_us = std::floor(1e6 * delay_periods / rate_hz);
  const std::string needed = "It needs an answer within " + number_text(needed_us) + " us; ";
  if (measured_s)
    return needed + "its answers take " + number_text(std::ceil(1e6 * *measured_s)) + " us";
  return needed + "one period is assumed until " + std::to_string(enough_answers(rate_hz)) +
         " answers are measured";
}

std::string periods_text(double periods) {
  const double rounded = std::round(1000.0 * periods) / 1000.0;
  return number_text(rounded) + (rounded == 1.0 ? " period" : " periods");
}

std::optional<double> supported_stiffness(const PortDemand& demand,
                                          const config::DeviceLimits& limits,
                                          double delay_periods) {
  const double most = ImpedanceLimits(limits, delay_periods).stiffness(demand.most.viscosity).most;
  return most > 0.0 ? std::optional(most) : std::nullopt;
}

}  // namespace cordis::sim
