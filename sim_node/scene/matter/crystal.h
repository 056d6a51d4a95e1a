// sim_node/scene/matter/crystal.h -- the points of a crystal, and which of them are neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim_node/scene/limit_divisor.h"
#include "sim_node/scene/matter/region.h"

namespace cordis::scene {

/// A crystal structure. Its points are integer triples (i, j, k), of which only those with an even
/// sum belong to it where `even` says so; their coordinates are the triple times `scale`, times the
/// distance of neighbours.
struct Structure {
  using Triple = std::array<int, 3>;
  const char* name;
  int space;
  bool even;
  std::array<double, 3> scale;
  std::vector<Triple> neighbours;         ///< half of them: the other half is opposite
  std::vector<Triple> second_neighbours;  ///< likewise
};

/// square, triangular, cubic or fcc; nullptr for any other word.
const Structure* structure_named(const std::string& name);

/// Points of a structure in the order of x, then y, then z.
struct Crystal {
  std::vector<engine::Vec3> points;  ///< [m]
  std::vector<Edge> neighbours;
  std::vector<Edge> second_neighbours;
};

/// The most points between opposite corners of which a crystal may be cut.
inline constexpr double kMaxSites = 8.0e6 / kLimitDivisor;

/// A block with `counts` points along each axis, the first of them at `corner`.
Crystal crystal_block(const Structure& structure, double spacing, const engine::Vec3& corner,
                      const std::array<long, 3>& counts);

/// All points that lie in a region: in a box counted from its lowest corner, in a round region from
/// its centre. Nothing when the box around it has more than kMaxSites.
std::optional<Crystal> crystal_in(const Structure& structure, double spacing, const Region& region);

}  // namespace cordis::scene
