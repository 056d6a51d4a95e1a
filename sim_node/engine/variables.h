// sim_node/engine/variables.h -- the values of physical variables of a world.
#pragma once

#include <span>

#include "sim_node/engine/description/variable.h"
#include "sim_node/engine/world.h"

namespace cordis::engine {

/// The value of a variable after the last step. Real time: O(1), of a group O(members), of a contact
/// O(sets); no allocation. Sums go through the members in their order.
/// @param energy  of the world, where the variable is an energy
/// Precondition: it is no count, and what it is of exists.
double value_of(const Variable& variable, const World& world, const Energy& energy) noexcept;

/// The values of several, in their order. Real time: as of value_of() for each, and O(MATs + links) more
/// where an energy is among them; no allocation.
/// @param values  as many as there are variables
void read_variables(std::span<const Variable> variables, const World& world,
                    std::span<double> values) noexcept;

}  // namespace cordis::engine
