// tests/engine/programs.h -- programs and state machines, written as a person would.
#pragma once

#include <cstdint>
#include <utility>

#include "sim_node/engine/description/state_machine.h"

namespace cordis::test {

using engine::LinkState;
using engine::Operation;
using engine::Program;
using engine::Quantity;
using engine::RestRule;
using engine::StateMachine;
using engine::Transition;

/// A program under construction: `q(Quantity::kElongation) > 0.1`.
struct Term {
  Program program;

  Term(double value) {  // NOLINT(google-explicit-constructor): a number is a term
    program.code.push_back({Operation::kConstant, Quantity::kDistance, value, 0});
  }
  explicit Term(Quantity quantity) {
    program.code.push_back({Operation::kQuantity, quantity, 0.0, 0});
  }
};

inline Term q(Quantity quantity) {
  return Term(quantity);
}

inline Term one(Operation operation, Term value, std::uint32_t slot = 0) {
  value.program.code.push_back({operation, Quantity::kDistance, 0.0, slot});
  return value;
}

inline Term two(Operation operation, Term left, const Term& right) {
  left.program.code.insert(left.program.code.end(), right.program.code.begin(),
                           right.program.code.end());
  return one(operation, std::move(left));
}

inline Term three(Operation operation, Term low, const Term& middle, const Term& high) {
  low.program.code.insert(low.program.code.end(), middle.program.code.begin(),
                          middle.program.code.end());
  return two(operation, std::move(low), high);
}

inline Term operator+(Term u, const Term& v) {
  return two(Operation::kAdd, std::move(u), v);
}
inline Term operator-(Term u, const Term& v) {
  return two(Operation::kSubtract, std::move(u), v);
}
inline Term operator*(Term u, const Term& v) {
  return two(Operation::kMultiply, std::move(u), v);
}
inline Term operator/(Term u, const Term& v) {
  return two(Operation::kDivide, std::move(u), v);
}
inline Term operator<(Term u, const Term& v) {
  return two(Operation::kLess, std::move(u), v);
}
inline Term operator>(Term u, const Term& v) {
  return two(Operation::kGreater, std::move(u), v);
}
inline Term operator<=(Term u, const Term& v) {
  return two(Operation::kLessOrEqual, std::move(u), v);
}
inline Term operator>=(Term u, const Term& v) {
  return two(Operation::kGreaterOrEqual, std::move(u), v);
}
inline Term both(Term u, const Term& v) {
  return two(Operation::kAnd, std::move(u), v);
}
inline Term either(Term u, const Term& v) {
  return two(Operation::kOr, std::move(u), v);
}
inline Term size(Term u) {
  return one(Operation::kAbs, std::move(u));
}

/// A law that is the value of an expression.
inline engine::Law expression_law(Term tension) {
  return engine::Expression{std::move(tension.program)};
}

/// A state machine under construction.
struct Behaving {
  StateMachine state_machine;

  /// Adds a state; the exits added next are its own.
  Behaving& state(LinkState state) {
    state.first_exit = static_cast<std::uint32_t>(state_machine.exits.size());
    state.last_exit = state.first_exit;
    state_machine.states.push_back(std::move(state));
    return *this;
  }
  Behaving& state(double stiffness, double viscosity = 0.0) {
    LinkState state;
    state.stiffness = stiffness;
    state.viscosity = viscosity;
    return this->state(state);
  }
  Behaving& exit(Term when, std::uint32_t target, RestRule rest = RestRule::kKeep) {
    Transition exit;
    exit.when = std::move(when.program);
    exit.target = target;
    exit.rest = rest;
    for (const engine::Instruction& instruction : exit.when.code) {
      if (instruction.operation != Operation::kQuantity) continue;
      exit.triggered = instruction.quantity;
      break;
    }
    state_machine.exits.push_back(std::move(exit));
    ++state_machine.states.back().last_exit;
    return *this;
  }
  /// Adds an exit that sets the rest length to the value of an expression.
  Behaving& exit_to_rest(Term when, std::uint32_t target, Term rest_length) {
    exit(std::move(when), target, RestRule::kExpression);
    state_machine.exits.back().rest_length = std::move(rest_length.program);
    return *this;
  }
};

}  // namespace cordis::test
