// sim_node/plan/program_value.cpp
#include "sim_node/plan/program_value.h"

#include <algorithm>
#include <cmath>

namespace cordis::plan {
namespace {

using engine::Instruction;
using engine::Operation;

double truth(bool value) {
  return value ? 1.0 : 0.0;
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
      return truth(left < right);
    case Operation::kLessOrEqual:
      return truth(left <= right);
    case Operation::kGreater:
      return truth(left > right);
    case Operation::kGreaterOrEqual:
      return truth(left >= right);
    case Operation::kEqual:
      return truth(left == right);
    case Operation::kNotEqual:
      return truth(left != right);
    case Operation::kAnd:
      return truth(left != 0.0 && right != 0.0);
    default:
      return truth(left != 0.0 || right != 0.0);
  }
}

bool is_unary(Operation operation) {
  return operation == Operation::kNegate || operation == Operation::kAbs ||
         operation == Operation::kSqrt || operation == Operation::kNot;
}

bool is_trend(Operation operation) {
  return operation == Operation::kRising || operation == Operation::kFalling;
}

double apply(Operation operation, double value) {
  if (operation == Operation::kNegate) return -value;
  if (operation == Operation::kAbs) return std::abs(value);
  if (operation == Operation::kSqrt) return std::sqrt(value);
  return truth(value == 0.0);
}

}  // namespace

bool asks_for_trend(const engine::Program& program) {
  return std::any_of(program.code.begin(), program.code.end(),
                     [](const Instruction& each) { return is_trend(each.operation); });
}

bool asks_for(const engine::Program& program, engine::Quantity quantity) {
  return std::any_of(program.code.begin(), program.code.end(), [quantity](const Instruction& each) {
    return each.operation == Operation::kQuantity && each.quantity == quantity;
  });
}

double value_of(const engine::Program& program, const LinkQuantities& now,
                const LinkQuantities* before) {
  std::array<double, engine::kMaxStack> stack{};
  std::array<double, engine::kMaxStack> earlier{};
  std::size_t top = 0;
  for (const Instruction& instruction : program.code) {
    const Operation operation = instruction.operation;
    if (operation == Operation::kConstant) {
      stack[top] = earlier[top] = instruction.constant;
      ++top;
    } else if (operation == Operation::kQuantity) {
      const auto quantity = static_cast<std::size_t>(instruction.quantity);
      stack[top] = now[quantity];
      earlier[top] = before != nullptr ? (*before)[quantity] : now[quantity];
      ++top;
    } else if (is_trend(operation)) {
      const double growth = stack[top - 1] - earlier[top - 1];
      stack[top - 1] = truth(operation == Operation::kRising ? growth > 0.0 : growth < 0.0);
      earlier[top - 1] = stack[top - 1];
    } else if (is_unary(operation)) {
      stack[top - 1] = apply(operation, stack[top - 1]);
      earlier[top - 1] = apply(operation, earlier[top - 1]);
    } else {
      --top;
      stack[top - 1] = combine(operation, stack[top - 1], stack[top]);
      earlier[top - 1] = combine(operation, earlier[top - 1], earlier[top]);
    }
  }
  return stack[0];
}

}  // namespace cordis::plan
