// sim_node/plan/stability/condition_map.cpp
#include "sim_node/plan/stability/condition_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim_node/plan/stability/law_energy.h"
#include "sim_node/plan/stability/program_enclosure.h"

namespace cordis::plan {
namespace {

constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();
constexpr double kWidest = 1e9;         // [m], [m/s]
constexpr double kBarelyMoving = 1e-9;  // [m/s]
constexpr Interval kAnySpeed{-kWidest, kWidest};

std::vector<Interval> cells_between(std::vector<double> edges) {
  std::ranges::sort(edges);
  std::vector<Interval> cells;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i] > edges[i - 1]) cells.push_back({edges[i - 1], edges[i]});
  }
  return cells;
}

bool surely_holds(const Interval& truth) {
  return truth.low > 0.0 || truth.high < 0.0;
}

bool surely_fails(const Interval& truth) {
  return truth.low == 0.0 && truth.high == 0.0;
}

/// The rest lengths after a change, at most two: any.
std::vector<double> rests_after(const std::vector<double>& before, const engine::Transition& exit) {
  constexpr double kAnyLength = std::numeric_limits<double>::quiet_NaN();
  if (exit.rest == engine::RestRule::kKeep) return before;
  const std::vector<engine::Instruction>& code = exit.rest_length.code;
  if (exit.rest == engine::RestRule::kExpression && code.size() == 1 &&
      code[0].operation == engine::Operation::kConstant)
    return {code[0].constant};
  return {kAnyLength, kAnyLength};
}

/// What a state pulled with in the step before, at elongations in a cell [N].
Interval force_in(const engine::LinkState& state, double rest_length, const Interval& cell,
                  const Reach& reach) {
  const bool has_force = state.stiffness > 0.0 || state.viscosity > 0.0 ||
                         !is_none(state.elasticity) || !is_none(state.dissipation);
  if (!has_force) return {};
  Interval force = kAnyNumber;
  if (is_none(state.dissipation) && std::isfinite(cell.low) && std::isfinite(cell.high)) {
    const Interval a = tension_at(state, rest_length + cell.low, rest_length, reach);
    const Interval b = tension_at(state, rest_length + cell.high, rest_length, reach);
    const double drag =
        state.viscosity > 0.0 ? state.viscosity * relative_speed(state, reach) : 0.0;
    force = {std::min(a.low, b.low) - drag, std::max(a.high, b.high) + drag};
  }
  const double lowest = state.pushes ? -state.force_limit : 0.0;
  const double highest = state.pulls ? state.force_limit : 0.0;
  return {std::clamp(force.low, lowest, highest), std::clamp(force.high, lowest, highest)};
}

}  // namespace

ConditionMap::ConditionMap(const engine::StateMachine& machine, double rest_length, double step,
                           const Reach& reach)
    : machine_(machine),
      rest_length_(rest_length),
      step_(step),
      reach_(reach),
      scale_(std::max({reach.elongation, std::abs(rest_length), 1e-3})),
      rests_(machine.states.size()),
      exits_(machine.exits.size()) {
  find_known_rests();
  cells_ = cells_between(edges());
  refine();
  for (std::size_t s = 0; s < machine.states.size(); ++s) {
    for (std::uint32_t e = machine.states[s].first_exit; e < machine.states[s].last_exit; ++e)
      exits_[e] = holding_of(s, machine.exits[e]);
  }
}

/// Where the last cell begins: beyond every number that a condition names [m].
double ConditionMap::far_away() const {
  constexpr double kScales = 1e3;
  double farthest = scale_;
  for (const engine::Transition& exit : machine_.exits) {
    for (const engine::Instruction& instruction : exit.when.code) {
      if (instruction.operation == engine::Operation::kConstant &&
          std::isfinite(instruction.constant))
        farthest = std::max(farthest, std::min(std::abs(instruction.constant), kWidest / kScales));
    }
  }
  return kScales * farthest;
}

std::vector<double> ConditionMap::edges() const {
  constexpr double kGrowth = 1.3;
  std::vector<double> edges{0.0, kInfinitelyFar, -kInfinitelyFar};
  const double end = far_away();
  for (double edge = kAtRest * scale_; edge < end; edge *= kGrowth) {
    edges.push_back(edge);
    edges.push_back(-edge);
  }
  for (const engine::LinkState& state : machine_.states) {
    const auto* table = std::get_if<engine::Table>(&state.elasticity);
    if (table != nullptr)
      edges.insert(edges.end(), table->argument().begin(), table->argument().end());
  }
  return edges;
}

