// sim_node/engine/integrator.cpp
#include "sim_node/engine/integrator.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "sim_node/engine/network.h"

namespace cordis::engine {

const char* to_string(Integrator integrator) noexcept {
  switch (integrator) {
    case Integrator::kCordis:
      return "cordis";
    case Integrator::kLeapfrog:
      return "leapfrog";
  }
  return "";
}

Integrator integrator_named(const std::string& name) {
  for (const Integrator integrator : kIntegrators) {
    if (name == to_string(integrator)) return integrator;
  }
  throw std::invalid_argument("no integrator is called '" + name + "'");
}

int evaluations_per_step(Integrator integrator) noexcept {
  switch (integrator) {
    case Integrator::kCordis:
    case Integrator::kLeapfrog:
      break;
  }
  return 1;
}

double largest_extrapolated_step(const NetworkDescription& network) {
  std::vector<double> viscosity(network.mats.size(), network.medium_viscosity);
  for (const Link& link : network.links) {
    viscosity[link.mat_a] += link.viscosity;
    viscosity[link.mat_b] += link.viscosity;
  }
  const auto share = [&](std::uint32_t mat) {
    const bool moves = network.mats[mat].kind == MatKind::kMass;
    return moves ? viscosity[mat] / network.mats[mat].mass : 0.0;
  };
  double most = 0.0;
  for (std::uint32_t i = 0; i < viscosity.size(); ++i) {
    if (network.medium_viscosity > 0.0) most = std::max(most, share(i));
  }
  for (const Link& link : network.links) {
    if (link.viscosity > 0.0) most = std::max(most, share(link.mat_a) + share(link.mat_b));
  }
  return kMostExtrapolatedViscosity / most;
}

bool damps_in_sweeps(const NetworkDescription& network) {
  return network.integrator == Integrator::kLeapfrog &&
         network.step > largest_extrapolated_step(network);
}

}  // namespace cordis::engine
