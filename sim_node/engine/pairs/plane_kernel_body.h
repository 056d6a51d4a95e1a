// sim_node/engine/pairs/plane_kernel_body.h -- the loop over balls near planes, written once over the vector
// registers of each width.
//
// `Lanes` is a type of SimdPairLanes.
#pragma once

#include "sim_node/engine/matter/step_kernel.h"
#include "sim_node/engine/pairs/pair_kernel_body.h"
#include "sim_node/engine/pairs/plane_kernel.h"

namespace cordis::engine {

/// A vector in all lanes.
template <class Lanes>
typename Lanes::Row3 every(const double* vector) noexcept {
  return {Lanes::every(vector[0]), Lanes::every(vector[1]), Lanes::every(vector[2])};
}

/// The vectors of the lanes of a mask, 0 in the others.
template <class Lanes>
typename Lanes::Row3 only(typename Lanes::Mask mask, const typename Lanes::Row3& v) noexcept {
  return {Lanes::select(mask, v.x, Lanes::zero()), Lanes::select(mask, v.y, Lanes::zero()),
          Lanes::select(mask, v.z, Lanes::zero())};
}

/// Forces on a register of balls, and less their partners.
template <class Lanes>
struct ForcesOnBalls {
  typename Lanes::Row3 force{Lanes::zero(), Lanes::zero(), Lanes::zero()};
  typename Lanes::Row partners = Lanes::zero();
};

/// Takes factor * normal from the forces; a factor that is 0 counts for no partner.
template <class Lanes>
void take_pairs(const typename Lanes::Row3& normal, typename Lanes::Row factor,
                ForcesOnBalls<Lanes>& on) noexcept {
  on.force.x = on.force.x - normal.x * factor;
  on.force.y = on.force.y - normal.y * factor;
  on.force.z = on.force.z - normal.z * factor;
  on.partners = on.partners + less_one<Lanes>(Lanes::not_equal(factor, Lanes::zero()));
}

/// The force of a pair on its ball.
template <class Lanes>
typename Lanes::Row3 force_of_pair(const typename Lanes::Row3& normal,
                                   typename Lanes::Row factor) noexcept {
  return {Lanes::zero() - normal.x * factor, Lanes::zero() - normal.y * factor,
          Lanes::zero() - normal.z * factor};
}

/// Adds whole batches of factors to the sums of a plane.
/// @param sums  x, y, z and less the partners, by the place in the batch
template <class Lanes>
void add_factors(const PlaneRow& plane, const double* factor, std::size_t count,
                 double (*sums)[kPairBatch]) noexcept {
  using Row = typename Lanes::Row;
  const typename Lanes::Row3 normal = every<Lanes>(plane.normal);
#pragma GCC unroll 4
  for (std::size_t place = 0; place < kPairBatch; place += Lanes::kWidth) {
    Row x = Lanes::load(sums[0] + place);
    Row y = Lanes::load(sums[1] + place);
    Row z = Lanes::load(sums[2] + place);
    Row partners = Lanes::load(sums[3] + place);
    for (std::size_t i = place; i < count; i += kPairBatch) {
      const Row of_pair = Lanes::load(factor + i);
      x = x + normal.x * of_pair;
      y = y + normal.y * of_pair;
      z = z + normal.z * of_pair;
      partners = partners + less_one<Lanes>(Lanes::not_equal(of_pair, Lanes::zero()));
    }
    Lanes::store(sums[0] + place, x);
    Lanes::store(sums[1] + place, y);
    Lanes::store(sums[2] + place, z);
    Lanes::store(sums[3] + place, partners);
  }
}

/// Adds the first factors, and moves what is left to the beginning.
template <class Lanes, bool kViscous>
void add_full_batches(const PlaneRow& plane, PlaneSum& sum) noexcept {
  add_factors<Lanes>(plane, sum.factor, PlaneSum::kRoom, sum.force);
  if constexpr (kViscous)
    add_factors<Lanes>(plane, sum.viscous_factor, PlaneSum::kRoom, sum.viscous);
  for (std::size_t i = 0; i < kPairBatch; i += Lanes::kWidth) {
    Lanes::store(sum.factor + i, Lanes::load(sum.factor + PlaneSum::kRoom + i));
    if constexpr (kViscous)
      Lanes::store(sum.viscous_factor + i, Lanes::load(sum.viscous_factor + PlaneSum::kRoom + i));
  }
  sum.count -= PlaneSum::kRoom;
}

/// Adds all factors, writes the sums to a column, and empties them.
template <class Lanes>
void end_sum(const PlaneRow& plane, double* factor, std::size_t count, double (*sums)[kPairBatch],
             double* column) noexcept {
  for (std::size_t i = 0; i < kPairBatch; i += Lanes::kWidth)
    Lanes::store_any(factor + count + i, Lanes::zero());
  add_factors<Lanes>(plane, factor, count, sums);
  RowSum<Lanes> all;
  for (std::size_t part = 0; part < RowSum<Lanes>::kParts; ++part) {
    const std::size_t place = part * Lanes::kWidth;
    all.x[part] = Lanes::load(sums[0] + place);
    all.y[part] = Lanes::load(sums[1] + place);
    all.z[part] = Lanes::load(sums[2] + place);
    all.partners[part] = Lanes::load(sums[3] + place);
    for (std::size_t which = 0; which < 4; ++which)
      Lanes::store(sums[which] + place, Lanes::zero());
  }
  Lanes::store_column(column, Lanes::broadcast(0.0));
  give<Lanes>(all, column);
}

/// A register of balls.
template <class Lanes>
struct SomeBalls {
  typename Lanes::Mask listed;
  typename Lanes::Row3 place;
  typename Lanes::Row3 way;  // 0 of those that are not listed
  const double* radius;      // null: the rest length is that of the plane
};

/// Factors of the pairs of a register of balls with one plane, 0 out of range.
template <class Lanes>
struct PlaneFactors {
  typename Lanes::Row all = Lanes::zero();
  typename Lanes::Row viscous = Lanes::zero();
};

/// Finds the pairs of a register of balls with one plane, and adds them to the sums of the plane.
template <class Lanes, bool kViscous>
PlaneFactors<Lanes> find_factors(const LinearPair& pair, const PlaneRow& plane, double range,
                                 const SomeBalls<Lanes>& balls, PlaneSum& sum) noexcept {
  using Row = typename Lanes::Row;
  const typename Lanes::Row3 normal = every<Lanes>(plane.normal);
  const typename Lanes::Row3 centre = every<Lanes>(plane.centre);
  const Row height = dot<Lanes>(
      normal, {balls.place.x - centre.x, balls.place.y - centre.y, balls.place.z - centre.z});
  const auto near = Lanes::both(balls.listed, Lanes::less(height, Lanes::every(range)));
  const unsigned chosen = Lanes::bits(near);
  PlaneFactors<Lanes> factors;
  if (chosen == 0U) return factors;
  Row rest_length = Lanes::every(plane.rest_length);
  if (balls.radius != nullptr) rest_length = rest_length + Lanes::load(balls.radius);
  const Row min_tension = Lanes::every(pair.min_tension);
  const Row max_tension = Lanes::every(pair.max_tension);
  const Row increment = dot<Lanes>(normal, balls.way) - Lanes::every(plane.moved);
  const Row elastic = Lanes::every(pair.stiffness) * (height - rest_length);
  const Row tension = elastic + Lanes::every(pair.viscosity_over_dt) * increment;
  const Row limited = Lanes::minimum(max_tension, Lanes::maximum(min_tension, tension));
  factors.all = Lanes::select(near, limited, Lanes::zero());
  const std::size_t count = sum.count;
  Lanes::pack(sum.factor + count, factors.all, chosen);
  if constexpr (kViscous) {
    const Row stored = Lanes::minimum(max_tension, Lanes::maximum(min_tension, elastic));
    factors.viscous = Lanes::select(near, limited - stored, Lanes::zero());
    Lanes::pack(sum.viscous_factor + count, factors.viscous, chosen);
  }
  sum.count = count + static_cast<std::size_t>(__builtin_popcount(chosen));
  if (sum.count >= PlaneSum::kRoom) add_full_batches<Lanes, kViscous>(plane, sum);
  return factors;
}

/// Adds 8 works to the sums of their places.
template <class Lanes>
void add_batch(const double* work, typename Lanes::Column& sums) noexcept {
  sums = sums + Lanes::load_column(work);
  sums = sums + Lanes::load_column(work + 4);
}

/// The works of a batch, and their sums.
template <class Lanes>
struct WorksOfBatches {
  alignas(64) double batch[kPairBatch];
  typename Lanes::Column sums = Lanes::broadcast(0.0);

