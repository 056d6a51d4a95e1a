// sim_node/engine/integrators/integrator.cpp
#include "sim_node/engine/integrators/integrator.h"

#include <stdexcept>
#include <string>

#include "sim_node/engine/integrators/central_difference.h"
#include "sim_node/engine/integrators/implicit_euler.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/leapfrog.h"
#include "sim_node/engine/integrators/modal_integrator.h"
#include "sim_node/engine/integrators/symplectic4.h"
#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {

Vec3 Integrator::velocity(const WorldState& world, std::uint32_t mat) const noexcept {
  return world.mats.moved(mat) / world.network->step();
}

double Integrator::kinetic_energy(const WorldState& world) const noexcept {
  double twice = 0.0;
  for (std::uint32_t i = 0; i < world.mats.count(); ++i) {
    if (world.mats.is_mass(i))
      twice += world.description().mats[i].mass * velocity(world, i).squaredNorm();
  }
  return 0.5 * twice;
}

std::unique_ptr<Integrator> make_integrator(const NetworkDescription& network) {
  if (const auto refusal = refusal_of(network)) {
    throw std::invalid_argument(std::string("the integrator ") + to_string(network.integrator) +
                                " does not take " + refusal->what);
  }
  switch (network.integrator) {
    case IntegratorKind::kCordis:
      return std::make_unique<CentralDifference>();
    case IntegratorKind::kLeapfrog:
      return std::make_unique<Leapfrog>(network);
    case IntegratorKind::kSymplectic4:
      return std::make_unique<Symplectic4>(network);
    case IntegratorKind::kImplicit:
      return std::make_unique<ImplicitEuler>(network);
    case IntegratorKind::kModal:
      return std::make_unique<ModalIntegrator>(network);
  }
  throw std::invalid_argument("there is no such integrator");
}

}  // namespace cordis::engine
