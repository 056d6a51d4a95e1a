// sim_node/plan/reduction/series.h -- links in a row without the MATs between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "sim_node/scene/scene.h"

namespace cordis::plan {

/// What became of the MATs without mass.
struct MergedSeries {
  std::size_t count = 0;                      ///< taken out
  std::map<std::uint32_t, std::string> left;  ///< MATs without mass that stay, and why
};

/// Takes MATs without mass out between two linear links of one kind, in a network of 1 dimension:
/// [Luc90 IV Assembly]
///
///     springs   1/K = 1/K_1 + 1/K_2, rest = rest_1 + rest_2       dampers  1/Z = 1/Z_1 + 1/Z_2
///     both, with the viscosity in the same proportion to the stiffness: likewise
///
/// Exact to rounding. In 2 and 3 dimensions every such MAT stays: it gives way sideways as soon as
/// its row is pushed, and a link in its place does not. O(MATs + links).
MergedSeries merge_series(scene::Scene& scene);

}  // namespace cordis::plan
