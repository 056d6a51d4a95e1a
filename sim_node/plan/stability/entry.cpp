// sim_node/plan/stability/entry.cpp
#include "sim_node/plan/stability/entry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "sim_node/plan/stability/condition_map.h"
#include "sim_node/plan/stability/state_potential.h"
#include "sim_node/plan/stability/stretch.h"

namespace cordis::plan {
namespace {

constexpr double kBoundless = std::numeric_limits<double>::infinity();
constexpr double kAlike = 1e-4;            // of what is stored
constexpr double kQuadratureError = 1e-8;  // likewise
constexpr double kNegligible = 1e-9;       // of the energy of the scene

using Hull = std::optional<Interval>;

Hull hull_of(const Hull& a, const Hull& b) {
  if (!a || !b) return a ? a : b;
  return Interval{std::min(a->low, b->low), std::max(a->high, b->high)};
}

Hull overlap_of(const Interval& a, const Interval& b) {
  if (a.high < b.low || b.high < a.low) return {};
  return Interval{std::max(a.low, b.low), std::min(a.high, b.high)};
}

/// What touches or overlaps becomes one part.
std::vector<Interval> merged(std::vector<Interval> parts) {
  std::ranges::sort(parts, {}, &Interval::low);
  std::vector<Interval> all;
  for (const Interval& part : parts) {
    if (all.empty() || part.low > all.back().high) {
      all.push_back(part);
    } else {
      all.back().high = std::max(all.back().high, part.high);
    }
  }
  return all;
}

/// True if the elongation of a law does not say what it does, for it asks for the distance.
bool is_of_distance(const engine::Law& law) {
  if (const auto* expression = std::get_if<engine::Expression>(&law))
    return asks_for(expression->program, engine::Quantity::kDistance) ||
           asks_for(expression->program, engine::Quantity::kRestLength);
  return std::holds_alternative<engine::LennardJones>(law) ||
         std::holds_alternative<engine::Rings>(law);
}

bool is_elastic(const engine::LinkState& state) {
  return state.stiffness > 0.0 || !is_none(state.elasticity);
}

/// How far a step may go in a state [m]: at most as fast as all energy makes it, for the longest step of the stiffest
/// state; no farther than the energy stretches a power that is certified.
double step_of(const engine::StateMachine& machine, const engine::LinkState& state,
               double rest_length, const Reach& reach) {
  if (reach.inverse_mass == 0.0) return 0.0;
  Reach free = reach;
  free.held = false;
  double stiffest = 0.0;
  double step = kBoundless;
  for (const engine::LinkState& each : machine.states) {
    stiffest = std::max(stiffest, each.stiffness);
    if (!std::holds_alternative<engine::Power>(each.elasticity)) continue;
    const Stretch stretch = stretch_within(each, rest_length, /*turns=*/false, free);
    step = std::min(step, std::max(stretch.longer, stretch.shorter));
  }
  const double longest =
      std::min(reach.longest_step, 2.0 / std::sqrt(stiffest * reach.inverse_mass));
  return std::min(step, relative_speed(state, reach) * longest);
}

double farthest_step_of(const engine::StateMachine& machine, double rest_length,
                        const Reach& reach) {
  double longest = 0.0;
  for (const engine::LinkState& state : machine.states)
    longest = std::max(longest, step_of(machine, state, rest_length, reach));
  return longest;
}

/// The ways through the states of a liaison, and what they bring in.
class Ways {
 public:
  /// @param reach_of_step  of how far a step goes
  Ways(const engine::StateMachine& machine, double rest_length, const Interval& possible,
       double share, const Reach& reach_of_step, const Reach& reach)
      : machine_(machine),
        rest_length_(rest_length),
        possible_(possible),
        moves_rest_(std::ranges::any_of(
            machine.exits, [](const auto& exit) { return exit.rest != engine::RestRule::kKeep; })),
        reach_(reach),
        map_(machine, rest_length, farthest_step_of(machine, rest_length, reach_of_step), reach),
        entered_(machine.states.size() + 1),
        carried_(entered_.size()),
        moved_(entered_.size()),
        present_(entered_.size()),
        passes_fold_(entered_.size(), false),
        lowest_(entered_.size(), 0.0),
        brought_(entered_.size(), -kBoundless) {
    for (std::size_t s = 0; s < machine.states.size(); ++s)
      potentials_.emplace_back(machine.states[s], map_.rest(s), map_.cells(), share, reach);
    entered_.back() = reach.begins;
    brought_.back() = 0.0;
    if (std::isfinite(reach.range)) {  // a pair that comes back into range begins again
      const double back = reach.range - rest_length;
      entered_[machine.start] = reach.rests_differ ? reach.begins : Interval{back, back};
      brought_[machine.start] = 0.0;
    }
  }

