// sim_node/plan/stability/parameter_bounds.h -- what parameters that follow variables lie within.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// What K and Z of a state lie within at any values of the variables, each a number or a factor of variables
/// (see Expression::factor_size). Any number where nothing bounds them.
struct LinearBounds {
  Interval stiffness;  ///< [N/m], of a bend [N m/rad]
  Interval viscosity;  ///< [N s/m], of a bend [N m s/rad]
};

LinearBounds linear_bounds(const engine::LinkState& state, const Reach& reach);

/// Likewise over all states of a bend, or of a Maxwell element, where below 0 counts as 0.
LinearBounds linear_bounds(const engine::NetworkDescription& network, const engine::Bend& bend,
                           const Reach& reach);
LinearBounds linear_bounds(const engine::NetworkDescription& network,
                           const engine::MaxwellLink& link, const Reach& reach);

/// The most that Z is over K in one of the states of a bend [s]; infinite where one is viscous and may have no
/// stiffness.
double max_damping_ratio(const engine::NetworkDescription& network, const engine::Bend& bend,
                         const Reach& reach);

/// The most that a state machine stores at a point in the state of its start [J], at any values of the variables.
/// For a spring it is twice that. 0 where nothing bounds it.
double max_stored_in(const engine::StateMachine& state_machine, const engine::LawPoint& point,
                     const Reach& reach);

/// True if the elasticity of a state, its depth or its rest angle follows a variable: nothing bounds what that
/// brings in.
bool is_fed(const engine::StateMachine& state_machine) noexcept;

/// A network with the largest coefficients of friction and depths that formulas give it, for any values of the
/// variables. The formulas stay, for what asks where something changes.
struct LargestParameters {
  engine::NetworkDescription network;
  std::vector<bool> is_unbounded;  ///< by state machine: nothing bounds one of them, which is 0
};

/// Precondition: a state of the network has a formula.
LargestParameters largest_parameters(const engine::NetworkDescription& network);

/// True if a state of the network has a formula beside K and Z.
bool has_formulas(const engine::NetworkDescription& network) noexcept;

}  // namespace cordis::plan
