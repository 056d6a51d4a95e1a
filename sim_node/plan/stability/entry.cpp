// sim_node/plan/stability/entry.cpp
#include "sim_node/plan/stability/entry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <variant>

#include "sim_node/plan/stability/program_enclosure.h"
#include "sim_node/plan/stability/slope.h"
#include "sim_node/plan/stability/stretch.h"

namespace cordis::plan {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();
constexpr double kAtRest = 1e-6;    // of the scale
constexpr double kFarAway = 1e3;    // scales
constexpr double kUnbounded = 1e9;  // [m], [m/s]

using Hull = std::optional<Interval>;

Hull hull_of(const Hull& a, const Hull& b) {
  if (!a || !b) return a ? a : b;
  return Interval{std::min(a->low, b->low), std::max(a->high, b->high)};
}

Hull overlap_of(const Hull& a, const Interval& b) {
  if (!a || a->high < b.low || b.high < a->low) return {};
  return Interval{std::max(a->low, b.low), std::min(a->high, b.high)};
}

bool is_flat_power(const engine::LinkState& state) {
  const auto* power = std::get_if<engine::Power>(&state.elasticity);
  return power != nullptr && power->exponent > 1.0 && is_none(state.dissipation);
}

/// True if what one state stores the other stores too, at every elongation.
bool store_alike(const engine::LinkState& a, const engine::LinkState& b) {
  const auto* power_a = std::get_if<engine::Power>(&a.elasticity);
  const auto* power_b = std::get_if<engine::Power>(&b.elasticity);
  const bool alike = power_a != nullptr && power_b != nullptr &&
                     power_a->coefficient == power_b->coefficient &&
                     power_a->exponent == power_b->exponent;
  return alike && a.stiffness == b.stiffness && a.pulls == b.pulls && a.pushes == b.pushes &&
         a.force_limit == b.force_limit;
}

/// Elongations side by side, fine near 0; the first and the last one have no end.
std::vector<Interval> cells_of(double scale) {
  constexpr double kGrowth = 1.1;
  std::vector<double> edges{0.0};
  for (double edge = kAtRest * scale; edge < kFarAway * scale; edge *= kGrowth) {
    edges.push_back(edge);
    edges.push_back(-edge);
  }
  edges.push_back(kAnywhere);
  edges.push_back(-kAnywhere);
  std::ranges::sort(edges);
  std::vector<Interval> cells;
  for (std::size_t i = 1; i < edges.size(); ++i) cells.push_back({edges[i - 1], edges[i]});
  return cells;
}

/// Where a condition may hold, and where it may not.
struct Condition {
  std::vector<bool> may_hold;  // per cell
  std::vector<bool> may_fail;
};

class Entries {
 public:
  Entries(const engine::StateMachine& machine, double rest_length, const Reach& reach)
      : machine_(machine),
        rest_length_(rest_length),
        reach_(reach),
        scale_(std::max({reach.elongation, std::abs(rest_length), 1e-3})),
        cells_(cells_of(scale_)),
        entered_(machine.states.size() + 1),
        brought_(machine.states.size() + 1, 0.0) {
    conditions_.resize(machine_.exits.size());
    for (const engine::LinkState& state : machine_.states) {
      for (std::uint32_t e = state.first_exit; e < state.last_exit; ++e)
        conditions_[e] = condition_of(state, machine_.exits[e]);
    }
    entered_.back() = reach_.begins;
  }

  /// What each state brings in where it is entered [J].
  std::vector<double> brought() {
    const std::size_t rounds = entered_.size() + 2;
    bool grows = true;
    for (std::size_t round = 0; grows && round < rounds; ++round) {
      grows = false;
      for (std::size_t from = 0; from < entered_.size(); ++from) {
        for (std::uint32_t e = in(from).first_exit; e < in(from).last_exit; ++e)
          grows = enter(from, machine_.exits[e], conditions_[e]) || grows;
      }
    }
    if (grows) std::ranges::fill(brought_, kAnywhere);
    return brought_;
  }

 private:
  /// The state of that number; the one after the last is that of the start, until it ends for the first time.
  const engine::LinkState& in(std::size_t number) const {
    return machine_.states[number < machine_.states.size() ? number : machine_.start];
  }

  Condition condition_of(const engine::LinkState& state, const engine::Transition& exit) const {
    const bool rest_moves = std::ranges::any_of(
        machine_.exits, [](const auto& each) { return each.rest != engine::RestRule::kKeep; });
    const auto asks = [&](engine::Quantity quantity) { return asks_for(exit.when, quantity); };
    LinkBox box{{}, {-kUnbounded, kUnbounded}, rest_length_, reach_.mass_a, reach_.mass_b};
    // The elongation is known even then; the distance and the rest length are not.
    box.rest_moves = (rest_moves || reach_.rests_differ) &&
                     (asks(engine::Quantity::kDistance) || asks(engine::Quantity::kRestLength));
    const bool has_force = state.stiffness > 0.0 || state.viscosity > 0.0 ||
                           !is_none(state.elasticity) || !is_none(state.dissipation);
    if (!has_force) box.force = {};
    const bool of_network = asks_for_variable(exit.when);  // it may come true anywhere
    Condition condition;
    for (const Interval& cell : cells_) {
      box.distance = {std::max(cell.low, -kUnbounded) + rest_length_,
                      std::min(cell.high, kUnbounded) + rest_length_};
      if (box.rest_moves) box.distance = {-kUnbounded, kUnbounded};
      const Interval holds = of_network ? Interval{0.0, 1.0} : values_of(exit.when, box);
      condition.may_hold.push_back(!(holds.low == 0.0 && holds.high == 0.0));
      condition.may_fail.push_back(!(holds.low > 0.0 || holds.high < 0.0));
    }
    return condition;
  }

