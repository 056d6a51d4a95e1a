// sim_node/engine/links/elongation_increment.h -- how far the ends of a link have moved apart in a
// period.
#pragma once

#include <cstdint>

#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

/// Half of what the ends of a link, with their columns, have moved apart since the last forces:
/// times its length then, which the force on a unit of it takes in work [m^2]; in line along the
/// axis of the columns alone [m].
inline double half_elongation_increment(const MatArray& mats, std::uint32_t column_a,
                                        std::uint32_t column_b, bool is_1d) noexcept {
  const MatLayout& layout = mats.layout();
  const std::uint32_t a = layout.mat_of(column_a);
  const std::uint32_t b = layout.mat_of(column_b);
  const Vec3 before = mats.delayed_at_rest(b) - mats.delayed_at_rest(a);
  const Vec3 moved = mats.position(b) - mats.position(a) - before;
  return 0.5 * (is_1d ? moved[layout.axis_of(column_a)] : before.dot(moved));
}

}  // namespace cordis::engine