  /// What has been brought in where each state is entered [J]; infinite: nothing bounds it.
  std::vector<double> brought() {
    const std::size_t rounds = 2 * entered_.size() + 2;
    for (std::size_t round = 0; round < rounds; ++round) {
      for (std::size_t node = 0; node < entered_.size(); ++node) find_present(node);
      const bool wider = take_all();
      const std::vector<double> before = std::exchange(brought_, sums_over_ways());
      const bool endless = std::ranges::count(brought_, kBoundless) > 0;
      if (wider) {  // some of it may end where a state is known to go farther
        if (endless) brought_ = before;
        continue;
      }
      if (endless) break;
      bool grows = false;
      for (std::size_t node = 0; node < entered_.size(); ++node)
        grows = grows || brought_[node] > before[node] + kAlike * energy_at(reach_in(node));
      if (grows) continue;
      std::vector<double> all(brought_.begin(), brought_.end() - 1);
      for (double& one : all) one = std::max(one, 0.0);
      return all;
    }
    return std::vector<double>(machine_.states.size(), kBoundless);
  }

 private:
  std::size_t number(std::size_t node) const {
    return node < machine_.states.size() ? node : machine_.start;
  }
  /// The state of that number; the one after the last is that of the start, until it ends for the first time.
  const engine::LinkState& in(std::size_t node) const { return machine_.states[number(node)]; }

  Reach reach_in(std::size_t node) const {
    Reach reach = reach_;
    reach.brought += std::max(brought_[node], 0.0);
    return reach;
  }

  bool is_at_first_rest(std::size_t node) const {
    return map_.knows_rest(number(node)) && map_.rest(number(node)) == rest_length_;
  }

  /// True if an exit changes nothing.
  bool is_idle(std::size_t node, const engine::Transition& exit) const {
    return exit.rest == engine::RestRule::kKeep && exit.target == number(node);
  }

  /// True if nothing surely ends a state in a cell. The first exit that holds is taken, also one that changes nothing.
  /// @param may_fail  of Holding, on the way out of where the state begins
  bool may_stay(std::size_t node, std::size_t cell, std::vector<bool> Holding::*may_fail) const {
    for (std::uint32_t e = in(node).first_exit; e < in(node).last_exit; ++e) {
      if (is_idle(node, machine_.exits[e]) && map_.of_exit(e).may_hold[cell]) return true;
      if (!(map_.of_exit(e).*may_fail)[cell]) return false;
    }
    return true;
  }

  /// Where a state may be in its last step, if an exit surely holds where it begins. The start is looked at before it
  /// moves.
  Hull moved_in(std::size_t node) const {
    if (node == machine_.states.size()) return {};
    const std::vector<Interval>& cells = map_.cells();
    const double slack = ConditionMap::kAtRest * map_.scale();
    std::vector<Interval> ends;
    bool may_go_on = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Hull began = overlap_of(*entered_[node], cells[i]);
      if (!began) continue;
      if (may_stay(node, i, &Holding::may_fail)) {
        may_go_on = true;
      } else {
        ends.push_back(*began);
      }
    }
    if (may_go_on) {  // it only touches these cells
      std::erase_if(ends, [&](const Interval& part) { return part.high - part.low <= slack; });
    }
    if (ends.empty()) return {};
    const double step = step_in(node);
    return overlap_of({ends.front().low - step, ends.back().high + step}, *carried_[node]);
  }