  void enter(std::size_t place, const typename Lanes::Row3& force,
             const typename Lanes::Row3& way) noexcept {
    Lanes::store(batch + place, dot<Lanes>(force, way));
  }
};

/// The works of all batches.
template <class Lanes>
struct WorksOfStep {
  WorksOfBatches<Lanes> last;
  WorksOfBatches<Lanes> last_viscous;
  WorksOfBatches<Lanes> now;
  WorksOfBatches<Lanes> now_viscous;

  template <bool kViscous>
  void end_batch() noexcept {
    add_batch<Lanes>(last.batch, last.sums);
    add_batch<Lanes>(now.batch, now.sums);
    if constexpr (kViscous) {
      add_batch<Lanes>(last_viscous.batch, last_viscous.sums);
      add_batch<Lanes>(now_viscous.batch, now_viscous.sums);
    }
  }
};

/// Enters what the last forces of a register of balls have done, from member m on, place i of its batch.
template <class Lanes, bool kViscous>
void end_last_forces(const PlaneRow* planes, const PlaneBalls& balls, const MemberValues& members,
                     std::size_t m, std::size_t i, const typename Lanes::Row3& way,
                     WorksOfStep<Lanes>& works) noexcept {
  const std::size_t held = balls.held_plane[m / kPairBatch];
  if (held == kNoPlane) {
    works.last.enter(i, Lanes::neighbours(members.force + 4 * m), way);
    if constexpr (kViscous)
      works.last_viscous.enter(i, Lanes::neighbours(members.viscous + 4 * m), way);
    return;
  }
  const typename Lanes::Row3 normal = every<Lanes>(planes[held].normal);
  works.last.enter(i, force_of_pair<Lanes>(normal, Lanes::load(balls.factor + m)), way);
  if constexpr (kViscous)
    works.last_viscous.enter(i, force_of_pair<Lanes>(normal, Lanes::load(balls.viscous_factor + m)),
                             way);
}

/// Takes the places of the balls of a batch that are listed.
template <class Lanes>
void take_places(const PlaneBalls& balls, std::size_t batch, const double* position,
                 double* own_position) noexcept {
  const std::uint32_t* const column = balls.column + kPairBatch * batch;
  double* const own = own_position + 4 * kPairBatch * batch;
  const unsigned listed = balls.batches.balls[batch];
  if (listed == (1U << kPairBatch) - 1U && balls.is_run[batch] != 0) {
    for (std::size_t i = 0; i < kPairBatch; i += Lanes::kWidth)
      Lanes::copy_neighbours(own + 4 * i, position + *column + 4 * i);
    return;
  }
  for (unsigned left = listed; left != 0U; left &= left - 1U) {
    const auto i = static_cast<std::size_t>(__builtin_ctz(left));
    Lanes::store_column(own + 4 * i, Lanes::load_column(position + column[i]));
  }
}

/// Finds the forces of a register of balls with one plane, and keeps their factors.
template <class Lanes, bool kViscous>
ForcesOnBalls<Lanes> step_with_one_plane(const LinearPair& pair, const PlaneRow& plane,
                                         const PlaneBalls& balls, std::size_t m, std::size_t i,
                                         const SomeBalls<Lanes>& some, PlaneSum& sum,
                                         WorksOfStep<Lanes>& works) noexcept {
  const PlaneFactors<Lanes> factors =
      find_factors<Lanes, kViscous>(pair, plane, balls.range, some, sum);
  const typename Lanes::Row3 normal = every<Lanes>(plane.normal);
  Lanes::store(balls.factor + m, factors.all);
  if constexpr (kViscous) {
    Lanes::store(balls.viscous_factor + m, factors.viscous);
    works.now_viscous.enter(i, force_of_pair<Lanes>(normal, factors.viscous), some.way);
  }
  return {force_of_pair<Lanes>(normal, factors.all),
          less_one<Lanes>(Lanes::not_equal(factors.all, Lanes::zero()))};
}

/// Likewise with several planes, whose forces are summed; keeps the sums.
template <class Lanes, bool kViscous>
ForcesOnBalls<Lanes> step_with_planes(const LinearPair& pair, const PlaneRow* planes,
                                      const PlaneBalls& balls, std::size_t m, std::size_t i,
                                      const SomeBalls<Lanes>& some, PlaneSum* sums,
                                      const MemberValues& members,
                                      WorksOfStep<Lanes>& works) noexcept {
  ForcesOnBalls<Lanes> on;
  ForcesOnBalls<Lanes> viscous_on;
  for (std::uint64_t left = balls.batches.surfaces[m / kPairBatch]; left != 0U; left &= left - 1U) {
    const auto plane = static_cast<std::size_t>(__builtin_ctzll(left));
    const PlaneFactors<Lanes> factors =
        find_factors<Lanes, kViscous>(pair, planes[plane], balls.range, some, sums[plane]);
    const typename Lanes::Row3 normal = every<Lanes>(planes[plane].normal);
    take_pairs<Lanes>(normal, factors.all, on);
    if constexpr (kViscous) take_pairs<Lanes>(normal, factors.viscous, viscous_on);
  }
  Lanes::store_columns(members.force + 4 * m, on.force, Lanes::zero() - on.partners);
  if constexpr (kViscous) {
    works.now_viscous.enter(i, viscous_on.force, some.way);
    Lanes::store_columns(members.viscous + 4 * m, viscous_on.force,
                         Lanes::zero() - viscous_on.partners);
  }
  return on;
}

/// Gives the forces of a register of balls that are listed to their MATs.
template <class Lanes>
void give_forces_to(double* force, const std::uint32_t* column, bool is_run,
                    typename Lanes::Mask listed, const typename Lanes::Row3& v) noexcept {
  const typename Lanes::Row nothing =
      Lanes::every(-0.0);  // it changes no force, not even one of -0
  const typename Lanes::Row3 given{Lanes::select(listed, v.x, nothing),
                                   Lanes::select(listed, v.y, nothing),
                                   Lanes::select(listed, v.z, nothing)};
  if (is_run) {
    Lanes::add_to_neighbours(force + *column, given);
  } else {
    Lanes::add(force, column, given);
  }
}

template <class Lanes, bool kViscous>
void step_near_planes(const LinearPair& law, const PlaneRow* planes, const PlaneBalls& all_balls,
                      const ForceColumns& mats, const MemberValues& all_members, PlaneSum* sums,
                      PlaneWorks& result) noexcept {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;
  const LinearPair pair = law;
  const PlaneBalls balls = all_balls;
  const MemberValues members = all_members;
  const double* const position = mats.position;
  const double* const delayed = mats.delayed;
  double* const force = mats.force;
  WorksOfStep<Lanes> works;
  Row less_partners = Lanes::zero();

  for (std::size_t batch = 0; batch < balls.batches.count; ++batch) {
    const std::uint64_t near_planes = balls.batches.surfaces[batch];
    if (near_planes == 0U) continue;
    const bool is_one_plane = (near_planes & (near_planes - 1U)) == 0U;
    const auto first_plane = static_cast<std::size_t>(__builtin_ctzll(near_planes));
    const bool is_run = balls.is_run[batch] != 0;
    const unsigned listed_of_batch = balls.batches.balls[batch];
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kPairBatch; i += Lanes::kWidth) {
      const std::size_t m = kPairBatch * batch + i;
      const std::uint32_t* const column = balls.column + m;
      const Row3 place =
          is_run ? Lanes::neighbours(position + *column) : Lanes::vectors(position, column);
      const Row3 before =
          is_run ? Lanes::neighbours(delayed + *column) : Lanes::vectors(delayed, column);
      const auto listed = Lanes::mask(listed_of_batch >> i & first_lanes<Lanes>(Lanes::kWidth));
      const SomeBalls<Lanes> some{
          listed, place,
          only<Lanes>(listed, {place.x - before.x, place.y - before.y, place.z - before.z}),
          balls.radius == nullptr ? nullptr : balls.radius + m};
      end_last_forces<Lanes, kViscous>(planes, balls, members, m, i, some.way, works);
      const ForcesOnBalls<Lanes> on =
          is_one_plane ? step_with_one_plane<Lanes, kViscous>(pair, planes[first_plane], balls, m,
                                                              i, some, sums[first_plane], works)
                       : step_with_planes<Lanes, kViscous>(pair, planes, balls, m, i, some, sums,
                                                           members, works);
      works.now.enter(i, on.force, some.way);
      less_partners = Lanes::minimum(Lanes::load(balls.is_mass + m) * on.partners, less_partners);
      give_forces_to<Lanes>(force, column, is_run, listed, on.force);
    }
    works.template end_batch<kViscous>();
    balls.held_plane[batch] = is_one_plane ? static_cast<std::uint8_t>(first_plane) : kNoPlane;
    take_places<Lanes>(balls, batch, position, members.position);
  }

