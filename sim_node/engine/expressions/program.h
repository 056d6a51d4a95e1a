// sim_node/engine/expressions/program.h -- an expression over a link, compiled.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim_node/engine/expressions/instruction.h"

namespace cordis::engine {

/// An expression in postfix order. It is evaluated for many links at once, without branches.
struct Program {
  std::vector<Instruction> code;

  bool empty() const noexcept { return code.empty(); }
};

/// @throws std::invalid_argument beginning with `name`, unless the program is well-formed: known
/// operations and quantities, finite constants, one value left at the end, at most kMaxStack on the
/// way, slots below kMaxSlots.
void check_program(const Program& program, const std::string& name);

/// How many values an operation takes from the stack.
std::size_t operand_count(Operation operation) noexcept;
/// Whether it is kRising or kFalling, which compare with the step before.
bool is_edge(Operation operation) noexcept;
/// What an operation makes of one value or of two, the lower on the stack first; 0 for trends and
/// for those that take none.
double apply(Operation operation, double a, double b = 0.0) noexcept;

/// Whether the program asks for this quantity.
bool asks_for(const Program& program, Quantity quantity) noexcept;

}  // namespace cordis::engine