  /// An angle that goes on beyond a half turn comes back from the other side.
  bool turns_around() const { return possible_.low < 0.0 && std::isfinite(possible_.high); }

  /// True if an angle gets to where it comes back from the other side.
  bool reaches_fold(const Interval& part) const {
    return turns_around() && (part.low <= possible_.low || part.high >= possible_.high);
  }

  /// From where on an exit surely ends a state on the way out, in cells so wide that no step passes them [m].
  /// @param from   where the state begins
  /// @param parts  the ends part; else they come nearer
  double surely_ended(std::size_t node, double from, bool parts, double step) const {
    const std::vector<Interval>& cells = map_.cells();
    const auto may_fail = parts ? &Holding::may_fail_lengthening : &Holding::may_fail_shortening;
    std::optional<double> begin;
    for (std::size_t n = 0; n < cells.size(); ++n) {
      const std::size_t i = parts ? n : cells.size() - 1 - n;
      const double near = parts ? cells[i].low : cells[i].high;
      const double far = parts ? cells[i].high : cells[i].low;
      if (parts ? near < from : near > from) continue;
      if (may_stay(node, i, may_fail)) {
        begin.reset();
        continue;
      }
      if (!begin) begin = near;
      if (std::abs(far - *begin) >= step) return *begin;
    }
    return parts ? kBoundless : -kBoundless;
  }

  /// Wherever a state may be: as far as the energy carries it, and no exit surely ends it on the way.
  void find_present(std::size_t node) {
    if (!entered_[node]) return;
    const Interval began = *entered_[node];
    Interval all =
        *hull_of(began, elongations_within(in(node), map_.rest(number(node)), reach_in(node)));
    if (is_at_first_rest(node) || std::isfinite(possible_.high)) {
      all.low = std::min(std::max(all.low, possible_.low), began.low);
      all.high = std::max(std::min(all.high, possible_.high), began.high);
    }
    if (reaches_fold(all)) all = possible_;
    carried_[node] = all;
    const double step = step_in(node);
    all.high = std::min(all.high, surely_ended(node, began.high, /*parts=*/true, step));
    all.low = std::max(all.low, surely_ended(node, began.low, /*parts=*/false, step));
    passes_fold_[node] = reaches_fold(all);
    if (passes_fold_[node]) all = possible_;
    // Beyond its range no pair is in the state of the start.
    const bool has_range = number(node) == machine_.start && std::isfinite(reach_.range);
    if (has_range && (is_at_first_rest(node) || !moves_rest_))
      all.high = std::max(began.high, std::min(all.high, reach_.range - rest_length_));
    moved_[node] = moved_in(node);
    present_[node] = *hull_of(all, moved_[node]);
    const bool is_known = map_.knows_rest(number(node)) || !is_of_distance(in(node).elasticity);
    lowest_[node] = is_known ? potentials_[number(node)].least(*present_[node]) : -kBoundless;
  }

  /// Where an exit comes true.
  struct Place {
    Interval part;
    bool is_at_threshold = false;  // beyond it the exit surely holds, and before it surely not
  };

  /// True if beyond a cell an exit surely holds, and before it surely not.
  static bool is_threshold(const Holding& exit, std::size_t cell) {
    const auto surely_holds = [&](std::size_t i) { return !exit.may_fail[i]; };
    const auto surely_fails = [&](std::size_t i) { return !exit.may_hold[i]; };
    if (cell == 0 || cell + 1 == exit.may_hold.size()) return false;
    const std::size_t before = cell - 1;
    const std::size_t after = cell + 1;
    if (surely_holds(cell)) return surely_fails(before) || surely_fails(after);
    return (surely_fails(before) && surely_holds(after)) ||
           (surely_holds(before) && surely_fails(after));
  }

