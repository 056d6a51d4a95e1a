// sim_node/checks/stability_check.cpp
#include "sim_node/checks/stability_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "node/assert.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/limit_weights.h"
#include "sim_node/plan/stability/parameter_bounds.h"
#include "sim_node/plan/stability/step_bound.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {
namespace {

/// True if a formula may make the stiffness of a state fall below 0.
bool may_fall_below_0(const engine::StateMachine& state_machine, const plan::Reach& reach) {
  return std::ranges::any_of(state_machine.states, [&reach](const engine::LinkState& state) {
    return engine::asks_for_variable(state.elasticity) &&
           plan::linear_bounds(state, reach).stiffness.low < 0.0;
  });
}

/// The first link with states or set at the MAT of which that is true.
std::optional<plan::LiaisonId> falling_below_0(const engine::NetworkDescription& network,
                                               std::uint32_t mat) {
  const plan::Reach reach = plan::reach_of(network);
  const auto falls = [&](std::uint32_t state_machine) {
    return may_fall_below_0(network.state_machines[state_machine], reach);
  };
  for (std::uint32_t l = 0; l < network.state_links.size(); ++l) {
    const engine::StateLink& link = network.state_links[l];
    if ((link.mat_a == mat || link.mat_b == mat) && falls(link.state_machine))
      return plan::LiaisonId{plan::LiaisonKind::kStateLink, l};
  }
  for (std::uint32_t s = 0; s < network.sets.size(); ++s) {
    const engine::SetLiaison& set = network.sets[s];
    const bool is_member = std::ranges::find(set.set_p, mat) != set.set_p.end() ||
                           std::ranges::find(set.set_q, mat) != set.set_q.end();
    if (is_member && falls(set.state_machine)) return plan::LiaisonId{plan::LiaisonKind::kSet, s};
  }
  return {};
}

/// A liaison whose law grows ever steeper, at the MAT if there is one there.
std::optional<plan::LiaisonId> liaison_without_largest_slope(const plan::LiaisonGraph& graph,
                                                             std::uint32_t mat) {
  std::optional<plan::LiaisonId> found;
  for (const plan::Edge& edge : graph.edges) {
    if (edge.bounded) continue;
    if (edge.mat_a == mat || edge.mat_b == mat) return edge.liaison;
    if (!found) found = edge.liaison;
  }
  for (const plan::ContactBound& contact : graph.contacts) {
    const bool is_at_mat =
        std::find(contact.members.begin(), contact.members.end(), mat) != contact.members.end();
    if (!contact.bounded && (is_at_mat || !found))
      found = plan::LiaisonId{plan::LiaisonKind::kSet, contact.set};
  }
  return found;
}

/// Which rate is stable, or why none is certain.
std::string rate_hint(const scene::Scene& scene, const plan::Stability& stability) {
  double step = stability.certified.step;
  if (stability.uncertainty) {
    step = plan::certain_step_of(scene.network, plan::liaison_graph(scene.network), stability);
    if (step == 0.0)
      return "no rate_hz is certain: " + uncertainty_text(scene, *stability.uncertainty);
  }
  const double rate = rate_above(scene, 1.0 / step);
  if (rate > scene::kHighestStepRate)
    return "no rate_hz is high enough: take less stiffness or more mass";
  return "a rate_hz of " + std::to_string(std::lround(rate)) +
         " is stable in every pose and state" +
         (stability.turning.liaison ? " in which no link turns about" : "");
}

/// Index of what a liaison follows: its time function if it is a force, else its state machine.
std::optional<std::uint32_t> follower_of(const engine::NetworkDescription& network,
                                         plan::LiaisonId liaison) {
  switch (liaison.kind) {
    case plan::LiaisonKind::kForce:
      return network.drives[liaison.index].function;
    case plan::LiaisonKind::kSet:
      return network.sets[liaison.index].state_machine;
    case plan::LiaisonKind::kMaxwellLink:
      return network.maxwell_links[liaison.index].state_machine;
    case plan::LiaisonKind::kBend:
      return network.bends[liaison.index].state_machine;
    case plan::LiaisonKind::kStateLink:
      return network.state_links[liaison.index].state_machine;
    case plan::LiaisonKind::kLink:
      break;
  }
  return {};
}

/// What a liaison asks for, as the file names it there, and the place.
std::string asked_text(const scene::Scene& scene, plan::LiaisonId liaison, std::uint32_t variable) {
  CORDIS_ASSERT(variable < scene.asked_variables.size());
  const scene::AskedVariable& asked = scene.asked_variables[variable];
  const bool is_function = liaison.kind == plan::LiaisonKind::kForce;
  const std::optional<std::uint32_t> index = follower_of(scene.network, liaison);
  const auto use =
      std::ranges::find_if(asked.uses, [&](const scene::AskedVariable::Use& candidate) {
        return candidate.is_function == is_function && candidate.index == index;
      });
  const bool is_first = use == asked.uses.end();
  return "'" + (is_first ? asked.name : use->name) + "' (" +
         scene::place_text(is_first ? asked.place : use->place) + ")";
}

}  // namespace

double rate_above(const scene::Scene& scene, double rate_hz) noexcept {
  return (std::floor(rate_hz / scene.gesture_rate_hz) + 1.0) * scene.gesture_rate_hz;
}

