// sim_node/plan/reference/program_value.cpp
#include "sim_node/plan/reference/program_value.h"

#include <algorithm>

namespace cordis::plan {
namespace {

using engine::Instruction;
using engine::Operation;

}  // namespace

bool asks_for_trend(const engine::Program& program) {
  return std::any_of(program.code.begin(), program.code.end(),
                     [](const Instruction& each) { return engine::is_edge(each.operation); });
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
    } else if (engine::is_edge(operation)) {
      const double growth = stack[top - 1] - earlier[top - 1];
      const bool is_so = operation == Operation::kRising ? growth > 0.0 : growth < 0.0;
      stack[top - 1] = is_so ? 1.0 : 0.0;
      earlier[top - 1] = stack[top - 1];
    } else if (engine::operand_count(operation) == 1) {
      stack[top - 1] = apply(operation, stack[top - 1]);
      earlier[top - 1] = apply(operation, earlier[top - 1]);
    } else {
      --top;
      stack[top - 1] = apply(operation, stack[top - 1], stack[top]);
      earlier[top - 1] = apply(operation, earlier[top - 1], earlier[top]);
    }
  }
  return stack[0];
}

}  // namespace cordis::plan
