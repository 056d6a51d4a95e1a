// sim_node/engine/integrators/integrator_limits.cpp
#include "sim_node/engine/integrators/integrator_limits.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim_node/engine/integrators/stiff_friction.h"

namespace cordis::engine {
namespace {

/// What keeps a state machine from being a potential; null when it is one.
const char* not_a_potential(const StateMachine& state_machine) {
  if (!state_machine.is_stateless()) return "states";
  const LinkState& state = state_machine.states[0];
  if (state.viscosity > 0.0 || !is_none(state.dissipation)) return "viscosity";
  if (std::isfinite(state.force_limit)) return "a force limit";
  if (!stores_energy(state.elasticity)) return "a free expression";
  if (!state.formulas.empty()) return "a parameter that follows a formula";
  return nullptr;
}

std::optional<IntegratorRefusal> refusal_of_what_does_not_conserve(
    const NetworkDescription& network) {
  if (network.has_medium()) return IntegratorRefusal{"viscosity", {}};
  if (!network.drives.empty()) return IntegratorRefusal{"what is driven", {}};
  for (const Mat& mat : network.mats) {
    if (mat.kind == MatKind::kPort) return IntegratorRefusal{"a port with the role mass", {}};
  }
  const auto refusal = [](LiaisonKind kind, std::size_t index, const char* what) {
    return IntegratorRefusal{what, LiaisonId{kind, static_cast<std::uint32_t>(index)}};
  };
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    if (network.links[l].viscosity > 0.0) return refusal(LiaisonKind::kLink, l, "viscosity");
  }
  for (std::size_t l = 0; l < network.state_links.size(); ++l) {
    const char* what =
        not_a_potential(network.state_machines[network.state_links[l].state_machine]);
    if (what != nullptr) return refusal(LiaisonKind::kStateLink, l, what);
  }
  if (!network.maxwell_links.empty()) return refusal(LiaisonKind::kMaxwellLink, 0, "viscosity");
  for (std::size_t l = 0; l < network.bends.size(); ++l) {
    if (network.bends[l].has_states()) {
      const bool is_one = network.state_machines[network.bends[l].state_machine].is_stateless();
      return refusal(LiaisonKind::kBend, l,
                     is_one ? "a law or a parameter of a bend that is no number" : "states");
    }
    if (network.bends[l].viscosity > 0.0) return refusal(LiaisonKind::kBend, l, "viscosity");
  }
  for (std::size_t s = 0; s < network.sets.size(); ++s) {
    const char* what = not_a_potential(network.state_machines[network.sets[s].state_machine]);
    if (what != nullptr) return refusal(LiaisonKind::kSet, s, what);
  }
  return std::nullopt;
}

/// Real modes need viscosities in proportion to stiffnesses and masses.
std::optional<IntegratorRefusal> refusal_of_what_has_no_modes(const NetworkDescription& network) {
  if (network.dimension != 1) return IntegratorRefusal{"2 or 3 dimensions", {}};
  constexpr double kRounding = 1e-9;
  const auto differ = [](double u, double v) {
    return std::abs(u - v) > kRounding * std::max(std::abs(u), std::abs(v));
  };
  if (!network.bends.empty()) {
    return IntegratorRefusal{"stiffness against bending", LiaisonId{LiaisonKind::kBend, 0}};
  }
  const Link* first = nullptr;
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    const Link& link = network.links[l];
    const auto is_port = [&](std::uint32_t mat) {
      return mat < network.mats.size() && network.mats[mat].kind == MatKind::kPort;
    };
    if (is_port(link.mat_a) || is_port(link.mat_b)) continue;
    if (first == nullptr) first = &link;
    if (differ(link.viscosity * first->stiffness, first->viscosity * link.stiffness) ||
        (link.viscosity > 0.0 && link.stiffness == 0.0)) {
      return IntegratorRefusal{"a viscosity that is not in the same proportion to the stiffness",
                               LiaisonId{LiaisonKind::kLink, static_cast<std::uint32_t>(l)}};
    }
  }
  double mass = 0.0;
  double decay = 0.0;  // Z / m of the medium
  for (const Mat& mat : network.mats) {
    if (mat.kind != MatKind::kMass) continue;
    const double own_decay = network.medium_viscosity_on(mat) / mat.mass;
    if (mass > 0.0 && differ(decay, own_decay)) {
      return IntegratorRefusal{mass == mat.mass ? "masses with different viscosities of the medium"
                                                : "different masses in a medium",
                               {}};
    }
    mass = mat.mass;
    decay = own_decay;
  }
  if (mass == 0.0) return IntegratorRefusal{"no mass", {}};
  for (const Drive& drive : network.drives) {
    if (asks_for_motion(network.time_functions[drive.function]))
      return IntegratorRefusal{"a driven force by place or velocity", {}};
  }
  if (network.mass_count() > kMaxModalMasses) {
    return IntegratorRefusal{"more than " + std::to_string(kMaxModalMasses) + " masses", {}};
  }
  return std::nullopt;
}

