// sim_node/scene/liaisons/diagnostics.cpp
#include "sim_node/scene/liaisons/diagnostics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "sim_node/scene/language/formula.h"

namespace cordis::scene {

namespace {

using engine::LinkState;
using engine::Operation;
using engine::Program;
using engine::StateMachine;
using engine::Transition;
using Quantities = engine::LinkQuantities;

constexpr std::size_t kTries = 32;            // entries tried for one exit
constexpr std::size_t kWordsTried = 200'000;  // of conditions in all tries of one kind
constexpr int kDrawsOfATry = 16;              // of a link before and after it
constexpr int kHalvings = 40;                 // of the way between them

double& value_in(Quantities& quantities, engine::Quantity quantity) {
  return quantities[static_cast<std::size_t>(quantity)];
}

bool is_linear(const LinkState& state) {
  return is_none(state.elasticity);
}

/// The elastic tension of a linear state.
double tension_of(const LinkState& state, double elongation) {
  double tension = state.stiffness * elongation;
  if (!state.pulls) tension = std::min(tension, 0.0);
  if (!state.pushes) tension = std::max(tension, 0.0);
  return std::clamp(tension, -state.force_limit, state.force_limit);
}

/// Numbers that look random and are always the same.
class Dice {
 public:
  double between(double lowest, double highest) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return lowest + (highest - lowest) * static_cast<double>(state_ >> 11U) * 0x1p-53;
  }
  std::size_t below(std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(between(0.0, static_cast<double>(count))));
  }

 private:
  std::uint64_t state_ = 1990;
};

/// Links about to change state: what their quantities may be.
class Entries {
 public:
  explicit Entries(const StateMachine& state_machine) : state_machine_(state_machine) {
    std::size_t word_count = 0;
    for (const Transition& exit : state_machine.exits) {
      for (const engine::Instruction& instruction : exit.when.code) {
        const double size = std::abs(instruction.constant);
        if (instruction.operation == Operation::kConstant && size > 0.0) sizes_.push_back(size);
      }
      word_count += exit.when.code.size();
    }
    tries_ = std::clamp<std::size_t>(kWordsTried / std::max<std::size_t>(word_count, 1), 2, kTries);
    if (sizes_.empty()) sizes_.push_back(1.0);
  }

  /// Links that have just been led out of `from` by an exit while their ends moved slowly, as the
  /// next state finds them.
  std::vector<Quantities> through(const LinkState& from, const Transition& exit) {
    std::vector<Quantities> entries;
    for (std::size_t t = 0; t < tries_; ++t) {
      if (std::optional<Quantities> entry = try_entry(from, exit)) {
        entries.push_back(entered(*entry, exit));
      }
    }
    return entries;
  }

 private:
  std::optional<Quantities> try_entry(const LinkState& from, const Transition& exit) {
    std::optional<Quantities> before;
    std::optional<Quantities> after;
    for (int d = 0; d < kDrawsOfATry && (!before || !after); ++d) {
      const Quantities drawn = draw(from, exit.when);
      (value_of(exit.when, drawn, nullptr, 1.0) != 0.0 ? after : before) = drawn;
    }
    if (!before || !after) return std::nullopt;
    for (int h = 0; h < kHalvings; ++h) {
      Quantities middle{};
      for (std::size_t q = 0; q < middle.size(); ++q)
        middle[q] = 0.5 * ((*before)[q] + (*after)[q]);
      (value_of(exit.when, middle, nullptr, 1.0) != 0.0 ? after : before) = middle;
    }
    return after;
  }

  Quantities draw(const LinkState& from, const Program& when) {
    Quantities drawn{};
    const auto size = [&] { return sizes_[dice_.below(sizes_.size())]; };
    for (const engine::Quantity quantity :
         {engine::Quantity::kSpeed, engine::Quantity::kSpeedX, engine::Quantity::kSpeedY,
          engine::Quantity::kSpeedZ, engine::Quantity::kSlip}) {
      if (engine::asks_for(when, quantity))
        value_in(drawn, quantity) = size() * dice_.between(-2.0, 2.0);
    }
    value_in(drawn, engine::Quantity::kSlip) = std::abs(value_in(drawn, engine::Quantity::kSlip));
    if (engine::asks_for(when, engine::Quantity::kSlid))
      value_in(drawn, engine::Quantity::kSlid) = size() * dice_.between(0.0, 2.0);
    double elongation = size() * dice_.between(-2.0, 2.0);
    double force = size() * dice_.between(-2.0, 2.0);
    if (is_linear(from) && !engine::asks_for(when, engine::Quantity::kForce))
      force = tension_of(from, elongation);
    const bool of_force = engine::asks_for(when, engine::Quantity::kForce) &&
                          !engine::asks_for(when, engine::Quantity::kElongation);
    if (is_linear(from) && of_force && from.stiffness > 0.0) elongation = force / from.stiffness;
    value_in(drawn, engine::Quantity::kForce) = force;
    value_in(drawn, engine::Quantity::kElongation) = elongation;
    value_in(drawn, engine::Quantity::kRestLength) = size() * dice_.between(0.0, 2.0);
    value_in(drawn, engine::Quantity::kDistance) =
        value_in(drawn, engine::Quantity::kRestLength) + elongation;
    value_in(drawn, engine::Quantity::kImpulse) = size() * dice_.between(-2.0, 2.0);
    value_in(drawn, engine::Quantity::kAge) = size() * dice_.between(0.0, 2.0);
    value_in(drawn, engine::Quantity::kMassA) = size() * dice_.between(0.0, 2.0);
    value_in(drawn, engine::Quantity::kMassB) = size() * dice_.between(0.0, 2.0);
    return drawn;
  }

