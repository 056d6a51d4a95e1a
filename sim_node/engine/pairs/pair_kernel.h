// sim_node/engine/pairs/pair_kernel.h -- the loops over the pairs of a set, one set of them for
// each vector width.
//
// As in step_kernel.h, nothing here has a member function, so that the linker never mixes up code
// of two widths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "sim_node/engine/core/vector_width.h"
#include "sim_node/engine/description/partner_share.h"

namespace cordis::engine {

/// Pairs of a row are stepped so many at a time, whatever the width. An array that is written
/// without regard to its end has room for as many more.
inline constexpr std::size_t kPairBatch = kBatchRows;

/// Members of a set sorted by the cell they are in.
struct CellTable {
  const double* x = nullptr;  // [m]
  const double* y = nullptr;
  const double* z = nullptr;
  const double* number = nullptr;         // of the member, for comparison
  const std::uint32_t* member = nullptr;  // the same, to be found
};

/// What is looked for among them: members first <= number < last nearer to a point than the reach.
struct NearQuery {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double reach_square = 0.0;  // [m^2]
  double first = 0.0;
  double last = 0.0;
};

/// Writes what it finds among places[begin, end) in their order. @return how many
using FindNear = std::size_t (*)(const CellTable& table, std::size_t begin, std::size_t end,
                                 const NearQuery& query, std::uint32_t* found) noexcept;

/// Keeps those of `count` members found that are nearer than the reach to a point, in their order.
/// @param position  columns of the members
/// @return how many
using KeepNear = std::size_t (*)(const double* position, const double* point, double reach_square,
                                 std::uint32_t* found, std::size_t count) noexcept;

/// @return the largest square of the displacement of a column since it was at `from` [m^2]; columns
/// that are not finite do not count.
using LargestMove = double (*)(const double* position, const double* from,
                               std::size_t count) noexcept;

/// The pairs of a row: one member a, and members b in range; arrays 64-byte aligned, padded to
/// whole batches with pairs at distance 0 of columns that belong to no MAT.
struct PairRow {
  std::uint32_t* column = nullptr;  // where the column of b begins
  double* x = nullptr;              // from a to b [m]
  double* y = nullptr;
  double* z = nullptr;
  double* square = nullptr;                // of the distance [m^2]
  double* length = nullptr;                // distance [m]
  double* inverse = nullptr;               // 1 / length, 0 while it is 0 [1/m]
  double* elongation_increment = nullptr;  // of the pair along its line of centres in the last
                                           // period [m]
};

/// Pairs of several rows, those of one row after those of the other: the arrays of a PairRow, and
/// where the column of a begins, of each pair. Padded as a whole.
struct PairRows {
  PairRow pairs;
  const std::uint32_t* column_a = nullptr;
  std::size_t count = 0;               // of pairs, without padding
  std::size_t first = 0;               // row
  std::size_t last = 0;                // one past the last
  const std::size_t* start = nullptr;  // of row a: start[a - first]; one past the last too
  PartnerShare share;                  // how much each pair counts for
  double* forces[4] = {};              // room: the force of each pair on a, and less its share
};

/// Members and their neighbours: row a has those from neighbour[start[a] - origin] on to
/// neighbour[start[a + 1] - origin], as columns.
struct NeighbourRows {
  std::size_t first = 0;  // row
  std::size_t last = 0;   // one past the last
  const std::size_t* start = nullptr;
  const std::uint32_t* neighbour = nullptr;
  std::size_t origin = 0;
};

/// A row of which only some neighbours are looked at: those from neighbour[begin] on.
struct PartOfRow {
  std::uint32_t row = 0;
  std::uint32_t count = 0;
  std::size_t begin = 0;
};

/// Parts of rows, ascending.
struct PartsOfRows {
  const PartOfRow* parts = nullptr;
  std::size_t count = 0;
  const std::uint32_t* neighbour = nullptr;
};

inline constexpr std::uint32_t kNoColumn = std::numeric_limits<std::uint32_t>::max();

/// The members of a set, 4 x N, columns 32-byte aligned; 8 more columns for padding.
struct MemberColumns {
  const double* position = nullptr;  // x(n) [m]
  const double* moved = nullptr;     // x(n) - x(n-1) [m]
  std::uint32_t padding = 0;         // where the column of the first member of padding begins
  std::uint32_t end = kNoColumn;     // columns from here on get no force: padding gets it instead
};

/// Gathers the pairs of member a and its neighbours, given as columns, that are nearer than the
/// range, in their order. @return how many; they are not padded.
using GatherPairs = std::size_t (*)(const MemberColumns& members, std::size_t a,
                                    const std::uint32_t* neighbour, std::size_t count,
                                    double range_square, const PairRow& row) noexcept;

/// Where the pairs of several rows go, those of one row after those of the other.
struct RowsOut {
  PairRow pairs;
  std::uint32_t* column_a = nullptr;  // of each pair
  std::size_t* start = nullptr;       // of the row after each row
  std::size_t enough = 0;             // no further row is begun from so many pairs on
  std::size_t rows = 0;               // at most
};

/// Gathers the pairs of rows likewise, as many rows as there is room for. @return how many rows
using GatherRows = std::size_t (*)(const MemberColumns& members, const NeighbourRows& rows,
                                   double range_square, const RowsOut& out) noexcept;

/// A plane whose pairs are looked for.
struct PlaneQuery {
  double normal[3] = {};
  double centre[3] = {};  // [m]
  double moved = 0.0;     // of the plane along its normal, x(n) - x(n-1) [m]
  double range = 0.0;     // [m]
};

/// Gathers and measures the pairs of a plane and its neighbours, given as columns, that are nearer than
/// the range, in their order: their vectors are the normal, and their distance has a sign. @return how
/// many; they are not padded.
using GatherPlane = std::size_t (*)(const MemberColumns& members, const PlaneQuery& plane,
                                    const std::uint32_t* neighbour, std::size_t count,
                                    const PairRow& row) noexcept;
/// The square of a distance of a surface where it is smaller, or below 0 [m^2]: 0 is for pairs
/// without a direction.
inline constexpr double kMinSquare = 0x1p-1022;

/// What members of a set have, 4 values of each, aligned to a whole batch.
struct MemberValues {
  double* position = nullptr;  // x(n) [m]
  double* moved = nullptr;     // x(n) - x(n-1) [m]
  double* force = nullptr;     // and as fourth value the number of partners
  double* viscous = nullptr;   // the part of the force that stores no energy; null: none
};

/// Sums of forces times displacements [J], by the number of the member modulo 4.
struct MemberWorks {
  alignas(32) double all[4] = {};
  alignas(32) double viscous[4] = {};
};

/// Takes the positions of members whose MATs follow one another, and adds what their forces have done.
/// @param position, delayed  columns of the MATs
/// @param count              of members, whole batches; the number of the first is a multiple of 4
using TakeMembers = void (*)(const double* position, const double* delayed, std::size_t count,
                             const MemberValues& members, MemberWorks& works) noexcept;

/// Adds the forces of such members to their MATs, and what they have done to the sums.
/// @param force  columns of the MATs, whose fourth value stays 0
using GiveForces = void (*)(const MemberValues& members, std::size_t count, double* force,
                            MemberWorks& works) noexcept;

/// Finds length, inverse and elongation increment of all pairs.
using MeasurePairs = void (*)(const MemberColumns& members, const PairRows& rows) noexcept;

/// Adds factor * (vector from a to b) to member a and takes it from member b, for each pair. Adds
/// its share to the fourth value of both where the factor is not 0: the partners of a member.
using SpreadRows = void (*)(const PairRows& rows, const double* factor, double* force) noexcept;

/// Likewise, and gives nothing to member a; rows do not matter.
using SpreadToLater = SpreadRows;

/// A contact: tension = K e + Z / dt * elongation increment, within min_tension and max_tension.
struct LinearPair {
  double stiffness = 0.0;          // [N/m]
  double viscosity_over_dt = 0.0;  // [N/m]
  double min_tension = 0.0;        // [N]
  double max_tension = 0.0;        // [N]
};

/// Finds tension / distance of each pair, and the part of it that stores no energy.
/// @param rest  rest lengths [m]
using LinearPairs = void (*)(const LinearPair& pair, const PairRow& row, std::size_t count,
                             const double* rest, double* factor, double* viscous_factor) noexcept;

/// Friction, made ready for the contacts of a set.
struct FrictionTerm {
  double stiffness = 0.0;            // [N/m]
  double compliance = 0.0;           // 1 / stiffness; 0 without friction [m/N]
  double viscosity_over_dt = 0.0;    // [N/m]
  double static_coefficient = 0.0;   // of the push
  double kinetic_coefficient = 0.0;  // of the push
};

/// The parts of a FrictionTerm of each pair; arrays 64-byte aligned, padded to whole batches.
struct FrictionTermRows {
  const double* stiffness = nullptr;
  const double* compliance = nullptr;
  const double* viscosity_over_dt = nullptr;
  const double* static_coefficient = nullptr;
  const double* kinetic_coefficient = nullptr;
};

/// The friction of the pairs of a block.
struct FrictionTerms {
  FrictionTerm of_all;
  FrictionTermRows of_each;   // null unless pairs differ in it
  bool unit_vectors = false;  // the vectors of the pairs are normals of surfaces
};

inline constexpr double kNoContact = 0.0;
inline constexpr double kSticks = 1.0;
inline constexpr double kSlides = 2.0;

/// What belongs to the friction of each pair; arrays 64-byte aligned, padded to whole batches.
struct FrictionRows {
  double* stretch[3] = {};  // of the spring across the line of centres [m]
  double* phase = nullptr;  // kNoContact, kSticks or kSlides
  double* force[3] = {};    // force on a, and against b [N]
};

/// Takes the springs from the last step to this one, and finds the forces. That of a new contact begins at 0. Where a pair does not push, all
/// of it is 0.
/// @param factor  tension / distance of each pair
using FrictionPairs = void (*)(const FrictionTerms& terms, const MemberColumns& members,
                               const PairRows& rows, const double* factor,
                               const FrictionRows& friction) noexcept;

/// As SpreadRows, of factor * (vector from a to b) + force of friction.
using SpreadVectors = void (*)(const PairRows& rows, const double* factor,
                               const FrictionRows& friction, double* force) noexcept;

/// Lennard-Jones: tension = (attraction / d^6 - repulsion / d^12) / d.
struct LennardJonesPair {
  double attraction = 0.0;    // 24 depth s^6 [J m^6]
  double repulsion = 0.0;     // 48 depth s^12 [J m^12]
  double range_square = 0.0;  // [m^2]
  double touch_square = 0.0;  // below it a pair counts as partners [m^2]
};

/// Gathers the rows, finds the forces and spreads them.
using LennardJonesRows = void (*)(const LennardJonesPair& pair, const MemberColumns& members,
                                  const NeighbourRows& rows, const PairRow& row,
                                  double* force) noexcept;

/// Likewise, of parts of rows, and gives nothing to their first members.
using LennardJonesParts = void (*)(const LennardJonesPair& pair, const MemberColumns& members,
                                   const PartsOfRows& parts, const PairRow& row,
                                   double* force) noexcept;

struct ForceColumns;
struct PlaneBalls;
struct PlaneRow;
struct PlaneSum;
struct PlaneWorks;

/// Takes the positions of the balls of a set that are listed with planes, and adds what their last forces
/// have done. Finds the forces of the balls and of the planes, and gives the balls theirs. Pairs sum up as
/// SpreadRows does it; their vectors are the normals.
/// @param mats     columns of the MATs
/// @param members  MemberValues::moved is not used
/// @param sums     of each plane, empty; they are emptied
using StepPlanes = void (*)(const LinearPair& pair, const PlaneRow* planes, const PlaneBalls& balls,
                            const ForceColumns& mats, const MemberValues& members, PlaneSum* sums,
                            PlaneWorks& works) noexcept;

/// The loops of one width.
struct PairKernel {
  FindNear find_near = nullptr;
  KeepNear keep_near = nullptr;
  LargestMove largest_move = nullptr;
  GatherPairs gather_pairs = nullptr;
  GatherRows gather_rows = nullptr;
  GatherPlane gather_plane = nullptr;
  TakeMembers take_members = nullptr;
  GiveForces give_forces = nullptr;
  MeasurePairs measure_pairs = nullptr;
  SpreadRows spread_rows = nullptr;
  LinearPairs linear_pairs = nullptr;
  FrictionPairs friction_pairs = nullptr;
  SpreadVectors spread_vectors = nullptr;
  LennardJonesRows lennard_jones_rows = nullptr;
  SpreadToLater spread_to_later = nullptr;
  LennardJonesParts lennard_jones_parts = nullptr;
  StepPlanes step_planes = nullptr;
};

extern const PairKernel kPairKernelSse2;
extern const PairKernel kPairKernelAvx2;
extern const PairKernel kPairKernelAvx512;

const PairKernel& pair_kernel(VectorWidth width) noexcept;

}  // namespace cordis::engine