/// Friction remembers how the MATs have moved from step to step of `cordis`.
std::optional<IntegratorRefusal> refusal_of_friction(const NetworkDescription& network) {
  const bool remembers =
      network.integrator == IntegratorKind::kCordis && !(network.freeze_tolerance > 0.0);
  if (remembers) return std::nullopt;
  for (std::size_t s = 0; s < network.sets.size(); ++s) {
    if (!rubs(network.state_machines[network.sets[s].state_machine])) continue;
    const bool freezes = network.integrator == IntegratorKind::kCordis;
    return IntegratorRefusal{freezes ? "freezing together with friction" : "friction",
                             LiaisonId{LiaisonKind::kSet, static_cast<std::uint32_t>(s)}};
  }
  return std::nullopt;
}

}  // namespace

int evaluations_per_step(IntegratorKind integrator) noexcept {
  switch (integrator) {
    case IntegratorKind::kSymplectic4:
      return 6;
    case IntegratorKind::kCordis:
    case IntegratorKind::kLeapfrog:
    case IntegratorKind::kImplicit:
    case IntegratorKind::kModal:
      break;
  }
  return 1;
}

std::optional<IntegratorRefusal> refusal_of(const NetworkDescription& network) {
  if (const auto refusal = refusal_of_friction(network)) return refusal;
  if (network.freeze_tolerance > 0.0) {
    const bool freezes = network.integrator == IntegratorKind::kCordis ||
                         network.integrator == IntegratorKind::kLeapfrog;
    if (!freezes) return IntegratorRefusal{"freezing", {}};
    if (!network.bends.empty()) {
      return IntegratorRefusal{"freezing together with stiffness against bending",
                               LiaisonId{LiaisonKind::kBend, 0}};
    }
    if (damps_implicitly(network) || solves_stiff_friction(network)) {
      return IntegratorRefusal{"freezing together with viscosities above Z dt / m = 0.3", {}};
    }
  }
  switch (network.integrator) {
    case IntegratorKind::kSymplectic4:
      return refusal_of_what_does_not_conserve(network);
    case IntegratorKind::kModal:
      return refusal_of_what_has_no_modes(network);
    case IntegratorKind::kCordis:
    case IntegratorKind::kLeapfrog:
    case IntegratorKind::kImplicit:
      break;
  }
  return std::nullopt;
}

double largest_extrapolated_step(const NetworkDescription& network) {
  std::vector<double> viscosity;
  for (const Mat& mat : network.mats) viscosity.push_back(network.medium_viscosity_on(mat));
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
    if (network.medium_viscosity_on(network.mats[i]) > 0.0) most = std::max(most, share(i));
  }
  for (const Link& link : network.links) {
    if (link.viscosity > 0.0) most = std::max(most, share(link.mat_a) + share(link.mat_b));
  }
  return kMaxExtrapolatedViscosity / most;
}

double largest_damping(const NetworkDescription& network) {
  return kMaxExtrapolatedViscosity * network.step / largest_extrapolated_step(network);
}

double implicit_damping_limit(double viscosity) noexcept {
  constexpr double kQ = kImplicitDampingShare * kImplicitDampingShare;
  return 2.0 * (2.0 + 2.0 * kQ * viscosity + kQ * viscosity * viscosity) /
         (1.0 + 2.0 * kQ * viscosity);
}

bool damps_implicitly(const NetworkDescription& network) {
  return network.integrator == IntegratorKind::kLeapfrog &&
         network.step > largest_extrapolated_step(network);
}

}  // namespace cordis::engine
