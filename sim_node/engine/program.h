// sim_node/engine/program.h -- an expression over a link, compiled.
#pragma once

#include <string>
#include <vector>

#include "sim_node/engine/instruction.h"

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

}  // namespace cordis::engine
