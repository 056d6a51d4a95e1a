// sim_node/engine/pairs/plane_kernel.h -- the loop over balls near planes, for each vector width.
//
// As in pair_kernel.h, nothing here has a member function.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_node/engine/matter/step_kernel.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// Surfaces of a set of which batches are known at most: a word has a bit for each.
inline constexpr std::size_t kMaxOfBatches = 64;

inline constexpr std::uint8_t kNoPlane = 255;

/// A plane with one side, and the contact of a ball with it.
struct PlaneRow {
  double normal[3] = {};
  double centre[3] = {};     // [m]
  double moved = 0.0;        // of the plane along its normal, x(n) - x(n-1) [m]
  double rest_length = 0.0;  // [m]; where balls have radii, the part of the plane
};

/// Pairs of a plane whose forces are yet to be added to its sums, at most: whole batches.
inline constexpr std::size_t kPairsOfPlane = 64;
using ValuesOfPairs = double[kPairsOfPlane + 2 * kPairBatch];

/// What the pairs of a plane give to it: their sums by the place in the batch, and the factors of pairs
/// that are yet to be added.
struct alignas(64) FactorSum {
  ValuesOfPairs factor;
  double force[3][kPairBatch];  // x, y and z
  std::size_t partners;
};
struct alignas(64) PlaneSum {
  FactorSum all;
  FactorSum viscous;
  ValuesOfPairs friction[3];  // its forces on the plane, of pairs that are yet to be added
  double squares
      [kPairBatch];   // of the springs of friction, by the place of the ball in its batch [m^2]
  std::size_t count;  // of pairs that are yet to be added
};

/// What contacts of balls and planes remember of their friction, and its forces; arrays as in PlaneBalls.
struct PlaneFriction {
  FrictionTerm term;
  // Of the members with the first plane, then with the next; see FrictionRows.
  double* phase = nullptr;
  double* stretch[3] = {};  // likewise [m]
  std::size_t stride = 0;   // from plane to plane
  double* force[3] = {};    // of the last step on the held plane, and against each member [N]
};

/// Members of a set in batches of 8. What has been listed since the last step, and is no longer, counts too.
struct ListedBatches {
  const std::uint64_t* surfaces = nullptr;  // bits of those that a ball of the batch is listed with
  const std::uint8_t* balls = nullptr;      // bits of balls that are listed with a surface
  std::size_t count = 0;
};

/// Members of a set, whose first ones are planes and the rest balls; arrays 64-byte aligned, padded to whole
/// batches.
struct PlaneBalls {
  const std::uint32_t* column = nullptr;  // of the MAT of each member; of padding, that of any ball
  const std::uint8_t* is_run = nullptr;   // of each batch: 1 where its columns follow one another
  const double* radius = nullptr;  // of each member [m]; null: the rest length is that of the plane
  const std::uint8_t* masses = nullptr;  // of each batch: bits of masses
  ListedBatches batches;
  // Forces of the last step: -factor * normal of the held plane on each ball of a batch, less friction. With
  // kNoPlane they stand in MemberValues.
  std::uint8_t* held_plane = nullptr;  // of each batch
  double* factor = nullptr;            // tension on each member [N]
  double* viscous_factor = nullptr;    // the part of it that stores no energy [N]
  PlaneFriction friction;
  std::size_t plane_count = 0;
  double range = 0.0;  // [m]
};

/// What one step of such a set has done.
struct PlaneWorks {
  MemberWorks last;            // by the forces of the last step
  MemberWorks now;             // and by those of this one
  std::uint32_t partners = 0;  // of a mass among the balls, at most
  double squares = 0.0;        // of the springs of friction, see ContactStretches [m^2]
};

}  // namespace cordis::engine
