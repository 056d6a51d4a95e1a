// sim_node/plan/stability/port_limit.cpp
#include "sim_node/plan/stability/port_limit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace cordis::plan {
namespace {

using Complex = std::complex<double>;

constexpr int kFrequencies = 4000;  // up to half the rate of the device
constexpr int kBisections = 60;

/// @param least  of what hangs there, else the most
PortLoad load_of(const LiaisonGraph& graph, std::uint32_t mat, bool least) {
  PortLoad load;
  const auto add = [&](double count, double stiffness, double viscosity, bool bounded) {
    if (least && !bounded) return;
    load.stiffness += count * stiffness;
    load.viscosity += count * viscosity;
  };
  for (const Edge& joint : graph.joints) {
    if (joint.mat_a != mat && joint.mat_b != mat) continue;
    add(1.0, joint.stiffness, joint.viscosity, joint.bounded);
  }
  for (const ContactBound& crowd : graph.crowds) {
    for (std::size_t i = 0; i < crowd.members.size(); ++i) {
      if (crowd.members[i] != mat) continue;
      const double count = least ? std::min(1.0, crowd.neighbours[i]) : crowd.neighbours[i];
      add(count, crowd.stiffness, crowd.viscosity, crowd.bounded);
    }
  }
  if (graph.inverse_mass[mat] > 0.0) load.viscosity += graph.medium_viscosity;
  return load;
}

/// G(z): position over force of the mass, the force held over a period.
Complex mass_under_held_force(const PortDevice& device, double period, Complex z) {
  const double tau = device.mass / device.viscosity;
  const double lost = -std::expm1(-period / tau);  // share of the speed lost in a period
  const double b = device.viscosity;
  // T - tau (1 - E) is the difference of two nearly equal numbers where b T << m.
  const double ratio = period / tau;
  const double drift = ratio < 1e-4 ? period * ratio * (0.5 - ratio / 6.0) : period - tau * lost;
  return (drift / b) / (z - 1.0) + (tau * lost) * (lost / b) / ((z - 1.0) * (z - 1.0 + lost));
}

/// -z^d / G(z): what a wall is on the boundary.
Complex wall_on_boundary(const PortDevice& device, const PortLoop& loop, Complex z) {
  return -std::pow(z, loop.delay) / mass_under_held_force(device, loop.period, z);
}

/// The least positive real value that `curve` takes on the upper half of the unit circle.
template <class Curve>
double min_real_value(const Curve& curve) {
  double least = std::numeric_limits<double>::infinity();
  double theta_before = 1e-4;
  Complex before = curve(std::polar(1.0, theta_before));
  for (int n = 1; n <= kFrequencies; ++n) {
    const double theta = std::numbers::pi * n / kFrequencies;
    const Complex now = curve(std::polar(1.0, theta));
    if (n == kFrequencies && now.real() > 0.0)
      least = std::min(least, now.real());  // z = -1 is real
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

}  // namespace

PortLoad port_load(const LiaisonGraph& graph, std::uint32_t mat) {
  return load_of(graph, mat, /*least=*/false);
}

PortLoad min_port_load(const LiaisonGraph& graph, std::uint32_t mat) {
  return load_of(graph, mat, /*least=*/true);
}

double min_device_viscosity(const PortLoad& load, const PortLoop& loop) {
  const double d = loop.delay;
  // The limit of the quotient of sines for w = 0.
  double least = load.stiffness * loop.period * (0.5 + d) - load.viscosity;
  for (int i = 1; i <= kFrequencies; ++i) {
    const double w = std::numbers::pi * i / kFrequencies;
    const double spring =
        0.5 * load.stiffness * loop.period * std::sin((d + 0.5) * w) / std::sin(0.5 * w);
    least = std::max(least, spring - load.viscosity * std::cos((d + 1.0) * w));
  }
  return std::max(least, 0.0);
}

double largest_port_stiffness(double device_viscosity, double port_viscosity,
                              const PortLoop& loop) {
  const double d = loop.delay;
  // The limit for a slow hand, w = 0.
  double least = (device_viscosity + port_viscosity) / (loop.period * (0.5 + d));
  for (int i = 1; i <= kFrequencies; ++i) {
    const double w = std::numbers::pi * i / kFrequencies;
    const double taken = device_viscosity + port_viscosity * std::cos((d + 1.0) * w);
    const double gain = 0.5 * loop.period * std::sin((d + 0.5) * w) / std::sin(0.5 * w);
    if (taken < 0.0) return 0.0;
    if (gain > 0.0) least = std::min(least, taken / gain);
  }
  return least;
}

double stable_port_viscosity(const PortDevice& device, const PortLoop& loop) {
  return min_real_value(
      [&](Complex z) { return loop.period * wall_on_boundary(device, loop, z) / (1.0 - 1.0 / z); });
}

double stable_port_stiffness(const PortDevice& device, double port_viscosity,
                             const PortLoop& loop) {
  if (port_viscosity >= stable_port_viscosity(device, loop)) return 0.0;
  return min_real_value([&](Complex z) {
    return wall_on_boundary(device, loop, z) - port_viscosity * (1.0 - 1.0 / z) / loop.period;
  });
}

double largest_hand_stiffness(const PortLoad& load, double mass, const PortLoop& loop) {
  const double step = loop.period / loop.sub_steps;
  const double limit = 4.0 - 2.0 * load.viscosity * step / mass;
  const double of_scheme = std::max(0.0, limit * mass / (step * step) - load.stiffness);
  const double age = loop.period * (loop.delay + 0.5 * (1.0 - 1.0 / loop.sub_steps));
  return age > 0.0 ? std::min(load.viscosity / age, of_scheme) : of_scheme;
}

}  // namespace cordis::plan