  Reach reach_in(std::size_t state) const {
    Reach reach = reach_;
    reach.brought += brought_[state];
    return reach;
  }

  /// Wherever a state may be.
  Interval present(std::size_t state) const {
    const Interval by_law = elongations_within(in(state), rest_length_, reach_in(state));
    return *hull_of(entered_[state], by_law);
  }

  /// How far a step may go in a state: no farther than the energy stretches a power that is certified.
  double step_in(std::size_t state) const {
    Reach free = reach_in(state);
    free.held = false;
    double step = kAnywhere;
    for (const engine::LinkState& each : machine_.states) {
      if (!is_flat_power(each)) continue;
      const Stretch stretch = stretch_within(each, rest_length_, /*turns=*/false, free);
      step = std::min(step, std::max(stretch.longer, stretch.shorter));
    }
    return step;
  }

  /// Where a condition comes true in a state. It held nowhere in the sample before, or the state began there.
  Hull comes_true(std::size_t state, const Condition& condition) const {
    const Interval where = present(state);
    std::vector<bool> before(cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      before[i] = (condition.may_fail[i] && overlap_of(where, cells_[i])) ||
                  overlap_of(entered_[state], cells_[i]);
    }
    Hull found;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (!condition.may_hold[i]) continue;
      const Interval& cell = cells_[i];
      if (before[i]) found = hull_of(found, overlap_of(where, cell));
      if (i > 0 && before[i - 1]) found = hull_of(found, Interval{cell.low, cell.low});
      if (i + 1 < cells_.size() && before[i + 1])
        found = hull_of(found, Interval{cell.high, cell.high});
    }
    return found;
  }

  /// Likewise a step farther, as far as the condition holds there and the state goes.
  Hull a_step_beyond(std::size_t state, const Interval& where, const Condition& condition) const {
    const double step = step_in(state);
    const Interval all = present(state);
    const Interval wider{std::max(where.low - step, all.low),
                         std::min(where.high + step, all.high)};
    Hull found;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (condition.may_hold[i]) found = hull_of(found, overlap_of(wider, cells_[i]));
    }
    return found;
  }

  /// The most that a state stores somewhere [J]; infinite where that grows without an end.
  double max_stored(const engine::LinkState& state, const Interval& where) const {
    constexpr int kSamples = 64;
    const auto stored = [&](double e) {
      return stored_in(state, {rest_length_ + e, e, 0.0, reach_.mass_a.high, reach_.mass_b.high});
    };
    const double far = kFarAway * scale_;
    const double low = std::max(where.low, -far);
    const double high = std::min(where.high, far);
    if ((where.low < low && stored(low) > 0.0) || (where.high > high && stored(high) > 0.0))
      return kAnywhere;
    double most = 0.0;
    for (int i = 0; i <= kSamples; ++i)
      most = std::max(most, stored(low + (high - low) * i / kSamples));
    return most;
  }

  /// @return true if the target is entered elsewhere than known so far, or with more energy
  bool enter(std::size_t from, const engine::Transition& exit, const Condition& condition) {
    const std::size_t to = exit.target;
    const bool keeps = exit.rest == engine::RestRule::kKeep;
    if (!entered_[from] || (keeps && &in(from) == &in(to))) return false;
    Hull where;
    double brought = brought_[from];
    if (exit.rest == engine::RestRule::kHere) {
      where = Interval{};
    } else if (exit.rest == engine::RestRule::kExpression) {
      where = kAnyNumber;
      brought = kAnywhere;
    } else {
      where = comes_true(from, condition);
      if (!where) return false;
      const bool is_at_rest = std::max(-where->low, where->high) <= 1.5 * kAtRest * scale_;
      where = a_step_beyond(from, *where, condition);
      if (!is_at_rest && !store_alike(in(from), in(to))) brought += max_stored(in(to), *where);
    }
    constexpr double kMore = 1e-3;
    const Hull all = hull_of(entered_[to], where);
    const double slack =
        kMore * (entered_[to] ? entered_[to]->high - entered_[to]->low : 0.0) + kAtRest * scale_;
    const bool wider = !entered_[to] || all->low < entered_[to]->low - slack ||
                       all->high > entered_[to]->high + slack;
    const bool stronger = brought > brought_[to] + kMore * (brought_[to] + energy_at(reach_));
    entered_[to] = all;
    brought_[to] = std::max(brought_[to], brought);
    return wider || stronger;
  }

  const engine::StateMachine& machine_;
  double rest_length_;
  const Reach& reach_;
  double scale_;
  std::vector<Interval> cells_;
  std::vector<Condition> conditions_;  // of all exits
  std::vector<Hull> entered_;          // by in(): elongations where it begins; none: it never does
  std::vector<double> brought_;        // by in() [J]
};

}  // namespace

std::vector<Entry> entries_of(const engine::StateMachine& state_machine, double rest_length,
                              const Reach& reach) {
  std::vector<Entry> entries(state_machine.states.size());
  bool asks = false;
  for (const engine::Transition& exit : state_machine.exits) {
    entries[exit.target].by_a_change = true;
    asks = asks || is_flat_power(state_machine.states[exit.target]);
  }
  if (!asks) return entries;
  const std::vector<double> brought = Entries(state_machine, rest_length, reach).brought();
  for (std::size_t s = 0; s < entries.size(); ++s) entries[s].brought = brought[s];
  return entries;
}

}  // namespace cordis::plan
