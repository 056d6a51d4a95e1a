// sim_node/engine/expressions/program.cpp
#include "sim_node/engine/expressions/program.h"

#include <algorithm>
#include <cmath>

#include "sim_node/engine/core/require.h"

namespace cordis::engine {
namespace {

void check_instruction(const Instruction& instruction, const std::string& name) {
  require(static_cast<std::size_t>(instruction.operation) < kOperationCount, name + ": operation",
          "a known one");
  switch (instruction.operation) {
    case Operation::kConstant:
      require(std::isfinite(instruction.constant), name + ": constant", "finite");
      break;
    case Operation::kQuantity:
      require(static_cast<std::size_t>(instruction.quantity) < kQuantityCount, name + ": quantity",
              "a known one");
      break;
    case Operation::kRising:
    case Operation::kFalling:
      require(instruction.slot < kMaxSlots, name + ": slot", "below 16");
      break;
    default:
      break;
  }
}

double truth(bool value) noexcept {
  return value ? 1.0 : 0.0;
}

}  // namespace

std::size_t operand_count(Operation operation) noexcept {
  switch (operation) {
    case Operation::kConstant:
    case Operation::kQuantity:
      return 0;
    case Operation::kNegate:
    case Operation::kAbs:
    case Operation::kSqrt:
    case Operation::kNot:
    case Operation::kRising:
    case Operation::kFalling:
      return 1;
    default:
      return 2;
  }
}

bool is_edge(Operation operation) noexcept {
  return operation == Operation::kRising || operation == Operation::kFalling;
}

double apply(Operation operation, double a, double b) noexcept {
  switch (operation) {
    case Operation::kNegate:
      return -a;
    case Operation::kAbs:
      return std::abs(a);
    case Operation::kSqrt:
      return std::sqrt(a);
    case Operation::kMin:
      return std::min(a, b);
    case Operation::kMax:
      return std::max(a, b);
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kDivide:
      return a / b;
    case Operation::kLess:
      return truth(a < b);
    case Operation::kLessOrEqual:
      return truth(a <= b);
    case Operation::kGreater:
      return truth(a > b);
    case Operation::kGreaterOrEqual:
      return truth(a >= b);
    case Operation::kEqual:
      return truth(a == b);
    case Operation::kNotEqual:
      return truth(a != b);
    case Operation::kAnd:
      return truth(a != 0.0 && b != 0.0);
    case Operation::kOr:
      return truth(a != 0.0 || b != 0.0);
    case Operation::kNot:
      return truth(a == 0.0);
    case Operation::kConstant:
    case Operation::kQuantity:
    case Operation::kRising:
    case Operation::kFalling:
      break;
  }
  return 0.0;
}

bool asks_for(const Program& program, Quantity quantity) noexcept {
  return std::any_of(program.code.begin(), program.code.end(), [quantity](const Instruction& each) {
    return each.operation == Operation::kQuantity && each.quantity == quantity;
  });
}

void check_program(const Program& program, const std::string& name) {
  std::size_t depth = 0;
  for (const Instruction& instruction : program.code) {
    check_instruction(instruction, name);
    const std::size_t taken = operand_count(instruction.operation);
    require(depth >= taken, name + ": every operation", "given its operands");
    depth += 1 - taken;
    require(depth <= kMaxStack, name + ": depth of the stack", "at most 16");
  }
  require(depth == 1, name, "an expression that leaves one value");
}

}  // namespace cordis::engine
