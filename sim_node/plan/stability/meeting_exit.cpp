// sim_node/plan/stability/meeting_exit.cpp
#include "sim_node/plan/stability/meeting_exit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

/// What the truth of a condition lies within at these elongations, at any speed, force and age.
Interval truth_at(const engine::Program& condition, const Interval& elongation, double rest_length,
                  const Reach& reach) {
  constexpr double kUnbounded = 1e9;  // [m/s]
  const auto asks = [&](engine::Quantity quantity) { return asks_for(condition, quantity); };
  if (asks_for_variable(condition)) return {0.0, 1.0};
  LinkBox box{{elongation.low + rest_length, elongation.high + rest_length},
              {-kUnbounded, kUnbounded},
              rest_length,
              reach.mass_a,
              reach.mass_b};
  // The elongation is known even then; the distance and the rest length are not.
  const bool asks_for_length =
      asks(engine::Quantity::kDistance) || asks(engine::Quantity::kRestLength);
  box.rest_moves = reach.rests_differ && asks_for_length;
  if (box.rest_moves) box.distance = {-kUnbounded, kUnbounded};
  return values_of(condition, box);
}

}  // namespace

double last_elongation_of(const engine::StateMachine& state_machine, std::size_t state,
                          double highest, double rest_length, const Reach& reach) {
  const auto truth = [&](const engine::Transition& exit, double lowest) {
    return truth_at(exit.when, {lowest, highest}, rest_length, reach);
  };
  const auto is_left_alone = [&](double lowest) {
    bool ends = false;
    for (std::size_t from = 0; from < state_machine.states.size(); ++from) {
      const engine::LinkState& in = state_machine.states[from];
      for (std::uint32_t e = in.first_exit; e < in.last_exit; ++e) {
        const engine::Transition& exit = state_machine.exits[e];
        const Interval holds = truth(exit, lowest);
        const bool surely_fails = holds.low == 0.0 && holds.high == 0.0;
        const bool surely_holds = holds.low > 0.0 || holds.high < 0.0;
        if (exit.target == state && !surely_fails) return false;
        if (from == state && surely_holds) ends = true;
      }
    }
    return ends;
  };
  constexpr int kHalvings = 60;
  double acts = -std::abs(rest_length);
  double ended = highest;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (acts + ended);
    (is_left_alone(middle) ? ended : acts) = middle;
  }
  return ended;
}

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
