// sim_node/engine/expressions/program_term.h -- a program as the kernels of every vector width read
// it.
#pragma once

#include <cstddef>
#include <limits>

#include "sim_node/engine/core/vector_width.h"
#include "sim_node/engine/expressions/instruction.h"

namespace cordis::engine {

/// Rows are stepped so many at a time, whatever the width.
inline constexpr std::size_t kStateBatch = kBatchRows;

/// In a slot of the memory of a row: none yet.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// A Program, made ready.
struct ProgramTerm {
  const Instruction* code = nullptr;
  std::size_t count = 0;
  const double* variable = nullptr;  // values of the network's variables; null: none is known
};

/// What a program reads, for 8 rows; every array holds 8 values and is 64-byte aligned.
struct ProgramRows {
  const double* const* quantity;  ///< by Quantity; what the program does not read may be null
  double* memory;                 ///< slot s has memory[8 * s], 8 values, kNoValue at first
};

}  // namespace cordis::engine
