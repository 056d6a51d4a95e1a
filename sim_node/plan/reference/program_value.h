// sim_node/plan/reference/program_value.h -- the value of a condition or an expression over a link.
#pragma once

#include <array>

#include "sim_node/engine/expressions/program.h"

namespace cordis::plan {

/// What a program may ask of a link, by engine::Quantity.
using LinkQuantities = std::array<double, engine::kQuantityCount>;

/// Whether `rising` or `falling` stand in it.
bool asks_for_trend(const engine::Program& program);

/// @param before  the same link a moment earlier, for `rising` and `falling`; without it both are 0
double value_of(const engine::Program& program, const LinkQuantities& now,
                const LinkQuantities* before = nullptr);

}  // namespace cordis::plan
