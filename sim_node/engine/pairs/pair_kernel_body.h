// sim_node/engine/pairs/pair_kernel_body.h -- the loops over pairs, written once over the vector
// registers of each width.
//
// `Lanes` is a type of SimdPairLanes.
#pragma once

#include "sim_node/engine/laws/lennard_jones.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

template <class Lanes>
unsigned first_lanes(std::size_t count) noexcept {
  return count < Lanes::kWidth ? (1U << count) - 1U : (1U << Lanes::kWidth) - 1U;
}

/// The vectors of the lanes of a mask, 0 in the others.
template <class Lanes>
typename Lanes::Row3 only(typename Lanes::Mask mask, const typename Lanes::Row3& v) noexcept {
  return {Lanes::select(mask, v.x, Lanes::zero()), Lanes::select(mask, v.y, Lanes::zero()),
          Lanes::select(mask, v.z, Lanes::zero())};
}

template <class Lanes>
typename Lanes::Row3 plus(const typename Lanes::Row3& a, const typename Lanes::Row3& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// A register of vectors, from three arrays.
template <class Lanes>
typename Lanes::Row3 load_vectors(const double* const* arrays, std::size_t i) noexcept {
  return {Lanes::load(arrays[0] + i), Lanes::load(arrays[1] + i), Lanes::load(arrays[2] + i)};
}

template <class Lanes>
void store_vectors(double* const* arrays, std::size_t i, const typename Lanes::Row3& v) noexcept {
  Lanes::store(arrays[0] + i, v.x);
  Lanes::store(arrays[1] + i, v.y);
  Lanes::store(arrays[2] + i, v.z);
}

template <class Lanes>
std::size_t find_near(const CellTable& table, std::size_t begin, std::size_t end,
                      const NearQuery& query, std::uint32_t* found) noexcept {
  using Row = typename Lanes::Row;
  const CellTable all = table;
  const Row at_x = Lanes::every(query.x);
  const Row at_y = Lanes::every(query.y);
  const Row at_z = Lanes::every(query.z);
  const Row reach_square = Lanes::every(query.reach_square);
  const Row first = Lanes::every(query.first);
  const Row last = Lanes::every(query.last);
  std::size_t count = 0;

  const auto near = [&](std::size_t i) noexcept {
    const Row x = Lanes::load_any(all.x + i) - at_x;
    const Row y = Lanes::load_any(all.y + i) - at_y;
    const Row z = Lanes::load_any(all.z + i) - at_z;
    const Row number = Lanes::load_any(all.number + i);
    const auto in_range =
        Lanes::both(Lanes::less_or_equal(first, number), Lanes::less(number, last));
    return Lanes::bits(Lanes::both(Lanes::less(x * x + y * y + z * z, reach_square), in_range));
  };
  const auto write = [&](std::size_t i, unsigned chosen) noexcept {
    if (chosen == 0U) return;
    Lanes::pack(found + count, all.member + i, chosen);
    count += static_cast<std::size_t>(__builtin_popcount(chosen));
  };
  std::size_t i = begin;
  for (; i + Lanes::kWidth <= end; i += Lanes::kWidth) write(i, near(i));
  if (i < end) write(i, near(i) & first_lanes<Lanes>(end - i));
  return count;
}

/// Nothing is written beyond the members found: what follows them may belong to another thread.
template <class Lanes>
std::size_t keep_near(const double* position, const double* point, double reach_square,
                      std::uint32_t* found, std::size_t count) noexcept {
  using Row = typename Lanes::Row;
  const Row at_x = Lanes::every(point[0]);
  const Row at_y = Lanes::every(point[1]);
  const Row at_z = Lanes::every(point[2]);
  const Row reach = Lanes::every(reach_square);
  std::size_t kept = 0;
  std::size_t i = 0;
  for (; i + Lanes::kWidth <= count; i += Lanes::kWidth) {
    alignas(64) std::uint32_t column[Lanes::kWidth];
    for (std::size_t lane = 0; lane < Lanes::kWidth; ++lane) column[lane] = 4 * found[i + lane];
    const typename Lanes::Row3 there = Lanes::vectors(position, column);
    const Row x = there.x - at_x;
    const Row y = there.y - at_y;
    const Row z = there.z - at_z;
    const unsigned chosen = Lanes::bits(Lanes::less(x * x + y * y + z * z, reach));
    Lanes::pack(found + kept, found + i, chosen);
    kept += static_cast<std::size_t>(__builtin_popcount(chosen));
  }
  for (; i < count; ++i) {
    const double* other = position + 4 * std::size_t{found[i]};
    const double x = other[0] - point[0];
    const double y = other[1] - point[1];
    const double z = other[2] - point[2];
    found[kept] = found[i];
    kept += x * x + y * y + z * z < reach_square ? 1U : 0U;
  }
  return kept;
}

template <class Lanes>
double largest_move(const double* position, const double* from, std::size_t count) noexcept {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;
  Row largest = Lanes::zero();
  for (std::size_t i = 0; i < count; i += Lanes::kWidth) {
    const Row3 now = Lanes::neighbours(position + 4 * i);
    const Row3 then = Lanes::neighbours(from + 4 * i);
    const Row x = now.x - then.x;
    const Row y = now.y - then.y;
    const Row z = now.z - then.z;
    largest = Lanes::maximum(x * x + y * y + z * z, largest);
  }
  alignas(64) double lane[Lanes::kWidth];
  Lanes::store(lane, largest);
  double most = 0.0;
  for (const double value : lane) most = value > most ? value : most;
  return most;
}

/// Columns of padding by the place in the batch, twice.
// NOLINTNEXTLINE(misc-definitions-in-headers): each file has its own
constexpr std::uint32_t kPaddingColumns[2 * kPairBatch] = {0, 4, 8, 12, 16, 20, 24, 28,
                                                           0, 4, 8, 12, 16, 20, 24, 28};

/// Fills the last batch up, and writes a batch in all.
template <class Lanes>
void pad_row(const MemberColumns& members, std::size_t count, const PairRow& row) noexcept {
  const std::size_t place = count % kPairBatch;
  for (std::size_t i = 0; i < kPairBatch; ++i)
    row.column[count + i] = members.padding + kPaddingColumns[place + i];
  for (double* values : {row.x, row.y, row.z, row.square}) {
    for (std::size_t i = 0; i < kPairBatch; i += Lanes::kWidth)
      Lanes::store_any(values + count + i, Lanes::zero());
  }
}

template <class Lanes>
[[gnu::always_inline]] inline std::size_t find_pairs(const MemberColumns& members, std::size_t a,
                                                     const std::uint32_t* neighbour,
                                                     std::size_t candidates, double range_square,
                                                     const PairRow& row) noexcept {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;
  const PairRow out = row;  // whose arrays nothing written below can seem to move
  const double* const position = members.position;
  const Row at_x = Lanes::every(position[4 * a]);
  const Row at_y = Lanes::every(position[4 * a + 1]);
  const Row at_z = Lanes::every(position[4 * a + 2]);
  const Row range = Lanes::every(range_square);
  std::size_t count = 0;

  const auto gather = [&](std::size_t i, unsigned lanes) noexcept {
    const Row3 there = Lanes::vectors(position, neighbour + i);
    const Row x = there.x - at_x;
    const Row y = there.y - at_y;
    const Row z = there.z - at_z;
    const Row square = x * x + y * y + z * z;
    const unsigned chosen = Lanes::bits(Lanes::less(square, range)) & lanes;
    Lanes::pack(out.column + count, neighbour + i, chosen);
    Lanes::pack(out.x + count, x, chosen);
    Lanes::pack(out.y + count, y, chosen);
    Lanes::pack(out.z + count, z, chosen);
    Lanes::pack(out.square + count, square, chosen);
    count += static_cast<std::size_t>(__builtin_popcount(chosen));
  };
  std::size_t i = 0;
  for (; i + Lanes::kWidth <= candidates; i += Lanes::kWidth)
    gather(i, first_lanes<Lanes>(Lanes::kWidth));
  if (i < candidates) gather(i, first_lanes<Lanes>(candidates - i));
  return count;
}

template <class Lanes>
std::size_t gather_pairs(const MemberColumns& members, std::size_t a,
                         const std::uint32_t* neighbour, std::size_t candidates,
                         double range_square, const PairRow& row) noexcept {
  return find_pairs<Lanes>(members, a, neighbour, candidates, range_square, row);
}

template <class Lanes>
std::size_t gather_rows(const MemberColumns& members, const NeighbourRows& rows,
                        double range_square, const RowsOut& out) noexcept {
  const PairRow all = out.pairs;
  std::size_t count = 0;
  std::size_t a = rows.first;
  for (; a < rows.last && a - rows.first < out.rows && count < out.enough; ++a) {
    PairRow row;
    row.column = all.column + count;
    row.x = all.x + count;
    row.y = all.y + count;
    row.z = all.z + count;
    row.square = all.square + count;
    const std::size_t found =
        find_pairs<Lanes>(members, a, rows.neighbour + (rows.start[a] - rows.origin),
                          rows.start[a + 1] - rows.start[a], range_square, row);
    for (std::size_t i = 0; i < found; i += kPairBatch) {  // there is room for a whole batch
      for (std::size_t lane = 0; lane < kPairBatch; ++lane)
        out.column_a[count + i + lane] = static_cast<std::uint32_t>(4 * a);
    }
    count += found;
    out.start[a - rows.first] = count;
  }
  return a - rows.first;
}

template <class Lanes>
std::size_t gather_plane(const MemberColumns& members, const PlaneQuery& plane,
                         const std::uint32_t* neighbour, std::size_t candidates,
                         const PairRow& row) noexcept {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;
  const PairRow out = row;
  const double* const position = members.position;
  const double* const moved = members.moved;
  const Row3 normal{Lanes::every(plane.normal[0]), Lanes::every(plane.normal[1]),
                    Lanes::every(plane.normal[2])};
  const Row3 centre{Lanes::every(plane.centre[0]), Lanes::every(plane.centre[1]),
                    Lanes::every(plane.centre[2])};
  const Row range = Lanes::every(plane.range);
  const Row plane_moved = Lanes::every(plane.moved);
  const Row smallest = Lanes::every(kMinSquare);
  const Row one = Lanes::every(1.0);
  std::size_t count = 0;

  for (std::size_t i = 0; i < candidates; i += Lanes::kWidth) {
    const Row3 there = Lanes::vectors(position, neighbour + i);
    const Row height = normal.x * (there.x - centre.x) + normal.y * (there.y - centre.y) +
                       normal.z * (there.z - centre.z);
    const unsigned chosen =
        Lanes::bits(Lanes::less(height, range)) & first_lanes<Lanes>(candidates - i);
    if (chosen == 0U) continue;
    const Row3 way = Lanes::vectors(moved, neighbour + i);
    const Row apart = Lanes::maximum(height, Lanes::zero());
    Lanes::pack(out.column + count, neighbour + i, chosen);
    Lanes::store_any(out.x + count, normal.x);  // the same in all lanes
    Lanes::store_any(out.y + count, normal.y);
    Lanes::store_any(out.z + count, normal.z);
    Lanes::store_any(out.inverse + count, one);
    Lanes::pack(out.square + count, Lanes::maximum(apart * apart, smallest), chosen);
    Lanes::pack(out.length + count, height, chosen);
    Lanes::pack(out.elongation_increment + count,
                normal.x * way.x + normal.y * way.y + normal.z * way.z - plane_moved, chosen);
    count += static_cast<std::size_t>(__builtin_popcount(chosen));
  }
  return count;
}

template <class Lanes>
std::size_t gather_row(const MemberColumns& members, std::size_t a, const std::uint32_t* neighbour,
                       std::size_t candidates, double range_square, const PairRow& row) noexcept {
  const std::size_t count =
      gather_pairs<Lanes>(members, a, neighbour, candidates, range_square, row);
  pad_row<Lanes>(members, count, row);
  return count;
}

template <class Lanes>
typename Lanes::Row dot(const typename Lanes::Row3& u, const typename Lanes::Row3& v) noexcept {
  return u.x * v.x + u.y * v.y + u.z * v.z;
}

template <class Lanes>
typename Lanes::Row3 scaled(const typename Lanes::Row3& v, typename Lanes::Row factor) noexcept {
  return {v.x * factor, v.y * factor, v.z * factor};
}

/// A vector in all lanes.
template <class Lanes>
typename Lanes::Row3 every(const double* vector) noexcept {
  return {Lanes::every(vector[0]), Lanes::every(vector[1]), Lanes::every(vector[2])};
}

template <class Lanes>
void measure_pairs(const MemberColumns& members, const PairRows& rows) noexcept {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;
  const PairRow row = rows.pairs;
  const std::uint32_t* const column_a = rows.column_a;
  const double* const moved = members.moved;
  for (std::size_t i = 0; i < rows.count; i += Lanes::kWidth) {
    const Row square = Lanes::load(row.square + i);
    const Row length = Lanes::sqrt(square);
    const Row inverse = Lanes::inverse_or_zero(square, length);
    const Row3 a = Lanes::vectors(moved, column_a + i);
    const Row3 b = Lanes::vectors(moved, row.column + i);
    const Row along = Lanes::load(row.x + i) * (b.x - a.x) + Lanes::load(row.y + i) * (b.y - a.y) +
                      Lanes::load(row.z + i) * (b.z - a.z);
    Lanes::store(row.length + i, length);
    Lanes::store(row.inverse + i, inverse);
    Lanes::store(row.elongation_increment + i, along * inverse);
  }
}

/// What the pairs of a row give to member a, by their place in the batch.
template <class Lanes>
struct RowSum {
  static constexpr std::size_t kParts = kPairBatch / Lanes::kWidth;
  typename Lanes::Row x[kParts];
  typename Lanes::Row y[kParts];
  typename Lanes::Row z[kParts];
  typename Lanes::Row partners[kParts];  // less than 0
};

template <class Lanes>
RowSum<Lanes> no_force() noexcept {
  RowSum<Lanes> sum;
  for (std::size_t part = 0; part < RowSum<Lanes>::kParts; ++part) {
    sum.x[part] = Lanes::zero();
    sum.y[part] = Lanes::zero();
    sum.z[part] = Lanes::zero();
    sum.partners[part] = Lanes::zero();
  }
  return sum;
}

/// -1 in the lanes of a mask, else 0. The fourth value of a column of forces counts the partners of
/// the member; it is subtracted, as the force on the second end is.
template <class Lanes>
typename Lanes::Row less_one(typename Lanes::Mask mask) noexcept {
  return Lanes::select(mask, Lanes::every(-1.0), Lanes::zero());
}

/// Takes a register of forces from the second ends of its pairs, and adds them to the sum.
/// @param column   of these
/// @param partner  less what each counts for as a partner
template <class Lanes>
[[gnu::always_inline]] inline void spread_register(const std::uint32_t* column,
                                                   const typename Lanes::Row3& tension,
                                                   typename Lanes::Row partner, double* force,
                                                   RowSum<Lanes>& sum, std::size_t part) noexcept {
  sum.x[part] = sum.x[part] + tension.x;
  sum.y[part] = sum.y[part] + tension.y;
  sum.z[part] = sum.z[part] + tension.z;
  sum.partners[part] = sum.partners[part] + partner;
  Lanes::subtract(force, column, tension, partner);
}

/// Less what pairs count for as partners: nothing where the factor is 0.
template <class Lanes>
typename Lanes::Row less_share(const PartnerShare& share, typename Lanes::Row length,
                               typename Lanes::Row factor) noexcept {
  const auto near = Lanes::less(length, Lanes::every(share.near));
  const auto counted = Lanes::select(near, Lanes::every(-1.0), Lanes::every(-share.beyond));
  return Lanes::select(Lanes::not_equal(factor, Lanes::zero()), counted, Lanes::zero());
}

/// From a to b.
template <class Lanes>
typename Lanes::Row3 vectors_of(const PairRow& row, std::size_t i) noexcept {
  return {Lanes::load(row.x + i), Lanes::load(row.y + i), Lanes::load(row.z + i)};
}

/// Adds the sums to a column.
template <class Lanes>
void give(const RowSum<Lanes>& sum, double* column) noexcept {
  typename Lanes::Row partners[RowSum<Lanes>::kParts];
  for (std::size_t part = 0; part < RowSum<Lanes>::kParts; ++part)
    partners[part] = Lanes::zero() - sum.partners[part];
  Lanes::store_column(column,
                      Lanes::load_column(column) + Lanes::sum_batch(sum.x, sum.y, sum.z, partners));
}

alignas(64) constexpr double kLaneNumber[] = {0, 1, 2, 3, 4, 5, 6, 7};
static_assert(sizeof(kLaneNumber) == kPairBatch * sizeof(double));

/// The first `count` lanes, 0 in the others.
template <class Lanes>
typename Lanes::Row first_of(std::size_t count, typename Lanes::Row row) noexcept {
  const auto own = Lanes::less(Lanes::load(kLaneNumber), Lanes::every(static_cast<double>(count)));
  return Lanes::select(own, row, Lanes::zero());
}

/// factor * (vector from a to b).
template <class Lanes>
typename Lanes::Row3 along_pairs(const PairRow& row, std::size_t i,
                                 const double* factors) noexcept {
  return scaled<Lanes>(vectors_of<Lanes>(row, i), Lanes::load(factors + i));
}

/// Adds what the pairs of each row give to its member. A batch begins with its row.
template <class Lanes>
void sum_rows(const PairRows& rows, double* force) noexcept {
  for (std::size_t a = rows.first; a < rows.last; ++a) {
    const std::size_t begin = rows.start[a - rows.first];
    const std::size_t end = rows.start[a - rows.first + 1];
    if (begin == end) continue;
    RowSum<Lanes> sum = no_force<Lanes>();
    for (std::size_t i = begin; i < end; i += kPairBatch) {
#pragma GCC unroll 4
      for (std::size_t part = 0; part < RowSum<Lanes>::kParts; ++part) {
        const std::size_t first = i + part * Lanes::kWidth;
        if (first >= end) break;
        const std::size_t count = end - first;
        const auto some = [&](std::size_t which) noexcept {
          const auto row = Lanes::load_any(rows.forces[which] + first);
          return count < Lanes::kWidth ? first_of<Lanes>(count, row) : row;
        };
        sum.x[part] = sum.x[part] + some(0);
        sum.y[part] = sum.y[part] + some(1);
        sum.z[part] = sum.z[part] + some(2);
        sum.partners[part] = sum.partners[part] + some(3);
      }
    }
    give<Lanes>(sum, force + 4 * a);
  }
}

/// First what the second ends get, in whole registers: a row takes from later members alone, so no sum changes.
/// @param force_of  of the pairs from a number on: what they give to a
template <class Lanes, class ForceOf>
void spread_all(const PairRows& rows, const double* factor, double* force,
                ForceOf force_of) noexcept {
  double* const* const forces = rows.forces;
  for (std::size_t i = 0; i < rows.count; i += Lanes::kWidth) {
    const typename Lanes::Row3 tension = force_of(i);
    const auto partner =
        less_share<Lanes>(rows.share, Lanes::load(rows.pairs.length + i), Lanes::load(factor + i));
    Lanes::store(forces[0] + i, tension.x);
    Lanes::store(forces[1] + i, tension.y);
    Lanes::store(forces[2] + i, tension.z);
    Lanes::store(forces[3] + i, partner);
    Lanes::subtract(force, rows.pairs.column + i, tension, partner);
  }
  sum_rows<Lanes>(rows, force);
}

template <class Lanes>
void spread_rows(const PairRows& rows, const double* factor, double* force) noexcept {
  spread_all<Lanes>(rows, factor, force, [&](std::size_t i) noexcept {
    return along_pairs<Lanes>(rows.pairs, i, factor);
  });
}

template <class Lanes>
void spread_vectors(const PairRows& rows, const double* factor, const FrictionRows& friction,
                    double* force) noexcept {
  spread_all<Lanes>(rows, factor, force, [&](std::size_t i) noexcept {
    return plus<Lanes>(along_pairs<Lanes>(rows.pairs, i, factor),
                       load_vectors<Lanes>(friction.force, i));
  });
}

template <class Lanes>
void linear_pairs(const LinearPair& pair, const PairRow& row, std::size_t count, const double* rest,
                  double* factor, double* viscous_factor) noexcept {
  using Row = typename Lanes::Row;
  const Row stiffness = Lanes::every(pair.stiffness);
  const Row viscosity = Lanes::every(pair.viscosity_over_dt);
  const Row min_tension = Lanes::every(pair.min_tension);
  const Row max_tension = Lanes::every(pair.max_tension);
  for (std::size_t i = 0; i < count; i += Lanes::kWidth) {
    const Row inverse = Lanes::load(row.inverse + i);
    const Row elongation = Lanes::load(row.length + i) - Lanes::load(rest + i);
    const Row elastic = stiffness * elongation;
    const Row tension = elastic + viscosity * Lanes::load(row.elongation_increment + i);
    const Row limited = Lanes::minimum(max_tension, Lanes::maximum(min_tension, tension));
    const Row stored = Lanes::minimum(max_tension, Lanes::maximum(min_tension, elastic));
    Lanes::store(factor + i, limited * inverse);
    Lanes::store(viscous_factor + i, (limited - stored) * inverse);
  }
}

/// Adds the works of a batch of members, each of them to the sum of its place.
template <class Lanes>
void add_works(const MemberValues& members, std::size_t first, MemberWorks& works) noexcept {
  alignas(64) double work[kPairBatch];
  const auto add = [&](const double* force, double* sums) noexcept {
    for (std::size_t i = 0; i < kPairBatch; i += Lanes::kWidth) {
      const std::size_t column = 4 * (first + i);
      Lanes::store(work + i, dot<Lanes>(Lanes::neighbours(force + column),
                                        Lanes::neighbours(members.moved + column)));
    }
    for (std::size_t i = 0; i < kPairBatch; ++i) sums[i % 4] += work[i];
  };
  add(members.force, works.all);
  if (members.viscous != nullptr) add(members.viscous, works.viscous);
}

template <class Lanes>
void take_members(const double* position, const double* delayed, std::size_t count,
                  const MemberValues& members, MemberWorks& works) noexcept {
  const MemberValues own = members;
  MemberWorks sums = works;
  for (std::size_t m = 0; m < count; m += kPairBatch) {
    for (std::size_t i = 4 * m; i < 4 * (m + kPairBatch); i += 4) {
      const auto here = Lanes::load_column(position + i);
      Lanes::store_column(own.position + i, here);
      Lanes::store_column(own.moved + i, here - Lanes::load_column(delayed + i));
    }
    add_works<Lanes>(own, m, sums);
  }
  works = sums;
}

template <class Lanes>
void give_forces(const MemberValues& members, std::size_t count, double* force,
                 MemberWorks& works) noexcept {
  alignas(32) constexpr double kWithoutPartners[] = {1.0, 1.0, 1.0, 0.0};
  const auto vector = Lanes::load_column(kWithoutPartners);
  const MemberValues own = members;
  MemberWorks sums = works;
  for (std::size_t m = 0; m < count; m += kPairBatch) {
    for (std::size_t i = 4 * m; i < 4 * (m + kPairBatch); i += 4) {
      Lanes::store_column(
          force + i, Lanes::load_column(force + i) + Lanes::load_column(own.force + i) * vector);
    }
    add_works<Lanes>(own, m, sums);
  }
  works = sums;
}

/// The displacement of b relative to a across the line of centres in the last period [m].
template <class Lanes>
typename Lanes::Row3 slid(const MemberColumns& members, const PairRows& rows, std::size_t i,
                          const typename Lanes::Row3& normal) noexcept {
  const auto a = Lanes::vectors(members.moved, rows.column_a + i);
  const auto b = Lanes::vectors(members.moved, rows.pairs.column + i);
  const auto along = Lanes::load(rows.pairs.elongation_increment + i);
  return {(b.x - a.x) - along * normal.x, (b.y - a.y) - along * normal.y,
          (b.z - a.z) - along * normal.z};
}

/// The spring of a contact that slides is never shorter, for it has the direction in which it slides.
/// Its energy is 0: the square is too small for a number [m].
inline constexpr double kShortestStretch = 0x1p-600;

/// The friction of a batch of pairs.
template <class Lanes>
struct FrictionOfBatch {
  using Row = typename Lanes::Row;

  explicit FrictionOfBatch(const FrictionTerm& term) noexcept
      : stiffness(Lanes::every(term.stiffness)),
        compliance(Lanes::every(term.compliance)),
        viscosity(Lanes::every(term.viscosity_over_dt)),
        sticking(Lanes::every(term.static_coefficient)),
        kinetic(Lanes::every(term.kinetic_coefficient)) {}
  FrictionOfBatch(const FrictionTermRows& rows, std::size_t i) noexcept
      : stiffness(Lanes::load(rows.stiffness + i)),
        compliance(Lanes::load(rows.compliance + i)),
        viscosity(Lanes::load(rows.viscosity_over_dt + i)),
        sticking(Lanes::load(rows.static_coefficient + i)),
        kinetic(Lanes::load(rows.kinetic_coefficient + i)) {}

  Row stiffness;
  Row compliance;
  Row viscosity;
  Row sticking;
  Row kinetic;
};

/// The friction of a register of contacts.
template <class Lanes>
struct Rubbing {
  typename Lanes::Row3 stretch;  // of the springs [m]
  typename Lanes::Row3 force;    // on a, and against b [N]
  typename Lanes::Row phase;     // kSticks or kSlides
};

/// What slides is limited, and its spring with it. Neither ever takes up more than the force takes from
/// the motion: docs/integrators.md.
/// @param way      of b relative to a across the normal in the last period [m]
/// @param stretch  as the last step left it, and the phase; kNoContact of a new one
template <class Lanes>
[[gnu::always_inline]] inline Rubbing<Lanes> rub(const FrictionOfBatch<Lanes>& term,
                                                 typename Lanes::Row push,
                                                 const typename Lanes::Row3& normal,
                                                 const typename Lanes::Row3& way,
                                                 typename Lanes::Row3 stretch,
                                                 typename Lanes::Row phase) noexcept {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;
  const Row one = Lanes::every(1.0);
  const Row none = Lanes::zero();
  const Row turned = dot<Lanes>(stretch, normal);  // the normal has turned since
  stretch.x = stretch.x - turned * normal.x;
  stretch.y = stretch.y - turned * normal.y;
  stretch.z = stretch.z - turned * normal.z;
  const auto is_known = Lanes::less(none, phase);
  const auto slid_before = Lanes::less(Lanes::every(kSticks), phase);
  const auto onward = Lanes::both(slid_before, Lanes::less(none, dot<Lanes>(way, stretch)));
  stretch.x = Lanes::select(is_known, stretch.x + way.x, none);
  stretch.y = Lanes::select(is_known, stretch.y + way.y, none);
  stretch.z = Lanes::select(is_known, stretch.z + way.z, none);
  Row3 tangential{term.stiffness * stretch.x + term.viscosity * way.x,
                  term.stiffness * stretch.y + term.viscosity * way.y,
                  term.stiffness * stretch.z + term.viscosity * way.z};
  const Row square = dot<Lanes>(tangential, tangential);
  const Row limit = Lanes::select(onward, term.kinetic, term.sticking) * push;
  const auto beyond = Lanes::less(limit * limit, square);
  if (Lanes::bits(beyond) != 0U) {
    const Row most = term.kinetic * push;
    const Row share = most * Lanes::inverse_or_zero(square, Lanes::sqrt(square));
    tangential = scaled<Lanes>(tangential, Lanes::select(beyond, share, one));
    const Row longest = Lanes::maximum(most * term.compliance, Lanes::every(kShortestStretch));
    const Row stretch_square = dot<Lanes>(stretch, stretch);
    const auto longer = Lanes::both(beyond, Lanes::less(longest * longest, stretch_square));
    const Row left = longest * Lanes::inverse_or_zero(stretch_square, Lanes::sqrt(stretch_square));
    stretch = scaled<Lanes>(stretch, Lanes::select(longer, left, one));
  }
  const auto slides = Lanes::either(beyond, onward);
  return {stretch, tangential, Lanes::select(slides, Lanes::every(kSlides), Lanes::every(kSticks))};
}

template <class Lanes, bool kOfEach>
void friction_of_pairs(const FrictionTerms& terms, const MemberColumns& members,
                       const PairRows& rows, const double* factor,
                       const FrictionRows& friction) noexcept {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;
  const PairRow row = rows.pairs;
  FrictionOfBatch<Lanes> term(terms.of_all);
  const bool unit_vectors = terms.unit_vectors;
  const Row none = Lanes::zero();
  for (std::size_t i = 0; i < rows.count; i += Lanes::kWidth) {
    if constexpr (kOfEach) term = FrictionOfBatch<Lanes>(terms.of_each, i);
    const Row reach = unit_vectors ? Lanes::every(1.0) : Lanes::load(row.length + i);
    const Row push = none - Lanes::load(factor + i) * reach;
    auto touches = Lanes::less(none, push);
    if constexpr (kOfEach) touches = Lanes::both(touches, Lanes::less(none, term.stiffness));
    if (Lanes::bits(touches) == 0U) {
      store_vectors<Lanes>(friction.stretch, i, {none, none, none});
      store_vectors<Lanes>(friction.force, i, {none, none, none});
      Lanes::store(friction.phase + i, none);
      continue;
    }
    const Row inverse = Lanes::load(row.inverse + i);
    const Row3 normal{Lanes::load(row.x + i) * inverse, Lanes::load(row.y + i) * inverse,
                      Lanes::load(row.z + i) * inverse};
    const Row3 way = slid<Lanes>(members, rows, i, normal);
    const Rubbing<Lanes> rubbing =
        rub<Lanes>(term, push, normal, way, load_vectors<Lanes>(friction.stretch, i),
                   Lanes::load(friction.phase + i));
    store_vectors<Lanes>(friction.stretch, i, only<Lanes>(touches, rubbing.stretch));
    store_vectors<Lanes>(friction.force, i, only<Lanes>(touches, rubbing.force));
    Lanes::store(friction.phase + i, Lanes::select(touches, rubbing.phase, none));
  }
}

template <class Lanes>
void friction_pairs(const FrictionTerms& terms, const MemberColumns& members, const PairRows& rows,
                    const double* factor, const FrictionRows& friction) noexcept {
  if (terms.of_each.stiffness == nullptr) {
    friction_of_pairs<Lanes, false>(terms, members, rows, factor, friction);
  } else {
    friction_of_pairs<Lanes, true>(terms, members, rows, factor, friction);
  }
}

/// The pairs of a row from MemberColumns::end on give their force to padding. Pairs ascend in a row.
template <class Lanes>
void redirect_row(const MemberColumns& members, std::size_t count, const PairRow& row) noexcept {
  for (std::size_t i = count; i > 0 && row.column[i - 1] >= members.end; --i)
    row.column[i - 1] = members.padding + 4 * static_cast<std::uint32_t>((i - 1) % kPairBatch);
}

/// Finds the forces of the pairs of a row, and spreads them.
/// @param sum  what member a gets
template <class Lanes>
[[gnu::always_inline]] inline void lennard_jones_row(const LennardJonesPair& pair,
                                                     const PairRow& row, std::size_t count,
                                                     double* force, RowSum<Lanes>& sum) noexcept {
  using Row = typename Lanes::Row;
  const Row attraction = Lanes::every(pair.attraction);
  const Row repulsion = Lanes::every(pair.repulsion);
  const Row touch_square = Lanes::every(pair.touch_square);
  for (std::size_t i = 0; i < count; i += kPairBatch) {
#pragma GCC unroll 4
    for (std::size_t part = 0; part < RowSum<Lanes>::kParts; ++part) {
      const std::size_t first = i + part * Lanes::kWidth;
      if (first >= count) break;  // padding gives nothing
      const Row square = Lanes::load(row.square + first);
      const Row factor = LennardJones::tension_per_distance<Lanes>(attraction, repulsion, square);
      const auto touching =
          Lanes::both(Lanes::less(square, touch_square), Lanes::not_equal(square, Lanes::zero()));
      spread_register<Lanes>(row.column + first,
                             scaled<Lanes>(vectors_of<Lanes>(row, first), factor),
                             less_one<Lanes>(touching), force, sum, part);
    }
  }
}

template <class Lanes>
void lennard_jones_rows(const LennardJonesPair& pair, const MemberColumns& members,
                        const NeighbourRows& rows, const PairRow& all, double* force) noexcept {
  const PairRow row = all;
  for (std::size_t a = rows.first; a < rows.last; ++a) {
    const std::uint32_t* neighbour = rows.neighbour + (rows.start[a] - rows.origin);
    const std::size_t count = gather_row<Lanes>(
        members, a, neighbour, rows.start[a + 1] - rows.start[a], pair.range_square, row);
    redirect_row<Lanes>(members, count, row);
    RowSum<Lanes> sum = no_force<Lanes>();
    lennard_jones_row<Lanes>(pair, row, count, force, sum);
    give<Lanes>(sum, force + 4 * a);
  }
}

template <class Lanes>
void lennard_jones_parts(const LennardJonesPair& pair, const MemberColumns& members,
                         const PartsOfRows& parts, const PairRow& all, double* force) noexcept {
  const PairRow row = all;
  for (std::size_t i = 0; i < parts.count; ++i) {
    const PartOfRow part = parts.parts[i];
    const std::size_t count = gather_row<Lanes>(members, part.row, parts.neighbour + part.begin,
                                                part.count, pair.range_square, row);
    RowSum<Lanes> unused = no_force<Lanes>();
    lennard_jones_row<Lanes>(pair, row, count, force, unused);
  }
}

template <class Lanes>
void spread_to_later(const PairRows& rows, const double* factor, double* force) noexcept {
  for (std::size_t i = 0; i < rows.count; i += Lanes::kWidth) {
    const auto partner =
        less_share<Lanes>(rows.share, Lanes::load(rows.pairs.length + i), Lanes::load(factor + i));
    Lanes::subtract(force, rows.pairs.column + i, along_pairs<Lanes>(rows.pairs, i, factor),
                    partner);
  }
}

}  // namespace cordis::engine