std::string uncertainty_text(const scene::Scene& scene, const plan::Uncertainty& uncertainty) {
  std::string text = scene::call_liaison(scene, uncertainty.liaison).name + ": " + uncertainty.why;
  if (uncertainty.beside && uncertainty.beside != uncertainty.liaison) {
    const scene::Called beside = scene::call_liaison(scene, *uncertainty.beside);
    text += ", in " + beside.name + " (" + scene::place_text(beside.place) + ")";
  }
  const char* separator = ": ";
  for (const std::uint32_t variable : uncertainty.variables) {
    text += separator + asked_text(scene, uncertainty.liaison, variable);
    separator = ", ";
  }
  return text;
}

plan::Stability check_stability(const scene::Scene& scene, bool force, config::Problems& problems) {
  plan::Stability stability = plan::stability_of(scene.network, plan::liaison_graph(scene.network));
  check_stability(scene, stability, force, problems);
  return stability;
}

void check_stability(const scene::Scene& scene, const plan::Stability& stability, bool force,
                     config::Problems& problems) {
  if (stability.holds()) return;

  const long rate = std::lround(scene.step_rate_hz);
  if (!stability.diverges() && stability.uncertainty) {
    problems.warning(scene::call_liaison(scene, stability.uncertainty->liaison).place,
                     "at " + std::to_string(rate) +
                         " Hz it is not certain that the scene is stable: " +
                         uncertainty_text(scene, *stability.uncertainty),
                     kWatchedText);
    return;
  }
  const plan::StepBound& bound = stability.certified;
  const scene::Called liaison = scene::call_liaison(scene, bound.liaison);
  const scene::Called mass = scene::call_mat(scene, bound.mat);
  // The viscosity of the medium has no place of its own.
  const config::Place& place = bound.liaison ? liaison.place : mass.place;
  const std::string limit = liaison.name + " at the mass " + mass.name + " sets the limit";
  const std::string hint = rate_hint(scene, stability);
  if (!stability.diverges()) {
    problems.warning(place,
                     "at " + std::to_string(rate) +
                         " Hz the scene may be unstable in some poses or states: " + limit,
                     hint + "; " + kWatchedText);
  } else if (force) {
    problems.warning(place, "at " + std::to_string(rate) + " Hz the scene is unstable: " + limit,
                     hint);
  } else {
    problems.error(
        place, "at " + std::to_string(rate) + " Hz the scene is unstable: " + limit,
        hint + "; or run it all the same by a launch file with force: true of its sim_node");
  }
}

std::string reason_of_divergence(const scene::Scene& scene, std::uint32_t mat) {
  const plan::LiaisonGraph graph = plan::weighted(
      plan::liaison_graph(scene.network), plan::limit_weights(scene.network, plan::Limit::kStable));
  const double dt = scene.network.step;
  const std::vector<double> weight = plan::row_weights(graph, dt).weight;
  double sum = 0.0;
  double strongest = -1.0;  // a law may be of no stiffness where it was looked at
  std::optional<plan::LiaisonId> liaison;
  const auto add = [&](plan::LiaisonId id, double stiffness, double viscosity, double weights) {
    const double number = graph.inverse_mass[mat] * weights / weight[mat] *
                          (dt * dt * stiffness + 2.0 * dt * viscosity);
    sum += number;
    if (number <= strongest) return;
    strongest = number;
    liaison = id;
  };
  for (const plan::Edge& edge : graph.edges) {
    if (edge.mat_a != mat && edge.mat_b != mat) continue;
    add(edge.liaison, edge.stiffness, edge.viscosity, weight[edge.mat_a] + weight[edge.mat_b]);
  }
  for (const plan::ContactBound& contact : graph.contacts) {
    const double most = plan::largest_of_others(contact, weight);
    for (std::size_t m = 0; m < contact.members.size(); ++m) {
      if (contact.members[m] != mat) continue;
      add({plan::LiaisonKind::kSet, contact.set}, contact.stiffness, contact.viscosity,
          contact.neighbours[m] * (weight[mat] + most));
    }
  }
  for (const plan::ForceBound& force : graph.forces) {
    if (force.mat == mat) add(force.liaison, force.stiffness, force.viscosity, weight[mat]);
  }
  if (!liaison) return "nothing but what is given from outside moves it";
  const scene::Called called = scene::call_liaison(scene, liaison);
  const std::string name = called.name + " (" + scene::place_text(called.place) + ")";
  char numbers[64];
  std::snprintf(numbers, sizeof(numbers), "K' + 2 Z' = %.3g of 4", sum);
  if (sum < 4.0) {
    const std::optional<plan::LiaisonId> endless = liaison_without_largest_slope(graph, mat);
    if (endless) {
      const scene::Called law = scene::call_liaison(scene, *endless);
      return "beyond what its step was certified for: " + law.name + " (" +
             scene::place_text(law.place) + ") has no largest slope, and so no limit";
    }
    return "not too stiff by its largest slopes (" + std::string(numbers) + "): " + name +
           " pulls the most at it, beyond what its law was taken for, or positions and forces from "
           "outside were too large";
  }
  return "too stiff for " + std::to_string(std::lround(scene.step_rate_hz)) + " Hz (" + numbers +
         "), of which the most is " + name;
}

std::string hint_of_divergence(const scene::Scene& scene, std::uint32_t mat) {
  if (const auto falling = falling_below_0(scene.network, mat)) {
    const scene::Called liaison = scene::call_liaison(scene, falling);
    return "The formula of " + liaison.name + " (" + scene::place_text(liaison.place) +
           ") may make its stiffness fall below 0, where it drives its ends apart at any step rate";
  }
  return "A step rate above " + std::to_string(std::lround(scene.step_rate_hz)) +
         " Hz, or less stiffness or viscosity, may hold it";
}

}  // namespace cordis::sim
