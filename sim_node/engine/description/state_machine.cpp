// sim_node/engine/description/state_machine.cpp
#include "sim_node/engine/description/state_machine.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "node/assert.h"
#include "sim_node/engine/core/require.h"
#include "sim_node/engine/description/bend_limits.h"

namespace cordis::engine {
namespace {

std::string quoted(const std::string& kind, std::size_t index, const std::string& label) {
  return kind + " " + std::to_string(index) + (label.empty() ? "" : " '" + label + "'");
}

/// The slots of a program, one for each use.
std::vector<std::uint32_t> slot_uses(const Program& program) {
  std::vector<std::uint32_t> slots;
  for (const Instruction& instruction : program.code) {
    if (instruction.operation == Operation::kRising ||
        instruction.operation == Operation::kFalling) {
      slots.push_back(instruction.slot);
    }
  }
  return slots;
}

void check_exit(const StateMachine& state_machine, const Transition& exit, const std::string& name,
                std::size_t variable_count) {
  check_program(exit.when, name + ": condition", variable_count);
  require(exit.target < state_machine.states.size(), name + ": target",
          "a state of the state machine");
  require(static_cast<std::size_t>(exit.triggered) < kQuantityCount, name + ": trigger",
          "a known quantity");
  if (exit.rest == RestRule::kExpression) {
    check_program(exit.rest_length, name + ": rest length");
    require(slot_uses(exit.rest_length).empty(), name + ": rest length",
            "without `rising` and `falling`");
  } else {
    require(exit.rest_length.empty(), name + ": expression of the rest length",
            "left out unless its rule asks for it");
  }
}

void check_friction(const Friction& friction, const std::string& name) {
  require(is_finite_and_at_least_zero(friction.stiffness), name + ": stiffness", "finite and > 0");
  require(is_finite_and_at_least_zero(friction.viscosity), name + ": viscosity", "finite and >= 0");
  require(is_finite_and_at_least_zero(friction.kinetic_coefficient), name + ": kinetic coefficient",
          "finite and >= 0");
  require(std::isfinite(friction.static_coefficient) &&
              friction.static_coefficient >= friction.kinetic_coefficient,
          name + ": static coefficient", "finite and not below the kinetic one");
}

void check_formulas(const LinkState& state, const std::string& name, std::size_t variable_count) {
  std::vector<Parameter> known;
  for (const auto& [parameter, formula] : state.formulas) {
    require(parameter <= Parameter::kDepth, name + ": parameter of a formula", "a known one");
    require(std::ranges::find(known, parameter) == known.end(), name + ": formulas",
            "one of each parameter");
    known.push_back(parameter);
    const auto asks_for_link = [](const Instruction& instruction) {
      return instruction.operation == Operation::kQuantity;
    };
    check_program(formula, name + ": formula", variable_count);
    require(!has_edge(formula) && std::ranges::none_of(formula.code, asks_for_link),
            name + ": formula", "one of variables alone");
    require(
        parameter != Parameter::kDepth || std::holds_alternative<LennardJones>(state.elasticity),
        name + ": formula of a depth", "one beside Lennard-Jones");
  }
}

void check_state(const StateMachine& state_machine, const LinkState& state, const std::string& name,
                 std::size_t variable_count) {
  require(is_finite_and_at_least_zero(state.stiffness), name + ": stiffness", "finite and >= 0");
  require(is_finite_and_at_least_zero(state.viscosity), name + ": viscosity", "finite and >= 0");
  require(state.force_limit > 0.0, name + ": force limit", "> 0");
  check_elasticity(state.elasticity, name + ": elasticity", variable_count);
  check_dissipation(state.dissipation, name + ": dissipation", variable_count);
  if (state.friction) check_friction(*state.friction, name + ": friction");
  require(!state.rest_angle || std::abs(*state.rest_angle) < kMaxRestAngle, name + ": rest angle",
          "within 3.2 rad of 0");
  check_formulas(state, name, variable_count);
  require(state.first_exit <= state.last_exit && state.last_exit <= state_machine.exits.size(),
          name + ": exits", "a range of the exits of the state machine");
  std::vector<bool> used(kMaxSlots, false);
  for (std::uint32_t e = state.first_exit; e < state.last_exit; ++e) {
    for (const std::uint32_t slot : slot_uses(state_machine.exits[e].when)) {
      require(!used[slot], name + ": slot " + std::to_string(slot),
              "used once among the exits of the state");
      used[slot] = true;
    }
  }
}

}  // namespace

const Friction& friction_in(const StateMachine& state_machine, std::size_t state) noexcept {
  CORDIS_ASSERT(state < state_machine.states.size());
  const std::optional<Friction>& own = state_machine.states[state].friction;
  return own ? *own : state_machine.friction;
}

const Program* formula_of(const LinkState& state, Parameter parameter) noexcept {
  const auto known = std::ranges::find(state.formulas, parameter, &ParameterFormula::parameter);
  return known == state.formulas.end() ? nullptr : &known->formula;
}

namespace {

/// What limits the force of a state; nullptr: nothing does.
const char* limits_of(const LinkState& state) noexcept {
  if (!state.pulls || !state.pushes) return "pulls and pushes";
  return std::isinf(state.force_limit) ? nullptr : "a force limit";
}

/// What keeps a state from having a stiffness and a viscosity alone; nullptr: nothing does.
const char* beyond_linear(const LinkState& state) noexcept {
  const LawsOfBend laws = laws_of_bend(state);
  if (laws.elasticity != nullptr) return "elasticity";
  if (laws.dissipation != nullptr) return "dissipation";
  return limits_of(state);
}

}  // namespace

bool fits_maxwell_element(const StateMachine& state_machine) noexcept {
  return state_machine.is_stateless() && !rubs(state_machine) &&
         beyond_linear(state_machine.states[0]) == nullptr &&
         state_machine.states[0].formulas.empty();
}

LawsOfBend laws_of_bend(const LinkState& state) noexcept {
  LawsOfBend laws;
  if (!is_none(state.elasticity) && !is_product(state.elasticity, Quantity::kElongation))
    laws.elasticity = &state.elasticity;
  if (!is_none(state.dissipation) && !is_product(state.dissipation, Quantity::kSpeed))
    laws.dissipation = &state.dissipation;
  return laws;
}

bool has_laws_of_bends(const StateMachine& state_machine) noexcept {
  return std::ranges::any_of(state_machine.states,
                             [](const LinkState& state) { return laws_of_bend(state).any(); });
}

const char* refused_in_bends(const StateMachine& state_machine) noexcept {
  if (rubs(state_machine)) return "friction";
  for (const LinkState& state : state_machine.states) {
    for (const Law* law : {&state.elasticity, &state.dissipation}) {
      if (argument_of(*law) == LawArgument::kDistance) return "a law of the distance";
      const auto* expression = std::get_if<Expression>(law);
      if (expression == nullptr) continue;
      for (const Quantity quantity : {Quantity::kDistance, Quantity::kMassA, Quantity::kMassB}) {
        if (asks_for(expression->program, quantity)) return "quantities of a link in a law";
      }
    }
    if (const char* const refused = limits_of(state)) return refused;
  }
  const auto asks_for_link = [](const Program& program) {
    return std::ranges::any_of(program.code, [](const Instruction& instruction) {
      return instruction.operation == Operation::kQuantity && !is_of_angle(instruction.quantity) &&
             instruction.quantity != Quantity::kAge;
    });
  };
  const bool asks = std::ranges::any_of(state_machine.exits, [&](const Transition& exit) {
    return asks_for_link(exit.when) || asks_for_link(exit.rest_length);
  });
  return asks ? "quantities of a link between two MATs" : nullptr;
}

bool asks_for_angle(const StateMachine& state_machine) noexcept {
  const auto asks = [](const Program& program) {
    return std::ranges::any_of(program.code, [](const Instruction& instruction) {
      return instruction.operation == Operation::kQuantity && is_of_angle(instruction.quantity);
    });
  };
  return std::ranges::any_of(state_machine.exits, [&](const Transition& exit) {
    return asks(exit.when) || asks(exit.rest_length);
  });
}

bool rubs(const StateMachine& state_machine) noexcept {
  return std::ranges::any_of(state_machine.states, [&](const LinkState& state) {
    return state.friction ? state.friction->acts() : state_machine.friction.acts();
  });
}

bool asks_for_variable(const LinkState& state) noexcept {
  return asks_for_variable(state.elasticity) || asks_for_variable(state.dissipation) ||
         std::ranges::any_of(state.formulas, [](const ParameterFormula& each) {
           return asks_for_variable(each.formula);
         });
}

bool laws_ask_for_variable(const StateMachine& state_machine) noexcept {
  return std::ranges::any_of(state_machine.states,
                             [](const LinkState& state) { return asks_for_variable(state); });
}

bool asks_for_variable(const StateMachine& state_machine) noexcept {
  return laws_ask_for_variable(state_machine) ||
         std::ranges::any_of(state_machine.exits,
                             [](const Transition& exit) { return asks_for_variable(exit.when); });
}

void check_state_machine(const StateMachine& state_machine, const std::string& name,
                         std::size_t variable_count) {
  require(!state_machine.states.empty(), name + ": number of states", "at least 1");
  require(state_machine.states.size() <= kMaxStates, name + ": number of states", "at most 64");
  require(state_machine.start < state_machine.states.size(), name + ": start",
          "a state of the state machine");
  for (std::size_t e = 0; e < state_machine.exits.size(); ++e) {
    check_exit(state_machine, state_machine.exits[e], name + ": exit " + std::to_string(e),
               variable_count);
  }
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    const LinkState& state = state_machine.states[s];
    check_state(state_machine, state, name + ": " + quoted("state", s, state.name), variable_count);
  }
  check_friction(state_machine.friction, name + ": friction");
}

double touch_distance(const StateMachine& state_machine) noexcept {
  const LinkState& state = state_machine.states.front();
  const bool is_bare = state_machine.is_stateless() && state.stiffness == 0.0 &&
                       state.formulas.empty() && state.viscosity == 0.0 &&
                       is_none(state.dissipation) && state.pulls && state.pushes &&
                       std::isinf(state.force_limit);
  const auto* law = std::get_if<LennardJones>(&state.elasticity);
  if (!is_bare || law == nullptr) return std::numeric_limits<double>::infinity();
  return law->diameter * std::pow(26.0 / 7.0, 1.0 / 6.0);
}

}  // namespace cordis::engine