/// What a liaison may have pulled with in the step before one in a state, whose elongation is in a cell [N]. It may have
/// been in another state then.
Interval ConditionMap::force_before(std::size_t state, const Interval& cell) const {
  const Interval around{cell.low - step_, cell.high + step_};
  Interval force = force_in(machine_.states[state], rest(state), around, reach_);
  for (std::size_t s = 0; s < machine_.states.size(); ++s) {
    const engine::LinkState& before = machine_.states[s];
    for (std::uint32_t e = before.first_exit; e < before.last_exit; ++e) {
      if (machine_.exits[e].target != state) continue;
      const Interval other = force_in(before, rest(s), around, reach_);
      force = {std::min(force.low, other.low), std::max(force.high, other.high)};
    }
  }
  return force;
}

void ConditionMap::find_known_rests() {
  if (reach_.rests_differ) return;
  rests_[machine_.start] = {rest_length_};
  const auto add = [&](std::size_t state, const std::vector<double>& lengths) {
    bool adds = false;
    for (const double length : lengths) {
      std::vector<double>& known = rests_[state];
      if (known.size() > 1 || std::ranges::find(known, length) != known.end()) continue;
      known.push_back(length);
      adds = true;
    }
    return adds;
  };
  for (bool changes = true; changes;) {
    changes = false;
    for (std::size_t s = 0; s < machine_.states.size(); ++s) {
      const engine::LinkState& state = machine_.states[s];
      for (std::uint32_t e = state.first_exit; e < state.last_exit; ++e) {
        const engine::Transition& exit = machine_.exits[e];
        changes = add(exit.target, rests_after(rests_[s], exit)) || changes;
      }
    }
  }
}

Interval ConditionMap::truth(std::size_t state, const engine::Transition& exit,
                             const Interval& cell, const Interval& speed) const {
  const double rest_length = rest(state);
  const auto asks = [&](engine::Quantity quantity) { return asks_for(exit.when, quantity); };
  LinkBox box{
      {std::max(cell.low, -kWidest) + rest_length, std::min(cell.high, kWidest) + rest_length},
      speed,
      rest_length,
      reach_.mass_a,
      reach_.mass_b};
  // The elongation is known even then; the distance and the rest length are not.
  box.rest_moves = !knows_rest(state) &&
                   (asks(engine::Quantity::kDistance) || asks(engine::Quantity::kRestLength));
  if (box.rest_moves) box.distance = {-kWidest, kWidest};
  if (asks(engine::Quantity::kForce)) box.force = force_before(state, cell);
  const Interval value = values_of(exit.when, box);
  const bool is_number = !std::isnan(value.low) && !std::isnan(value.high);
  if (!is_number) return {0.0, 1.0};
  if (asks_for_variable(exit.when))  // it never surely holds
    return {std::min(value.low, 0.0), std::max(value.high, 0.0)};
  return value;
}

/// Adds the two ends of what is left of a cell in which a condition has its threshold.
void ConditionMap::refine() {
  constexpr int kHalvings = 40;
  std::vector<double> edges = this->edges();
  for (std::size_t s = 0; s < machine_.states.size(); ++s) {
    const engine::LinkState& state = machine_.states[s];
    for (std::uint32_t e = state.first_exit; e < state.last_exit; ++e) {
      const auto sureness = [&](const Interval& cell) {
        const Interval found = truth(s, machine_.exits[e], cell, kAnySpeed);
        return surely_holds(found) ? 1 : surely_fails(found) ? -1 : 0;
      };
      std::vector<int> all;
      for (const Interval& cell : cells_) all.push_back(sureness(cell));
      for (std::size_t i = 1; i + 1 < cells_.size(); ++i) {
        if (all[i] != 0 || all[i - 1] == 0 || all[i + 1] != -all[i - 1]) continue;
        Interval rest = cells_[i];
        for (int n = 0; n < kHalvings; ++n) {
          const double middle = 0.5 * (rest.low + rest.high);
          if (sureness({rest.low, middle}) == all[i - 1]) {
            rest.low = middle;
          } else if (sureness({middle, rest.high}) == all[i + 1]) {
            rest.high = middle;
          } else {
            break;
          }
        }
        edges.push_back(rest.low);
        edges.push_back(rest.high);
      }
    }
  }
  cells_ = cells_between(edges);
}

Holding ConditionMap::holding_of(std::size_t state, const engine::Transition& exit) const {
  const bool asks_for_speed = asks_for(exit.when, engine::Quantity::kSpeed);
  Holding holding;
  for (const Interval& cell : cells_) {
    const Interval any = truth(state, exit, cell, kAnySpeed);
    holding.may_hold.push_back(!surely_fails(any));
    holding.may_fail.push_back(!surely_holds(any));
    const auto may_fail_at = [&](const Interval& speed) {
      return asks_for_speed ? !surely_holds(truth(state, exit, cell, speed)) : !surely_holds(any);
    };
    holding.may_fail_shortening.push_back(may_fail_at({-kWidest, -kBarelyMoving}));
    holding.may_fail_lengthening.push_back(may_fail_at({kBarelyMoving, kWidest}));
  }
  return holding;
}

}  // namespace cordis::plan
