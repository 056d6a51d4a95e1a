// sim_node/engine/expressions/program.h -- an expression over a link, compiled.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "sim_node/engine/expressions/instruction.h"
#include "sim_node/engine/expressions/program_term.h"

namespace cordis::engine {

/// An expression in postfix order. It is evaluated for many links at once, without branches.
struct Program {
  std::vector<Instruction> code;

  bool empty() const noexcept { return code.empty(); }
};

/// @param variable_count  how many variables it may ask for
/// @throws std::invalid_argument beginning with `name`, unless the program is well-formed: known
/// operations, quantities and variables, finite constants, one value left at the end, at most
/// kMaxStack on the way, slots below kMaxSlots.
void check_program(const Program& program, const std::string& name, std::size_t variable_count = 0);

/// True if check_program has nothing against it. Allocates.
bool is_well_formed(const Program& program, std::size_t variable_count = 0);

/// How many values an operation takes from the stack.
std::size_t operand_count(Operation operation) noexcept;
/// True if it is kRising or kFalling, which compare with the step before.
bool is_edge(Operation operation) noexcept;
/// What an instruction makes of its operands, the lowest on the stack first, with the bits that the
/// kernels find. Precondition: it is neither an edge nor one without operands.
double apply(const Instruction& instruction, const double* operands) noexcept;

/// True if the program asks for this quantity.
bool asks_for(const Program& program, Quantity quantity) noexcept;
/// True if the program asks for a variable of the network.
bool asks_for_variable(const Program& program) noexcept;
/// True when `rising` or `falling` stand in it.
bool has_edge(const Program& program) noexcept;

/// The parts of a program of a link that ask for variables and nothing of the link, where one that is no finite number
/// leaves the whole without one. What is finite for all finite variables, but for overflow, is left out. Precondition: well-formed.
std::vector<Program> parts_that_may_fail(const Program& program);

/// What a program may ask of a link, by Quantity.
using LinkQuantities = std::array<double, kQuantityCount>;

/// The value of a program that asks for variables alone; NaN without them. Precondition: well-formed. Real time:
/// no allocation.
double value_of(const ProgramTerm& program) noexcept;

/// The value of a program for one link. Precondition: well-formed, and asks for no variable without
/// `variables`.
/// @param before     the same link a moment earlier, for `rising` and `falling`; may be null
/// @param edge       what `rising` and `falling` are without it
/// @param variables  values of the variables of the network; may be null
double value_of(const Program& program, const LinkQuantities& now,
                const LinkQuantities* before = nullptr, double edge = 0.0,
                const double* variables = nullptr) noexcept;

}  // namespace cordis::engine