  /// It held nowhere in the sample before, or the state began there.
  std::vector<Place> comes_true(std::size_t node, const Holding& exit) const {
    const std::vector<Interval>& cells = map_.cells();
    const Interval& where = *present_[node];
    std::vector<bool> before(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      before[i] = (exit.may_fail[i] && overlap_of(where, cells[i])) ||
                  overlap_of(*entered_[node], cells[i]) ||
                  (moved_[node] && overlap_of(*moved_[node], cells[i])) ||
                  (passes_fold_[node] && (overlap_of({possible_.low, possible_.low}, cells[i]) ||
                                          overlap_of({possible_.high, possible_.high}, cells[i])));
    }
    std::vector<Place> found;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!exit.may_hold[i]) continue;
      const auto add = [&](const Interval& part) {
        if (const Hull here = overlap_of(where, part))
          found.push_back({*here, is_threshold(exit, i)});
      };
      if (before[i]) {
        add(cells[i]);
      } else {
        if (i > 0 && before[i - 1]) add({cells[i].low, cells[i].low});
        if (i + 1 < cells.size() && before[i + 1]) add({cells[i].high, cells[i].high});
      }
    }
    return found;
  }

  /// How far a step may go in a state [m].
  double step_in(std::size_t node) const {
    return step_of(machine_, in(node), rest_length_, reach_in(node));
  }

  /// The elongation after a change to an expression; none: it may be any.
  std::optional<double> renewed(const engine::Transition& exit, std::size_t state,
                                double elongation) const {
    using engine::Quantity;
    for (const Quantity each :
         {Quantity::kSpeed, Quantity::kSpeedX, Quantity::kSpeedY, Quantity::kSpeedZ,
          Quantity::kSlip, Quantity::kForce, Quantity::kImpulse, Quantity::kAge, Quantity::kSlid}) {
      if (asks_for(exit.rest_length, each)) return {};
    }
    if (asks_for_variable(exit.rest_length) || has_edge(exit.rest_length)) return {};
    const auto after = [&](double rest) {
      engine::LinkQuantities now{};
      const auto set = [&](Quantity quantity, double value) {
        now[static_cast<std::size_t>(quantity)] = value;
      };
      set(Quantity::kDistance, rest + elongation);
      set(Quantity::kElongation, elongation);
      set(Quantity::kRestLength, rest);
      set(Quantity::kMassA, reach_.mass_a.high);
      set(Quantity::kMassB, reach_.mass_b.high);
      return rest + elongation - value_of(exit.rest_length, now);
    };
    const double here = after(map_.rest(state));
    if (!std::isfinite(here)) return {};
    if (map_.knows_rest(state)) return here;
    const double scale = map_.scale();
    for (const double other :
         {0.0, 2.0 * scale, -3.0 * scale}) {  // does it move along with the rest?
      if (!(std::abs(after(rest_length_ + other) - here) <= 1e-9 * scale)) return {};
    }
    return here;
  }

  /// What a change brings in at an elongation [J], and to which it leads.
  struct Change {
    double brings = 0.0;
    Hull leads_to;
  };

  Change change_at(std::size_t node, const engine::Transition& exit, double elongation) const {
    const StatePotential& before = potentials_[number(node)];
    const std::size_t to = exit.target;
    double next = elongation;
    if (exit.rest == engine::RestRule::kHere) next = 0.0;
    if (exit.rest == engine::RestRule::kExpression) {
      const std::optional<double> found = renewed(exit, number(node), elongation);
      if (!found) return {is_elastic(machine_.states[to]) ? kBoundless : 0.0, kAnyNumber};
      next = *found;
    }
    // Where the target was not entered so far, what it gives is found in the next round.
    const double lowest_after =
        present_[to] ? std::min(lowest_[to], potentials_[to].at(next)) : potentials_[to].at(next);
    const double stored = before.at(elongation) - lowest_[node];
    const double gives = potentials_[to].at(next) - lowest_after;
    if (std::isinf(lowest_after))
      return {std::isinf(lowest_[node]) && is_alike(number(node), to) ? 0.0 : kBoundless,
              Interval{next, next}};
    return {gives - stored - kQuadratureError * (std::abs(gives) + std::min(stored, 1e300)),
            Interval{next, next}};
  }

  /// True if two states store the same wherever they are.
  bool is_alike(std::size_t a, std::size_t b) const {
    const std::vector<double>& edges = potentials_[a].edges();
    return std::ranges::all_of(edges, [&](double e) {
      const double one = potentials_[a].at(e);
      const double other = potentials_[b].at(e);
      return std::abs(one - other) <= kAlike * std::abs(one);
    });
  }

  Change change_within(std::size_t node, const engine::Transition& exit,
                       const Interval& part) const {
    const std::vector<double>& edges = potentials_[number(node)].edges();
    Change all{-kBoundless, {}};
    const auto take_in = [&](double elongation) {
      const Change one = change_at(node, exit, elongation);
      all.brings = std::max(all.brings, one.brings);
      all.leads_to = hull_of(all.leads_to, one.leads_to);
      return one.brings;
    };
    const auto ends_far = [&](double far, double nearer) {
      const double there = take_in(far);
      if (there > change_at(node, exit, nearer).brings + kAlike * std::abs(there) && there > 0.0)
        all.brings = kBoundless;
    };
    const std::size_t last = edges.size() - 1;
    if (part.low < edges.front()) ends_far(edges[0], edges[1]);
    if (part.high > edges.back()) ends_far(edges[last], edges[last - 1]);
    take_in(std::clamp(part.low, edges.front(), edges.back()));
    take_in(std::clamp(part.high, edges.front(), edges.back()));
    for (const double edge : edges) {
      if (edge > part.low && edge < part.high) take_in(edge);
    }
    const bool keeps = exit.rest == engine::RestRule::kKeep;
    if (keeps) all.leads_to = hull_of(all.leads_to, part);
    return all;
  }

  /// Where it comes true, and a step beyond where a change brings in more or less from place to place, for the force
  /// jumps.
  std::vector<Interval> overshot(std::size_t node, const engine::Transition& exit,
                                 const Holding& holding) const {
    constexpr double kNoJump = 0.01;
    constexpr double kNear = 1e-3;  // steps
    const double step = step_in(node);
    const auto jump = [&](double elongation) {
      const double before = change_at(node, exit, elongation - kNear * step).brings;
      const double after = change_at(node, exit, elongation + kNear * step).brings;
      return std::isfinite(after - before) ? std::abs(after - before) : 0.0;
    };
    std::vector<Interval> all;
    for (const auto& [part, is_at_threshold] : comes_true(node, holding)) {
      all.push_back(part);
      if (!is_at_threshold) continue;
      const Interval wider{part.low - step, part.high + step};
      if (!std::isfinite(step)) {
        all.push_back(kAnyNumber);
        continue;
      }
      const double here = std::max(jump(part.low), jump(part.high));
      if (here <= kNoJump * std::max(jump(wider.low), jump(wider.high))) continue;
      for (std::size_t i = 0; i < map_.cells().size(); ++i) {
        if (!holding.may_hold[i]) continue;
        const Hull more = overlap_of(wider, map_.cells()[i]);
        const Hull carried = more ? overlap_of(*more, *carried_[node]) : more;
        if (carried) all.push_back(*carried);
      }
    }
    return merged(std::move(all));
  }

  /// Finds what every change brings in now. @return true if a state is entered elsewhere than known so far
  bool take_all() {
    brings_.clear();
    bool wider = false;
    for (std::size_t node = 0; node < entered_.size(); ++node) {
      if (!present_[node]) continue;
      for (std::uint32_t e = in(node).first_exit; e < in(node).last_exit; ++e)
        wider = take(node, e) || wider;
    }
    return wider;
  }

  bool take(std::size_t node, std::uint32_t e) {
    const engine::Transition& exit = machine_.exits[e];
    const std::size_t to = exit.target;
    if (is_idle(node, exit)) return false;
    const Holding& holding = map_.of_exit(e);
    const std::vector<Interval> where = overshot(node, exit, holding);
    Change all{-kBoundless, {}};
    for (const Interval& part : where) {
      const Change one = change_within(node, exit, part);
      all.brings = std::max(all.brings, one.brings);
      all.leads_to = hull_of(all.leads_to, one.leads_to);
    }
    if (!all.leads_to) return false;
    brings_.push_back({node, to, all.brings - kNegligible * energy_at(reach_)});
    const double slack = ConditionMap::kAtRest * map_.scale();
    const Hull hull = hull_of(entered_[to], all.leads_to);
    if (entered_[to] && hull->low >= entered_[to]->low - slack &&
        hull->high <= entered_[to]->high + slack)
      return false;
    entered_[to] = hull;
    return true;
  }

  /// The largest sum of what changes bring in, on any way to each state [J]; infinite beyond rounds that bring in more
  /// each time.
  std::vector<double> sums_over_ways() const {
    std::vector<double> most(entered_.size(), -kBoundless);
    most.back() = 0.0;
    if (std::isfinite(reach_.range)) most[machine_.start] = 0.0;
    for (std::size_t round = 0; round <= entered_.size(); ++round) {
      const bool is_last = round == entered_.size();
      for (const Brings& change : brings_) {
        const double sum = most[change.from] + change.energy;
        if (sum > most[change.to]) most[change.to] = is_last ? kBoundless : sum;
      }
    }
    return most;
  }

  /// What one change brings in at most.
  struct Brings {
    std::size_t from = 0;
    std::size_t to = 0;
    double energy = 0.0;  // [J]
  };

  const engine::StateMachine& machine_;
  double rest_length_;
  Interval possible_;
  bool moves_rest_;
  const Reach& reach_;
  ConditionMap map_;
  std::vector<StatePotential> potentials_;
  std::vector<Hull> entered_;      // by in(): elongations where it begins; none: it never does
  std::vector<Hull> carried_;      // likewise how far the energy carries it
  std::vector<Hull> moved_;        // likewise where its last step may take it, see moved_in()
  std::vector<Hull> present_;      // likewise where it may be until an exit surely ends it
  std::vector<bool> passes_fold_;  // likewise: an angle that turns all around
  std::vector<double> lowest_;     // likewise its least potential there [J]
  std::vector<double> brought_;    // likewise [J]; -infinity: it is not entered
  std::vector<Brings> brings_;     // of all changes that may come
};

