// sim_node/engine/expressions/program.cpp
#include "sim_node/engine/expressions/program.h"

#include <algorithm>
#include <cmath>

#include "sim_node/engine/core/require.h"
#include "sim_node/engine/expressions/elementary_functions.h"

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
    case Operation::kWholePower:
      static_assert(kMaxWholePower == 64);
      require(std::abs(instruction.constant) <= kMaxWholePower &&
                  instruction.constant == std::floor(instruction.constant),
              name + ": exponent", "a whole number of at most 64");
      break;
    case Operation::kRising:
    case Operation::kFalling:
      static_assert(kMaxSlots == 16);
      require(instruction.slot < kMaxSlots, name + ": slot", "below 16");
      break;
    default:
      break;
  }
}

double truth(bool value) noexcept {
  return value ? 1.0 : 0.0;
}

/// Owner of this file's own elementary functions.
struct OneValue;
using Functions = ElementaryFunctions<OneValue>;

double of_one(const Instruction& instruction, double a) noexcept {
  switch (instruction.operation) {
    case Operation::kNegate:
      return -a;
    case Operation::kAbs:
      return std::abs(a);
    case Operation::kSqrt:
      return std::sqrt(a);
    case Operation::kNot:
      return truth(a == 0.0);
    case Operation::kSign:
      return a > 0.0 ? 1.0 : (a < 0.0 ? -1.0 : a);
    case Operation::kExp:
      return Functions::exp(a);
    case Operation::kLog:
      return Functions::log(a);
    case Operation::kSin:
      return Functions::sin(a);
    case Operation::kCos:
      return Functions::cos(a);
    case Operation::kTanh:
      return Functions::tanh(a);
    case Operation::kWholePower:
      return Functions::whole_power(a, instruction.constant);
    default:
      return 0.0;  // an edge, which a value alone does not tell
  }
}

double of_two(Operation operation, double a, double b) noexcept {
  switch (operation) {
    case Operation::kMin:
      return a < b ? a : b;
    case Operation::kMax:
      return a > b ? a : b;
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kDivide:
      return a / b;
    case Operation::kPower:
      return Functions::power(a, b);
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
    default:
      return truth(a != 0.0 || b != 0.0);
  }
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
    case Operation::kSign:
    case Operation::kExp:
    case Operation::kLog:
    case Operation::kSin:
    case Operation::kCos:
    case Operation::kTanh:
    case Operation::kWholePower:
      return 1;
    case Operation::kSelect:
      return 3;
    default:
      return 2;
  }
}

bool is_edge(Operation operation) noexcept {
  return operation == Operation::kRising || operation == Operation::kFalling;
}

double apply(const Instruction& instruction, const double* operands) noexcept {
  switch (operand_count(instruction.operation)) {
    case 1:
      return of_one(instruction, operands[0]);
    case 2:
      return of_two(instruction.operation, operands[0], operands[1]);
    case 3:
      return operands[0] != 0.0 ? operands[1] : operands[2];
    default:
      return 0.0;
  }
}

bool asks_for(const Program& program, Quantity quantity) noexcept {
  return std::any_of(program.code.begin(), program.code.end(), [quantity](const Instruction& each) {
    return each.operation == Operation::kQuantity && each.quantity == quantity;
  });
}

bool has_edge(const Program& program) noexcept {
  return std::any_of(program.code.begin(), program.code.end(),
                     [](const Instruction& each) { return is_edge(each.operation); });
}

double value_of(const Program& program, const LinkQuantities& now, const LinkQuantities* before,
                double edge) noexcept {
  std::array<double, kMaxStack> stack;
  std::array<double, kMaxStack> earlier;  // the stack as it was with `before`
  std::size_t depth = 0;
  for (const Instruction& instruction : program.code) {
    const std::size_t taken = operand_count(instruction.operation);
    const std::size_t place = depth - taken;
    double& value = stack[place];
    double& old = earlier[place];
    if (instruction.operation == Operation::kConstant) {
      value = old = instruction.constant;
    } else if (instruction.operation == Operation::kQuantity) {
      const auto quantity = static_cast<std::size_t>(instruction.quantity);
      value = now[quantity];
      old = before != nullptr ? (*before)[quantity] : value;
    } else if (is_edge(instruction.operation)) {
      const double growth = value - old;
      const bool is_so = instruction.operation == Operation::kRising ? growth > 0.0 : growth < 0.0;
      value = old = before != nullptr ? truth(is_so) : edge;
    } else {
      value = apply(instruction, &value);
      old = before != nullptr ? apply(instruction, &old) : value;
    }
    depth = place + 1;
  }
  return stack[0];
}

void check_program(const Program& program, const std::string& name) {
  std::size_t depth = 0;
  for (const Instruction& instruction : program.code) {
    check_instruction(instruction, name);
    const std::size_t taken = operand_count(instruction.operation);
    require(depth >= taken, name + ": every operation", "given its operands");
    depth += 1 - taken;
    static_assert(kMaxStack == 16);
    require(depth <= kMaxStack, name + ": depth of the stack", "at most 16");
  }
  require(depth == 1, name, "an expression that leaves one value");
}

}  // namespace cordis::engine