  Quantities entered(Quantities link, const Transition& exit) const {
    const double distance = value_in(link, engine::Quantity::kDistance);
    if (exit.rest == engine::RestRule::kHere)
      value_in(link, engine::Quantity::kRestLength) = distance;
    if (exit.rest == engine::RestRule::kExpression)
      value_in(link, engine::Quantity::kRestLength) = value_of(exit.rest_length, link);
    if (exit.rest != engine::RestRule::kKeep)
      value_in(link, engine::Quantity::kElongation) =
          distance - value_in(link, engine::Quantity::kRestLength);
    value_in(link, engine::Quantity::kAge) = 0.0;
    value_in(link, engine::Quantity::kImpulse) = 0.0;
    const LinkState& state = state_machine_.states[exit.target];
    if (is_linear(state))
      value_in(link, engine::Quantity::kForce) =
          tension_of(state, value_in(link, engine::Quantity::kElongation));
    return link;
  }

  const StateMachine& state_machine_;
  std::vector<double> sizes_;
  std::size_t tries_ = kTries;
  Dice dice_;
};

/// Which of the states that are reached should lead to one that is not: the first without an exit.
const std::string& state_before(const StateMachine& state_machine,
                                const std::vector<bool>& reached) {
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    const LinkState& state = state_machine.states[s];
    if (reached[s] && state.first_exit == state.last_exit) return state.name;
  }
  return state_machine.states[state_machine.start].name;
}

void check_states(const StateMachine& state_machine, const StateMachinePlaces& places,
                  const std::string& what, config::Problems& problems) {
  std::vector<bool> reached(state_machine.states.size(), false);
  std::vector<std::uint32_t> open{state_machine.start};
  reached[state_machine.start] = true;
  while (!open.empty()) {
    const LinkState& state = state_machine.states[open.back()];
    open.pop_back();
    for (std::uint32_t e = state.first_exit; e < state.last_exit; ++e) {
      const std::uint32_t target = state_machine.exits[e].target;
      if (!reached[target]) open.push_back(target);
      reached[target] = true;
    }
  }
  const bool all_reached = std::ranges::all_of(reached, std::identity{});
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    const LinkState& state = state_machine.states[s];
    const bool acts = state.stiffness > 0.0 || state.viscosity > 0.0 || !is_linear(state) ||
                      !is_none(state.dissipation);
    if (!reached[s]) {
      problems.error(places.states[s].place,
                     "state '" + state.name + "' of " + what +
                         " cannot be reached from its start, '" +
                         state_machine.states[state_machine.start].name + "'",
                     "give '" + state_before(state_machine, reached) +
                         "' the exit {to: " + state.name + ", when: ...}");
    } else if (all_reached && acts && !places.states[s].is_final &&
               state.first_exit == state.last_exit) {
      problems.warning(places.states[s].place,
                       "no exit leads out of state '" + state.name + "' of " + what,
                       "if that is meant, write final: true");
    }
  }
}

/// @return whether the condition may hold or not.
bool check_condition(const Program& when, const config::Place& place, const std::string& what,
                     config::Problems& problems) {
  if (when.code.size() != 1 || when.code.front().operation != Operation::kConstant) return true;
  problems.warning(place, "this condition of " + what + " " +
                              (when.code.front().constant != 0.0 ? "always" : "never") + " holds");
  return false;
}

}  // namespace

void diagnose(const StateMachine& state_machine, const StateMachinePlaces& places, bool is_of_bend,
              const std::string& what, config::Problems& problems) {
  check_states(state_machine, places, what, problems);
  std::vector<bool> open(state_machine.exits.size());
  for (std::size_t e = 0; e < state_machine.exits.size(); ++e) {
    open[e] = check_condition(state_machine.exits[e].when, places.exits[e], what, problems) &&
              !asks_for_variable(state_machine.exits[e].when);  // whose value is not known here
  }
  if (is_of_bend) return;

  Entries entries(state_machine);
  for (const LinkState& from : state_machine.states) {
    for (std::uint32_t e = from.first_exit; e < from.last_exit; ++e) {
      const Transition& entry = state_machine.exits[e];
      if (asks_for_variable(entry.when)) continue;
      const std::vector<Quantities> links = entries.through(from, entry);
      const LinkState& next_state = state_machine.states[entry.target];
      for (std::uint32_t next = next_state.first_exit;
           next < next_state.last_exit && !links.empty(); ++next) {
        const Transition& exit = state_machine.exits[next];
        if (!open[next]) continue;
        const bool holds = std::all_of(links.begin(), links.end(), [&](const Quantities& link) {
          return value_of(exit.when, link) != 0.0;
        });
        if (!holds) continue;
        problems.warning(
            places.exits[next],
            "this exit of state '" + next_state.name + "' of " + what +
                " holds already when the state is entered from '" + from.name +
                "' by ends that move slowly: the link would change again in the next step, and "
                "what comes of it would depend on the length of a step",
            "let the state last: add 'and falling(...)' of the compared value, or 'and age_s > "
            "...'");
      }
    }
  }
}

}  // namespace cordis::scene
