// sim_node/engine/program.cpp
#include "sim_node/engine/program.h"

#include <cmath>

#include "sim_node/engine/require.h"

namespace cordis::engine {
namespace {

/// How many values an operation takes from the stack.
std::size_t operand_count(Operation operation) {
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

}  // namespace

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
