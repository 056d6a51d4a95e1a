// sim_node/run/bound_text.cpp
#include "sim_node/run/bound_text.h"

#include <cmath>

#include <fmt/format.h>

#include "node/assert.h"

namespace cordis::sim {

std::string let_go_text(const Simulation& simulation) {
  CORDIS_ASSERT(simulation.passed_bound() != PassedBound::kNone);
  const std::string done = simulation.has_devices() ? "has let go of the devices: " : "";
  switch (simulation.passed_bound()) {
    case PassedBound::kPartners:
      return done + crowding_text(simulation.scene(), *simulation.partners().nearest());
    case PassedBound::kNumber:
      return done + "K' + 2 Z' came to 4, from where on the scene may be unstable";
    case PassedBound::kEnergy:
      return done + "the steps have made more than a tenth of the largest energy";
    case PassedBound::kNone:
      break;
  }
  return {};
}

std::string integration_error_text(const engine::Energy& energy) {
  const double error = energy.integration_error();
  if (!std::isfinite(error) || !std::isfinite(energy.largest))
    return "the energy is no finite number any more: the motion diverges. A higher step rate helps";
  if (energy.brought_by_takers > 0.5 * std::abs(error))
    return fmt::format(
        "viscosity and all else that can only take have brought in {:.3g} J, above 1 % of the "
        "largest energy ({:.3g} J): the step is too long for a liaison. A higher step rate helps",
        energy.brought_by_takers, energy.largest);
  return fmt::format(
      "the steps have {} {:.3g} J that no account explains, above 1 % of the largest energy "
      "({:.3g} J): the step is too long for a liaison. A higher step rate helps",
      error > 0.0 ? "made" : "taken", std::abs(error), energy.largest);
}

std::string bound_text(const LoadedScene& loaded) {
  if (loaded.simulation.passed_bound() != PassedBound::kNone) return let_go_text(loaded.simulation);
  return loaded.is_beyond_reach ? kBeyondReach : "";
}

}  // namespace cordis::sim