/// What has been brought in where each state is entered [J]. Conditions on the force count how far a step goes with that
/// energy, too.
std::vector<double> brought_by(const engine::StateMachine& machine, double rest_length,
                               const Interval& possible, double share, const Reach& reach) {
  constexpr int kRounds = 8;
  constexpr double kMore = 1.2;
  const bool asks = std::ranges::any_of(machine.exits, [](const engine::Transition& exit) {
    return asks_for(exit.when, engine::Quantity::kForce);
  });
  Reach here = reach;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> brought =
        Ways(machine, rest_length, possible, share, here, reach).brought();
    const double most = std::ranges::max(brought);
    if (!asks || std::isinf(most) || reach.brought + most <= here.brought) return brought;
    here.brought = reach.brought + kMore * most;
  }
  return std::vector<double>(machine.states.size(), kBoundless);
}

}  // namespace

Interval possible_elongations(double rest_length, bool turns) noexcept {
  return turns ? Interval{-rest_length, kBoundless} : kAnyNumber;
}

std::vector<Entry> entries_of(const engine::StateMachine& state_machine, double rest_length,
                              const Interval& possible, const Reach& reach) {
  std::vector<Entry> entries(state_machine.states.size());
  for (const engine::Transition& exit : state_machine.exits)
    entries[exit.target].by_a_change = true;
  if (std::ranges::none_of(entries, [](const Entry& entry) { return entry.by_a_change; }))
    return entries;
  for (const double share : {0.0, 1.0}) {
    const std::vector<double> brought =
        brought_by(state_machine, rest_length, possible, share, reach);
    for (std::size_t s = 0; s < entries.size(); ++s)
      entries[s].brought = std::max(entries[s].brought, brought[s]);
    if (reach.mass_a.low == reach.mass_a.high && reach.mass_b.low == reach.mass_b.high) break;
  }
  return entries;
}

}  // namespace cordis::plan
