// sim_node/scene/port_limit.cpp
#include "sim_node/scene/port_limit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace cordis::scene {
namespace {

using Complex = std::complex<double>;

constexpr int kScanSteps = 4000;
constexpr int kBisections = 60;

/// G(z): position over force of the mass, the force held over a period.
Complex mass_under_held_force(const PortLoop& loop, Complex z) {
  const double tau = loop.mass_kg / loop.viscosity_n_s_per_m;
  const double lost = -std::expm1(-loop.period_s / tau);  // share of the speed lost in a period
  const double b = loop.viscosity_n_s_per_m;
  // T - tau (1 - E) is the difference of two nearly equal numbers where b T << m.
  const double ratio = loop.period_s / tau;
  const double drift =
      ratio < 1e-4 ? loop.period_s * ratio * (0.5 - ratio / 6.0) : loop.period_s - tau * lost;
  return (drift / b) / (z - 1.0) + (tau * lost) * (lost / b) / ((z - 1.0) * (z - 1.0 + lost));
}

/// The least positive real value that `curve` takes on the upper half of the unit circle.
template <class Curve>
double least_real_value(const Curve& curve) {
  double least = std::numeric_limits<double>::infinity();
  double theta_before = 1e-4;
  Complex before = curve(std::polar(1.0, theta_before));
  for (int n = 1; n <= kScanSteps; ++n) {
    const double theta = std::numbers::pi * n / kScanSteps;
    const Complex now = curve(std::polar(1.0, theta));
    if (n == kScanSteps && now.real() > 0.0) least = std::min(least, now.real());  // z = -1 is real
    if (now.imag() * before.imag() < 0.0) {
      double low = theta_before;
      double high = theta;
      for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (low + high);
        const bool same = curve(std::polar(1.0, middle)).imag() * before.imag() > 0.0;
        (same ? low : high) = middle;
      }
      const double value = curve(std::polar(1.0, low)).real();
      if (value > 0.0) least = std::min(least, value);
    }
    before = now;
    theta_before = theta;
  }
  return least;
}

double slope_of(const engine::Law& law) {
  double steepest = 0.0;
  if (law.kind == engine::Law::Kind::kTable) {
    for (std::size_t i = 1; i < law.table.at.size(); ++i) {
      steepest = std::max(steepest, std::abs((law.table.value[i] - law.table.value[i - 1]) /
                                             (law.table.at[i] - law.table.at[i - 1])));
    }
  }
  if (law.kind == engine::Law::Kind::kRings) {
    for (const engine::Ring& ring : law.rings) steepest += std::abs(ring.stiffness);
  }
  if (law.kind == engine::Law::Kind::kPower && law.exponent == 1.0) steepest = law.coefficient;
  return steepest;
}

PortLoad stiffest_state(const engine::Behaviour& behaviour) {
  PortLoad load;
  for (const engine::LinkState& state : behaviour.states) {
    load.stiffness = std::max(load.stiffness, state.stiffness + slope_of(state.elasticity));
    load.viscosity = std::max(load.viscosity, state.viscosity + slope_of(state.dissipation));
  }
  return load;
}

std::string text_of(double number) {
  return config::number_text(std::floor(number));
}

}  // namespace

double stable_stiffness(const PortLoop& loop, double wall_viscosity) {
  const auto inverse = [&loop](Complex z) {  // -z^d / G(z)
    return -std::pow(z, loop.delay_periods) / mass_under_held_force(loop, z);
  };
  const double largest_viscosity =
      least_real_value([&](Complex z) { return loop.period_s * inverse(z) / (1.0 - 1.0 / z); });
  if (wall_viscosity >= largest_viscosity) return 0.0;
  return least_real_value(
      [&](Complex z) { return inverse(z) - wall_viscosity * (1.0 - 1.0 / z) / loop.period_s; });
}

double passive_stiffness(const PortLoop& loop, double wall_viscosity) {
  const double d = loop.delay_periods;
  double least = std::numeric_limits<double>::infinity();
  for (int n = 1; n <= kScanSteps; ++n) {
    const double theta = std::numbers::pi * n / kScanSteps;
    const double taken =
        loop.viscosity_n_s_per_m + wall_viscosity * std::cos((d + 1.0) * theta);  // [N s/m]
    const double gain = 0.5 * loop.period_s * std::sin((d + 0.5) * theta) / std::sin(0.5 * theta);
    if (gain > 0.0) least = std::min(least, taken / gain);
    if (gain <= 0.0 && taken < 0.0) return 0.0;
  }
  // theta -> 0 gives (b + B) / (T/2 + d T), the limit for a slow hand.
  least =
      std::min(least, (loop.viscosity_n_s_per_m + wall_viscosity) / (loop.period_s * (0.5 + d)));
  return std::max(least, 0.0);
}

PortLoad load_of(const engine::NetworkDescription& network, std::uint32_t mat) {
  PortLoad load;
  const auto add = [&load](const PortLoad& more) {
    load.stiffness += more.stiffness;
    load.viscosity += more.viscosity;
  };
  for (const engine::Link& link : network.links) {
    if (link.mat_a == mat || link.mat_b == mat) add({link.stiffness, link.viscosity});
  }
  for (const engine::StateLink& link : network.state_links) {
    if (link.mat_a != mat && link.mat_b != mat) continue;
    add(stiffest_state(network.behaviours[link.behaviour]));
  }
  for (const engine::MaxwellLink& link : network.maxwell_links) {
    if (link.mat_a == mat || link.mat_b == mat) add({link.stiffness, 0.0});
  }
  for (const engine::SetLiaison& set : network.sets) {
    // One partner at a time: how many there are at once is known to nobody before the run.
    const auto has = [mat](const std::vector<std::uint32_t>& mats) {
      return std::find(mats.begin(), mats.end(), mat) != mats.end();
    };
    if (has(set.set_p) || has(set.set_q)) add(stiffest_state(network.behaviours[set.behaviour]));
  }
  return load;
}

std::string refusal_of(const Scene& scene, const Port& port, const config::DeviceLimits& limits,
                       int delay_periods) {
  if (port.role != Role::kMass) return {};
  const PortLoad load = load_of(scene.network, port.mat);
  double stiffness = limits.stiffness_limit_n_per_m;
  std::string reason = "declares it";
  if (stiffness == 0.0 && limits.viscosity_n_s_per_m > 0.0) {
    const PortLoop loop{limits.moving_mass_kg, limits.viscosity_n_s_per_m, 1.0 / limits.rate_hz,
                        delay_periods + limits.delay_periods};
    stiffness = stable_stiffness(loop, load.viscosity);
    reason = "with " + config::number_text(limits.moving_mass_kg) + " kg, " +
             config::number_text(limits.viscosity_n_s_per_m) + " N s/m and a delay of " +
             std::to_string(loop.delay_periods) + " periods of " +
             config::number_text(loop.period_s) + " s";
  } else if (stiffness == 0.0) {
    return {};
  }
  if (load.stiffness > stiffness) {
    return "port '" + port.name + "' is as stiff as " + text_of(std::ceil(load.stiffness)) +
           " N/m, and the device '" + port.device + "' can bear " + text_of(stiffness) + " N/m (" +
           reason + ")";
  }
  if (limits.damping_limit_n_s_per_m > 0.0 && load.viscosity > limits.damping_limit_n_s_per_m) {
    return "port '" + port.name + "' is as viscous as " + config::number_text(load.viscosity) +
           " N s/m, and the device '" + port.device + "' can bear " +
           config::number_text(limits.damping_limit_n_s_per_m) + " N s/m (declares it)";
  }
  return {};
}

}  // namespace cordis::scene
