// sim_node/engine/expressions/program.cpp
#include "sim_node/engine/expressions/program.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "node/assert.h"
#include "sim_node/engine/core/require.h"
#include "sim_node/engine/expressions/program_kernel_body.h"
#include "sim_node/engine/simd/lanes_scalar.h"

namespace cordis::engine {
namespace {

void check_instruction(const Instruction& instruction, const std::string& name,
                       std::size_t variable_count) {
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
    case Operation::kVariable:
      require(instruction.slot < variable_count, name + ": variable", "one that it may ask for");
      break;
    default:
      break;
  }
}

double truth(bool value) noexcept {
  return value ? 1.0 : 0.0;
}

/// True if an operation may make what is not finite of finite values that are not large.
bool may_fail(const Instruction& instruction) noexcept {
  switch (instruction.operation) {
    case Operation::kDivide:
    case Operation::kSqrt:
    case Operation::kLog:
    case Operation::kExp:
    case Operation::kPower:
    case Operation::kWholePower:
      return true;
    default:
      return false;
  }
}

/// True if an operation has no finite value as soon as one of its operands has none.
bool hands_on(Operation operation) noexcept {
  return operation == Operation::kAdd || operation == Operation::kSubtract ||
         operation == Operation::kMultiply || operation == Operation::kNegate;
}

}  // namespace

std::size_t operand_count(Operation operation) noexcept {
  switch (operation) {
    case Operation::kConstant:
    case Operation::kQuantity:
    case Operation::kVariable:
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
  CORDIS_ASSERT(!is_edge(instruction.operation) && operand_count(instruction.operation) > 0);
  std::array<Instruction, 4> code{};
  std::size_t count = 0;
  for (; count < operand_count(instruction.operation); ++count) {
    code[count] = {Operation::kConstant, {}, operands[count], 0};
  }
  code[count] = instruction;
  ProgramLoop<ScalarLanes> loop;
  return *loop.evaluate({code.data(), count + 1}, {nullptr, nullptr}, 0);
}

bool asks_for(const Program& program, Quantity quantity) noexcept {
  return std::any_of(program.code.begin(), program.code.end(), [quantity](const Instruction& each) {
    return each.operation == Operation::kQuantity && each.quantity == quantity;
  });
}

bool asks_for_variable(const Program& program) noexcept {
  return std::ranges::any_of(
      program.code, [](const Instruction& each) { return each.operation == Operation::kVariable; });
}

std::vector<Program> parts_that_may_fail(const Program& program) {
  using Place = std::vector<Instruction>::const_iterator;
  struct Part {
    Place first;
    bool is_of_link = false;
    std::vector<Program> parts;  // of one that asks for the link
  };
  const auto parts_of = [](Part&& part, Place end) {
    if (part.is_of_link) return std::move(part.parts);
    const Program whole{std::vector<Instruction>(part.first, end)};
    const bool counts = std::any_of(part.first, end, may_fail) && asks_for_variable(whole);
    return counts ? std::vector<Program>(1, whole) : std::vector<Program>();
  };
  std::vector<Part> stack;
  for (Place here = program.code.begin(); here != program.code.end(); ++here) {
    const std::size_t taken = operand_count(here->operation);
    CORDIS_ASSERT(taken <= stack.size());
    Part whole{here, here->operation == Operation::kQuantity, {}};
    const std::size_t lowest = stack.size() - taken;
    if (taken > 0) whole.first = stack[lowest].first;
    for (std::size_t i = lowest; i < stack.size(); ++i)
      whole.is_of_link = whole.is_of_link || stack[i].is_of_link;
    for (std::size_t i = lowest; i < stack.size() && whole.is_of_link && hands_on(here->operation);
         ++i) {
      const Place end = i + 1 < stack.size() ? stack[i + 1].first : here;
      for (Program& part : parts_of(std::move(stack[i]), end))
        whole.parts.push_back(std::move(part));
    }
    stack.resize(lowest);
    stack.push_back(std::move(whole));
  }
  CORDIS_ASSERT(stack.size() == 1);
  return parts_of(std::move(stack.front()), program.code.end());
}

bool has_edge(const Program& program) noexcept {
  return std::any_of(program.code.begin(), program.code.end(),
                     [](const Instruction& each) { return is_edge(each.operation); });
}

double value_of(const ProgramTerm& program) noexcept {
  static constexpr std::array<const double*, kQuantityCount> kNothing{};
  ProgramLoop<ScalarLanes> loop;
  return loop.evaluate(program, {kNothing.data(), nullptr}, 0)[0];
}

double value_of(const Program& program, const LinkQuantities& now, const LinkQuantities* before,
                double edge, const double* variables) noexcept {
  CORDIS_ASSERT(variables != nullptr || !asks_for_variable(program));
  std::array<double, kMaxStack> stack;
  std::array<double, kMaxStack> earlier;  // the stack as it was with `before`
  std::size_t depth = 0;
  for (const Instruction& instruction : program.code) {
    const std::size_t taken = operand_count(instruction.operation);
    CORDIS_ASSERT(taken <= depth && depth - taken < kMaxStack);
    const std::size_t place = depth - taken;
    double& value = stack[place];
    double& old = earlier[place];
    if (instruction.operation == Operation::kConstant) {
      value = old = instruction.constant;
    } else if (instruction.operation == Operation::kQuantity) {
      const auto quantity = static_cast<std::size_t>(instruction.quantity);
      value = now[quantity];
      old = before != nullptr ? (*before)[quantity] : value;
    } else if (instruction.operation == Operation::kVariable) {
      value = old = variables[instruction.slot];
    } else if (is_edge(instruction.operation)) {
      const double change = value - old;
      const bool is_so = instruction.operation == Operation::kRising ? change > 0.0 : change < 0.0;
      value = old = before != nullptr ? truth(is_so) : edge;
    } else {
      value = apply(instruction, &value);
      old = before != nullptr ? apply(instruction, &old) : value;
    }
    depth = place + 1;
  }
  return stack[0];
}

void check_program(const Program& program, const std::string& name, std::size_t variable_count) {
  std::size_t depth = 0;
  for (const Instruction& instruction : program.code) {
    check_instruction(instruction, name, variable_count);
    const std::size_t taken = operand_count(instruction.operation);
    require(depth >= taken, name + ": every operation", "given its operands");
    depth += 1 - taken;
    static_assert(kMaxStack == 16);
    require(depth <= kMaxStack, name + ": depth of the stack", "at most 16");
  }
  require(depth == 1, name, "an expression that leaves one value");
}

bool is_well_formed(const Program& program, std::size_t variable_count) {
  try {
    check_program(program, {}, variable_count);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

}  // namespace cordis::engine