  for (std::size_t a = 0; a < balls.plane_count; ++a) {
    end_sum<Lanes>(planes[a], sums[a].factor, sums[a].count, sums[a].force, members.force + 4 * a);
    if constexpr (kViscous)
      end_sum<Lanes>(planes[a], sums[a].viscous_factor, sums[a].count, sums[a].viscous,
                     members.viscous + 4 * a);
    sums[a].count = 0;
  }
  Lanes::store_column(result.last.all, works.last.sums);
  Lanes::store_column(result.now.all, works.now.sums);
  if constexpr (kViscous) {
    Lanes::store_column(result.last.viscous, works.last_viscous.sums);
    Lanes::store_column(result.now.viscous, works.now_viscous.sums);
  }
  alignas(64) double lane[Lanes::kWidth];
  Lanes::store(lane, less_partners);
  for (const double least : lane)
    result.partners = -least > result.partners ? -least : result.partners;
}

template <class Lanes>
void step_planes(const LinearPair& pair, const PlaneRow* planes, const PlaneBalls& balls,
                 const ForceColumns& mats, const MemberValues& members, PlaneSum* sums,
                 PlaneWorks& works) noexcept {
  if (members.viscous == nullptr) {
    step_near_planes<Lanes, false>(pair, planes, balls, mats, members, sums, works);
  } else {
    step_near_planes<Lanes, true>(pair, planes, balls, mats, members, sums, works);
  }
}

}  // namespace cordis::engine
