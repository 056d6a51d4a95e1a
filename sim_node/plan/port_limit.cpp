// sim_node/plan/port_limit.cpp
#include "sim_node/plan/port_limit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cordis::plan {
namespace {

constexpr int kFrequencies = 2000;  // up to half the rate of the device

}  // namespace

PortLoad port_load(const LiaisonGraph& graph, std::uint32_t mat) {
  PortLoad load;
  for (const Joint& joint : graph.joints) {
    if (joint.mat_a != mat && joint.mat_b != mat) continue;
    load.stiffness += joint.stiffness;
    load.viscosity += joint.viscosity;
  }
  for (const Crowd& crowd : graph.crowds) {
    for (std::size_t i = 0; i < crowd.members.size(); ++i) {
      if (crowd.members[i] != mat) continue;
      load.stiffness += crowd.neighbours[i] * crowd.stiffness;
      load.viscosity += crowd.neighbours[i] * crowd.viscosity;
    }
  }
  if (graph.inverse_mass[mat] > 0.0) load.viscosity += graph.medium_viscosity;
  return load;
}

double least_device_viscosity(const PortLoad& load, const PortLoop& loop) {
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
  if (least_device_viscosity({0.0, port_viscosity}, loop) >= device_viscosity) return 0.0;
  double low = 0.0;
  double high = (device_viscosity + port_viscosity) / (0.5 * loop.period);
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (least_device_viscosity({middle, port_viscosity}, loop) < device_viscosity ? low : high) =
        middle;
  }
  return low;
}

double largest_hand_stiffness(const PortLoad& load, double mass, const PortLoop& loop) {
  if (loop.delay > 0) return load.viscosity / (loop.delay * loop.period);
  const double limit = 4.0 - 2.0 * load.viscosity * loop.period / mass;
  return std::max(0.0, limit * mass / (loop.period * loop.period) - load.stiffness);
}

}  // namespace cordis::plan
