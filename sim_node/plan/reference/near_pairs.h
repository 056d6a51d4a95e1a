// sim_node/plan/reference/near_pairs.h -- the pairs of a set that may be in range.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// Where a MAT is beside a surface. @param positions  3 per MAT [m]
engine::SurfaceDistance from_surface(const engine::Surface& surface, const double* positions,
                                     std::uint32_t mat);

/// Pairs of MATs of a set liaison, kept until a member has moved so far that another pair may have
/// come into range. Measures all pairs at an update: for sets of up to some thousand.
class NearPairs {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  NearPairs(const engine::NetworkDescription& network, std::uint32_t set);

  /// All pairs in range are among these; the first of a pair is of P.
  /// @param positions  3 per MAT [m]
  const std::vector<Pair>& near(const double* positions);

 private:
  bool has_strayed(const double* positions) const;
  void update(const double* positions);

  std::vector<std::uint32_t> set_p_;
  std::vector<std::uint32_t> set_q_;
  std::vector<engine::Surface> surfaces_;  // of P
  double reach_;                           // range and skin [m]
  double skin_;                            // [m]
  std::vector<engine::Vec3> seen_;
  std::vector<Pair> pairs_;
};

}  // namespace cordis::plan
