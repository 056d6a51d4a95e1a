// sim_node/engine/laws/law_term.h -- a law as the kernels of every vector width read it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_node/engine/expressions/program_term.h"

namespace cordis::engine {

/// Kinds of Law as the kernels see them.
enum class LawCode : std::uint8_t { kNone, kTable, kPower, kLennardJones, kRings, kExpression };

struct RingTerm {
  double stiffness;  // [N/m]
  double radius;     // [m]
};

/// A Law, made ready.
struct LawTerm {
  LawCode code = LawCode::kNone;
  std::size_t count = 0;          // points of the table, or rings
  const double* at = nullptr;     // table: points, ascending
  const double* value = nullptr;  // at the points
  const double* slope = nullptr;  // to the next point; 0 at the last
  const RingTerm* rings = nullptr;
  double coefficient = 0.0;       // power
  std::uint32_t half_powers = 0;  // 2 * exponent
  double attraction = 0.0;        // Lennard-Jones: 24 depth s^6 [J m^6]
  double repulsion = 0.0;         // 48 depth s^12 [J m^12]
  double cut = 0.0;               // [m]; infinity for none
  ProgramTerm expression;
};

}  // namespace cordis::engine
