// sim_node/plan/stability/parameter_bounds.cpp
#include "sim_node/plan/stability/parameter_bounds.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "sim_node/plan/stability/law_energy.h"
#include "sim_node/plan/stability/slope.h"

namespace cordis::plan {
namespace {

/// The values of a program for an elongation of 1 m and a speed of 1 m/s: those of the factor of either.
Interval values_for_one(const engine::Program& program, const std::vector<Interval>* variables) {
  LinkBox box;
  box.distance = box.speed = {1.0, 1.0};
  box.mass_a = box.mass_b = {0.0, 0.0};
  box.variables = variables;
  const Interval value = values_of(program, box);
  if (std::isnan(value.low) || std::isnan(value.high)) return kAnyNumber;
  return value;
}

Interval sum(const Interval& interval, double number) noexcept {
  return {interval.low + number, interval.high + number};
}

Interval factor_bounds(const engine::Law& law, engine::Quantity of, double number,
                       const Reach& reach) {
  if (!engine::is_product(law, of)) return {number, number};
  return sum(values_for_one(std::get<engine::Expression>(law).program, reach.variables.get()),
             number);
}

void widen(Interval& interval, const Interval& more) noexcept {
  interval = {std::min(interval.low, more.low), std::max(interval.high, more.high)};
}

/// The largest value of a formula, at least 0; nothing where there is none, infinite where nothing bounds it.
double largest_value(const engine::Program& formula, const std::vector<Interval>& variables) {
  return std::max(values_for_one(formula, &variables).high, 0.0);
}

void put_largest(engine::StateMachine& state_machine, const std::vector<Interval>& variables,
                 std::vector<bool>::reference is_unbounded) {
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    engine::LinkState& state = state_machine.states[s];
    engine::Friction friction = friction_in(state_machine, s);
    bool has_friction = false;
    for (const auto& [parameter, formula] : state.formulas) {
      if (parameter == engine::Parameter::kRestAngle) continue;
      double value = largest_value(formula, variables);
      if (!std::isfinite(value)) {
        is_unbounded = true;
        value = 0.0;
      }
      if (parameter == engine::Parameter::kDepth) {
        std::get<engine::LennardJones>(state.elasticity).well_depth = value;
        continue;
      }
      has_friction = true;
      (parameter == engine::Parameter::kStaticFriction ? friction.static_coefficient
                                                       : friction.kinetic_coefficient) = value;
    }
    if (!has_friction) continue;
    friction.kinetic_coefficient =
        std::min(friction.kinetic_coefficient, friction.static_coefficient);
    state.friction = friction;
  }
}

}  // namespace

LinearBounds linear_bounds(const engine::LinkState& state, const Reach& reach) {
  return {factor_bounds(state.elasticity, engine::Quantity::kElongation, state.stiffness, reach),
          factor_bounds(state.dissipation, engine::Quantity::kSpeed, state.viscosity, reach)};
}

LinearBounds linear_bounds(const engine::NetworkDescription& network, const engine::Bend& bend,
                           const Reach& reach) {
  if (!bend.has_states()) {
    return {{bend.stiffness, bend.stiffness}, {bend.viscosity, bend.viscosity}};
  }
  const std::vector<engine::LinkState>& states = network.state_machines[bend.state_machine].states;
  LinearBounds all = linear_bounds(states.front(), reach);
  for (const engine::LinkState& state : states) {
    const LinearBounds one = linear_bounds(state, reach);
    widen(all.stiffness, one.stiffness);
    widen(all.viscosity, one.viscosity);
  }
  return all;
}

LinearBounds linear_bounds(const engine::NetworkDescription& network,
                           const engine::MaxwellLink& link, const Reach& reach) {
  if (!link.follows_variables()) {
    return {{link.stiffness, link.stiffness}, {link.viscosity, link.viscosity}};
  }
  LinearBounds bounds =
      linear_bounds(network.state_machines[link.state_machine].states.front(), reach);
  for (Interval* const one : {&bounds.stiffness, &bounds.viscosity})
    *one = {std::max(one->low, 0.0), std::max(one->high, 0.0)};
  return bounds;
}

double max_damping_ratio(const engine::NetworkDescription& network, const engine::Bend& bend,
                         const Reach& reach) {
  if (!bend.has_states()) return damping_ratio(bend.viscosity, bend.stiffness);
  double most = 0.0;
  for (const engine::LinkState& state : network.state_machines[bend.state_machine].states) {
    const LinearBounds bounds = linear_bounds(state, reach);
    most = std::max(most, damping_ratio(bounds.viscosity.high, bounds.stiffness.low));
  }
  return most;
}

double max_stored_in(const engine::StateMachine& state_machine, const engine::LawPoint& point,
                     const Reach& reach) {
  const engine::LinkState& state = state_machine.states[state_machine.start];
  if (!engine::asks_for_variable(state.elasticity)) return stored_in(state_machine, point);
  const Interval tension =
      tension_at(state, point.distance, point.distance - point.elongation, reach);
  const double most =
      std::max(std::abs(tension.low), std::abs(tension.high)) * std::abs(point.elongation);
  return std::isfinite(most) ? most : 0.0;
}

bool is_fed(const engine::StateMachine& state_machine) noexcept {
  return std::ranges::any_of(state_machine.states, [](const engine::LinkState& state) {
    return engine::asks_for_variable(state.elasticity) ||
           formula_of(state, engine::Parameter::kDepth) != nullptr ||
           formula_of(state, engine::Parameter::kRestAngle) != nullptr;
  });
}

bool has_formulas(const engine::NetworkDescription& network) noexcept {
  return std::ranges::any_of(network.state_machines, [](const engine::StateMachine& machine) {
    return std::ranges::any_of(
        machine.states, [](const engine::LinkState& state) { return !state.formulas.empty(); });
  });
}

LargestParameters largest_parameters(const engine::NetworkDescription& network) {
  LargestParameters largest{network, std::vector<bool>(network.state_machines.size(), false)};
  std::vector<Interval> variables;
  for (const engine::Variable& variable : network.variables)
    variables.push_back(range_of_variable(network, variable));
  for (std::size_t m = 0; m < network.state_machines.size(); ++m)
    put_largest(largest.network.state_machines[m], variables, largest.is_unbounded[m]);
  return largest;
}

}  // namespace cordis::plan
