// sim_node/engine/laws/scalar_tension.h -- a law of one link, by the loops of the kernels.
#pragma once

#include "sim_node/engine/expressions/program_kernel_body.h"
#include "sim_node/engine/laws/law_term.h"
#include "sim_node/engine/simd/lane_batch.h"
#include "sim_node/engine/simd/lanes_scalar.h"

namespace cordis::engine {

/// The tension [N], with the bits of every vector width. @param argument  as in LawArguments
template <class Type>
double scalar_tension(const Type& law, const LawPoint& link, double argument) noexcept {
  double tension = 0.0;
  const LawArguments arguments{&argument,   &link.distance, &link.elongation,
                               &link.speed, &link.mass_a,   &link.mass_b};
  if constexpr (requires { law.term(link.variables); }) {
    Type::template add<ScalarLanes>(law.term(link.variables), arguments, &tension);
  } else {
    Type::template add<ScalarLanes>(law.term(), arguments, &tension);
  }
  return tension;
}

}  // namespace cordis::engine
