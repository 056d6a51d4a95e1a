// sim_node/plan/stability/meeting_exit.cpp
#include "sim_node/plan/stability/meeting_exit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "sim_node/plan/stability/program_enclosure.h"

namespace cordis::plan {
namespace {

/// What a state pulls with at distances of up to `nearest` [N], at any speed.
Interval force_near(const engine::LinkState& state, double rest_length, bool rest_moves,
                    double nearest, const Reach& reach) {
  constexpr double kRounding = 1e-9;
  const bool is_known = !rest_moves && state.viscosity == 0.0 && is_none(state.dissipation);
  const auto* expression = std::get_if<engine::Expression>(&state.elasticity);
  Interval force = kAnyNumber;
  if (is_known && (expression == nullptr || expression->is_potential())) {
    const double elongation = nearest - rest_length;
    const Interval law = tension_between(state.elasticity, nearest, elongation, reach);
    force = {state.stiffness * elongation + law.low, state.stiffness * elongation + law.high};
  }
  const double lowest = state.pushes ? -state.force_limit : 0.0;
  const double highest = state.pulls ? state.force_limit : 0.0;
  force = {std::clamp(force.low, lowest, highest), std::clamp(force.high, lowest, highest)};
  const auto spare = [](double tension) {
    return std::isfinite(tension) ? kRounding * std::abs(tension) : 0.0;
  };
  return {force.low - spare(force.low), force.high + spare(force.high)};
}

}  // namespace

bool may_end_where_ends_meet(const engine::StateMachine& state_machine, std::size_t state,
                             double rest_length, const Reach& reach) {
  if (asks_for_variable(state_machine)) return false;
  const bool rest_moves = std::ranges::any_of(
      state_machine.exits,
      [](const engine::Transition& exit) { return exit.rest != engine::RestRule::kKeep; });
  const engine::LinkState& in = state_machine.states[state];
  const double nearest = 1e-9 * std::max({reach.elongation, std::abs(rest_length), 1e-6});
  const double speed = relative_speed(in, reach);
  LinkBox box{{0.0, nearest}, {-speed, speed}, rest_length, reach.mass_a, reach.mass_b};
  box.rest_moves = rest_moves;
  box.force = force_near(in, rest_length, rest_moves, nearest, reach);
  const auto first = state_machine.exits.begin() + in.first_exit;
  const auto last = state_machine.exits.begin() + in.last_exit;
  constexpr double kLong = 1e9;  // [s], [N s]
  return std::any_of(first, last, [&](const engine::Transition& exit) {
    return std::ranges::all_of(std::array{0.0, kLong}, [&](double remembered) {
      box.remembered = {remembered, remembered};
      const Interval holds = values_of(exit.when, box);
      return !(holds.low == 0.0 && holds.high == 0.0);
    });
  });
}

}  // namespace cordis::plan
