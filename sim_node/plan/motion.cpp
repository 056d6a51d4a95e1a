// sim_node/plan/motion.cpp
#include "sim_node/plan/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim_node/plan/law_value.h"

namespace cordis::plan {
namespace {

using engine::Operation;
using engine::Quantity;
using engine::Vec3;

Vec3 column(const Motion::Values& values, std::size_t first, std::uint32_t mat) {
  return Vec3::Map(values.data() + first + 3 * static_cast<std::size_t>(mat));
}

void refuse(bool condition, const char* what) {
  if (condition) throw std::invalid_argument(std::string(what) + " have no oracle");
}

void check_program(const engine::Program& program) {
  for (const engine::Instruction& instruction : program.code) {
    refuse(
        instruction.operation == Operation::kRising || instruction.operation == Operation::kFalling,
        "conditions with `rising` or `falling`");
    refuse(
        instruction.operation == Operation::kQuantity && instruction.quantity == Quantity::kImpulse,
        "conditions on the impulse of a link");
  }
}

double combine(Operation operation, double left, double right) {
  switch (operation) {
    case Operation::kMin:
      return std::min(left, right);
    case Operation::kMax:
      return std::max(left, right);
    case Operation::kAdd:
      return left + right;
    case Operation::kSubtract:
      return left - right;
    case Operation::kMultiply:
      return left * right;
    case Operation::kDivide:
      return left / right;
    case Operation::kLess:
      return left < right ? 1.0 : 0.0;
    case Operation::kLessOrEqual:
      return left <= right ? 1.0 : 0.0;
    case Operation::kGreater:
      return left > right ? 1.0 : 0.0;
    case Operation::kGreaterOrEqual:
      return left >= right ? 1.0 : 0.0;
    case Operation::kEqual:
      return left == right ? 1.0 : 0.0;
    case Operation::kNotEqual:
      return left != right ? 1.0 : 0.0;
    case Operation::kAnd:
      return left != 0.0 && right != 0.0 ? 1.0 : 0.0;
    default:
      return left != 0.0 || right != 0.0 ? 1.0 : 0.0;
  }
}

bool is_unary(Operation operation) {
  return operation == Operation::kNegate || operation == Operation::kAbs ||
         operation == Operation::kSqrt || operation == Operation::kNot;
}

double apply(Operation operation, double value) {
  if (operation == Operation::kNegate) return -value;
  if (operation == Operation::kAbs) return std::abs(value);
  if (operation == Operation::kSqrt) return std::sqrt(value);
  return value == 0.0 ? 1.0 : 0.0;
}

}  // namespace

/// A link at one moment.
struct Motion::Geometry {
  double distance = 0.0;
  double speed = 0.0;
  Vec3 direction = Vec3::Zero();  // of unit length, or 0
  Vec3 velocity = Vec3::Zero();   // of b relative to a
};

Motion::Motion(engine::NetworkDescription network) : network_(std::move(network)) {
  refuse(!network_.sets.empty(), "sets");
  for (const engine::Behaviour& behaviour : network_.behaviours) {
    for (const engine::Exit& exit : behaviour.exits) {
      check_program(exit.when);
      check_program(exit.rest_length);
    }
  }
  for (const engine::StateLink& link : network_.state_links) {
    const engine::Behaviour& behaviour = network_.behaviours[link.behaviour];
    states_.push_back({behaviour.start, link.rest_length, 0.0});
    has_states_ = has_states_ || !behaviour.exits.empty();
  }
}

Motion::Values Motion::start() const {
  Values values(2 * position_count() + network_.maxwell_links.size(), 0.0);
  for (std::size_t i = 0; i < network_.mats.size(); ++i) {
    std::copy_n(network_.mats[i].position.data(), 3, values.data() + 3 * i);
    std::copy_n(network_.mats[i].velocity.data(), 3, values.data() + position_count() + 3 * i);
  }
  return values;
}

engine::Vec3 Motion::position(const Values& values, std::uint32_t mat) const {
  return column(values, 0, mat);
}

engine::Vec3 Motion::velocity(const Values& values, std::uint32_t mat) const {
  return column(values, position_count(), mat);
}

Motion::Geometry Motion::geometry(const Values& values, std::uint32_t a, std::uint32_t b) const {
  Geometry link;
  const Vec3 along = position(values, b) - position(values, a);
  link.velocity = velocity(values, b) - velocity(values, a);
  if (network_.dimension == 1) {
    link.distance = along.x();
    link.direction = Vec3::UnitX();
  } else {
    link.distance = along.norm();
    if (link.distance > 0.0) link.direction = along / link.distance;
  }
  link.speed = link.direction.dot(link.velocity);
  return link;
}

double Motion::pull(const Present& present, std::uint32_t state_link, const Geometry& link) const {
  const engine::StateLink& of = network_.state_links[state_link];
  const engine::LinkState& state = network_.behaviours[of.behaviour].states[present.state];
  const auto mass = [&](std::uint32_t mat) {
    return network_.mats[mat].kind == engine::MatKind::kMass ? network_.mats[mat].mass : 0.0;
  };
  const double elongation = link.distance - present.rest_length;
  double pull =
      state.stiffness * elongation + state.viscosity * link.speed +
      elastic_pull(state.elasticity, link.distance, elongation, mass(of.mat_a), mass(of.mat_b)) +
      viscous_pull(state.dissipation, link.distance, elongation, link.speed, mass(of.mat_a),
                   mass(of.mat_b));
  if (!state.pulls) pull = std::min(pull, 0.0);
  if (!state.pushes) pull = std::max(pull, 0.0);
  return std::clamp(pull, -state.force_limit, state.force_limit);
}

void Motion::rate(double /*time*/, const Values& values, Values& rate) const {
  const std::size_t n = position_count();
  rate.assign(values.size(), 0.0);
  const auto push = [&](std::uint32_t a, std::uint32_t b, const Vec3& force) {
    Vec3::Map(rate.data() + n + 3 * static_cast<std::size_t>(a)) += force;
    Vec3::Map(rate.data() + n + 3 * static_cast<std::size_t>(b)) -= force;
  };
  for (const engine::Link& link : network_.links) {
    const Geometry at = geometry(values, link.mat_a, link.mat_b);
    const double pull =
        link.stiffness * (at.distance - link.rest_length) + link.viscosity * at.speed;
    push(link.mat_a, link.mat_b, pull * at.direction);
  }
  for (std::uint32_t l = 0; l < states_.size(); ++l) {
    const engine::StateLink& link = network_.state_links[l];
    const Geometry at = geometry(values, link.mat_a, link.mat_b);
    push(link.mat_a, link.mat_b, pull(states_[l], l, at) * at.direction);
  }
  for (std::size_t l = 0; l < network_.maxwell_links.size(); ++l) {
    const engine::MaxwellLink& link = network_.maxwell_links[l];
    const Geometry at = geometry(values, link.mat_a, link.mat_b);
    const double force = values[2 * n + l];
    push(link.mat_a, link.mat_b, force * at.direction);
    rate[2 * n + l] = link.stiffness * (at.speed - force / link.viscosity);
  }
  for (std::uint32_t i = 0; i < network_.mats.size(); ++i) {
    auto acceleration = Vec3::Map(rate.data() + n + 3 * static_cast<std::size_t>(i));
    if (network_.mats[i].kind != engine::MatKind::kMass) {
      acceleration.setZero();
      continue;
    }
    const Vec3 v = velocity(values, i);
    acceleration =
        (acceleration - network_.medium_viscosity * v) / network_.mats[i].mass + network_.gravity;
    Vec3::Map(rate.data() + 3 * static_cast<std::size_t>(i)) = v;
  }
}

double Motion::evaluate(const engine::Program& program, std::uint32_t state_link, double time,
                        const Geometry& link) const {
  const Present& present = states_[state_link];
  const engine::StateLink& of = network_.state_links[state_link];
  const auto mass = [&](std::uint32_t mat) {
    return network_.mats[mat].kind == engine::MatKind::kMass ? network_.mats[mat].mass : 0.0;
  };
  const std::array<double, engine::kQuantityCount> quantities{
      link.distance,
      link.distance - present.rest_length,
      link.speed,
      link.velocity.x(),
      link.velocity.y(),
      link.velocity.z(),
      (link.velocity - link.speed * link.direction).norm(),
      pull(present, state_link, link),
      0.0,
      time - present.entered,
      present.rest_length,
      mass(of.mat_a),
      mass(of.mat_b)};
  std::array<double, engine::kMaxStack> stack{};
  std::size_t top = 0;
  for (const engine::Instruction& instruction : program.code) {
    if (instruction.operation == Operation::kConstant) {
      stack[top++] = instruction.constant;
    } else if (instruction.operation == Operation::kQuantity) {
      stack[top++] = quantities[static_cast<std::size_t>(instruction.quantity)];
    } else if (is_unary(instruction.operation)) {
      stack[top - 1] = apply(instruction.operation, stack[top - 1]);
    } else {
      --top;
      stack[top - 1] = combine(instruction.operation, stack[top - 1], stack[top]);
    }
  }
  return stack[0];
}

std::int64_t Motion::exit_of(std::uint32_t state_link, double time, const Values& values) const {
  const engine::StateLink& link = network_.state_links[state_link];
  const engine::Behaviour& behaviour = network_.behaviours[link.behaviour];
  const engine::LinkState& state = behaviour.states[states_[state_link].state];
  if (state.first_exit == state.last_exit) return -1;
  const Geometry at = geometry(values, link.mat_a, link.mat_b);
  for (std::uint32_t e = state.first_exit; e < state.last_exit; ++e) {
    if (evaluate(behaviour.exits[e].when, state_link, time, at) != 0.0) return e;
  }
  return -1;
}

std::int64_t Motion::link_to_change(double time, const Values& values) const {
  for (std::uint32_t l = 0; l < states_.size(); ++l) {
    if (exit_of(l, time, values) >= 0) return l;
  }
  return -1;
}

void Motion::change(std::uint32_t state_link, double time, const Values& values) {
  const engine::StateLink& link = network_.state_links[state_link];
  const std::int64_t exit_index = exit_of(state_link, time, values);
  if (exit_index < 0) return;
  const engine::Exit& exit =
      network_.behaviours[link.behaviour].exits[static_cast<std::size_t>(exit_index)];
  const Geometry at = geometry(values, link.mat_a, link.mat_b);
  Present& present = states_[state_link];
  if (exit.rest == engine::RestRule::kExpression) {
    present.rest_length = evaluate(exit.rest_length, state_link, time, at);
  } else if (exit.rest == engine::RestRule::kHere) {
    present.rest_length = at.distance;
  }
  present.state = exit.target;
  present.entered = time;
}

}  // namespace cordis::plan
