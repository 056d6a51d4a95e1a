// sim_node/engine/pairs/plane_kernel_body.h -- the loop over balls near planes, written once over
// the vector registers of each width.
//
// `Lanes` is a type of SimdPairLanes.
#pragma once

#include "sim_node/engine/matter/step_kernel.h"
#include "sim_node/engine/pairs/pair_kernel_body.h"
#include "sim_node/engine/pairs/plane_kernel.h"

namespace cordis::engine {

/// Bits of the factors that are not 0: each counts for a partner.
template <class Lanes>
unsigned partners_of(typename Lanes::Row factor) noexcept {
  return Lanes::bits(Lanes::not_equal(factor, Lanes::zero()));
}

template <class Lanes>
std::size_t count_of(unsigned bits) noexcept {
  return static_cast<std::size_t>(__builtin_popcount(bits));
}

/// The forces of pairs with one plane on it.
template <class Lanes, bool kRubs>
typename Lanes::Row3 tension_of(const typename Lanes::Row3& normal, typename Lanes::Row factor,
                                const typename Lanes::Row3& friction) noexcept {
  const typename Lanes::Row3 along = scaled<Lanes>(normal, factor);
  if constexpr (!kRubs) return along;
  return plus<Lanes>(along, friction);
}

/// Adds whole batches of forces to the sums of a plane.
template <class Lanes, bool kRubs>
void add_forces(const PlaneRow& plane, std::size_t count, const ValuesOfPairs* friction,
                FactorSum& sum) noexcept {
  using Row3 = typename Lanes::Row3;
  const Row3 normal = every<Lanes>(plane.normal);
#pragma GCC unroll 4
  for (std::size_t place = 0; place < kPairBatch; place += Lanes::kWidth) {
    Row3 all{Lanes::load(sum.force[0] + place), Lanes::load(sum.force[1] + place),
             Lanes::load(sum.force[2] + place)};
    for (std::size_t i = place; i < count; i += kPairBatch) {
      Row3 across{};
      if constexpr (kRubs)
        across = {Lanes::load(friction[0] + i), Lanes::load(friction[1] + i),
                  Lanes::load(friction[2] + i)};
      const Row3 tension = tension_of<Lanes, kRubs>(normal, Lanes::load(sum.factor + i), across);
      all = plus<Lanes>(all, tension);
    }
    Lanes::store(sum.force[0] + place, all.x);
    Lanes::store(sum.force[1] + place, all.y);
    Lanes::store(sum.force[2] + place, all.z);
  }
}

/// Moves what is left beyond the room to the beginning.
template <class Lanes>
void move_to_begin(ValuesOfPairs& values) noexcept {
  for (std::size_t i = 0; i < kPairBatch; i += Lanes::kWidth)
    Lanes::store(values + i, Lanes::load(values + kPairsOfPlane + i));
}

/// Adds the first pairs.
template <class Lanes, bool kViscous, bool kRubs>
void add_full_batches(const PlaneRow& plane, PlaneSum& sum) noexcept {
  add_forces<Lanes, kRubs>(plane, kPairsOfPlane, sum.friction, sum.all);
  move_to_begin<Lanes>(sum.all.factor);
  if constexpr (kViscous) {
    add_forces<Lanes, kRubs>(plane, kPairsOfPlane, sum.friction, sum.viscous);
    move_to_begin<Lanes>(sum.viscous.factor);
  }
  if constexpr (kRubs) {
    for (ValuesOfPairs& axis : sum.friction) move_to_begin<Lanes>(axis);
  }
  sum.count -= kPairsOfPlane;
}

/// Writes a sum to a column, and empties it.
template <class Lanes>
void write_sum(FactorSum& sum, double* column) noexcept {
  RowSum<Lanes> all = no_force<Lanes>();
  for (std::size_t part = 0; part < RowSum<Lanes>::kParts; ++part) {
    const std::size_t place = part * Lanes::kWidth;
    all.x[part] = Lanes::load(sum.force[0] + place);
    all.y[part] = Lanes::load(sum.force[1] + place);
    all.z[part] = Lanes::load(sum.force[2] + place);
    for (double* axis : {sum.force[0], sum.force[1], sum.force[2]})
      Lanes::store(axis + place, Lanes::zero());
  }
  Lanes::store_column(column, Lanes::broadcast(0.0));
  give<Lanes>(all, column);
  column[3] = static_cast<double>(sum.partners);
  sum.partners = 0;
}

/// Adds all pairs, writes the sums to the columns of the plane, and empties them.
template <class Lanes, bool kViscous, bool kRubs>
void end_sums(const PlaneRow& plane, std::size_t a, const MemberValues& members,
              PlaneSum& sum) noexcept {
  const auto end = [&sum](ValuesOfPairs& values) noexcept {
    for (std::size_t i = 0; i < kPairBatch; i += Lanes::kWidth)
      Lanes::store_any(values + sum.count + i, Lanes::zero());
  };
  if constexpr (kRubs) {
    for (ValuesOfPairs& axis : sum.friction) end(axis);
  }
  end(sum.all.factor);
  add_forces<Lanes, kRubs>(plane, sum.count, sum.friction, sum.all);
  write_sum<Lanes>(sum.all, members.force + 4 * a);
  if constexpr (kViscous) {
    end(sum.viscous.factor);
    add_forces<Lanes, kRubs>(plane, sum.count, sum.friction, sum.viscous);
    write_sum<Lanes>(sum.viscous, members.viscous + 4 * a);
  }
  sum.count = 0;
}

/// A register of balls.
template <class Lanes>
struct SomeBalls {
  typename Lanes::Mask listed;
  typename Lanes::Row3 place;
  typename Lanes::Row3 way;  // 0 of those that are not listed
  const double* radius;      // null: the rest length is that of the plane
  unsigned masses;           // bits
};

/// Forces of the pairs of a register of balls with one plane, 0 out of range.
template <class Lanes>
struct PlaneForces {
  typename Lanes::Row factor = Lanes::zero();
  typename Lanes::Row viscous = Lanes::zero();  // the part of the factor that stores no energy
  typename Lanes::Row3 friction{Lanes::zero(), Lanes::zero(), Lanes::zero()};
  unsigned partners = 0;  // bits of the balls that the plane pushes or pulls
};

/// The friction of the pairs of a register of balls, from number m on, with a plane.
/// @param along  what the distance has grown by [m]
/// @return its forces, 0 where no pair pushes
template <class Lanes>
[[gnu::always_inline]] inline typename Lanes::Row3 rub_on_plane(
    const PlaneFriction& friction, const FrictionOfBatch<Lanes>& term, std::size_t a, std::size_t m,
    typename Lanes::Row factor, const typename Lanes::Row3& normal, typename Lanes::Row along,
    const typename Lanes::Row3& way, double* squares) noexcept {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;
  const std::size_t place = a * friction.stride + m;
  const Row push = Lanes::zero() - factor;
  const auto touches = Lanes::less(Lanes::zero(), push);
  if (Lanes::bits(touches) == 0U) {
    Lanes::store(friction.phase + place, Lanes::zero());
    return {Lanes::zero(), Lanes::zero(), Lanes::zero()};
  }
  const Row3 across{way.x - along * normal.x, way.y - along * normal.y, way.z - along * normal.z};
  const Rubbing<Lanes> rubbing =
      rub<Lanes>(term, push, normal, across, load_vectors<Lanes>(friction.stretch, place),
                 Lanes::load(friction.phase + place));
  const Row3 stretch = only<Lanes>(touches, rubbing.stretch);
  store_vectors<Lanes>(friction.stretch, place, stretch);
  Lanes::store(friction.phase + place, Lanes::select(touches, rubbing.phase, Lanes::zero()));
  Lanes::store(squares, Lanes::load(squares) + dot<Lanes>(stretch, stretch));
  return only<Lanes>(touches, rubbing.force);
}

/// Finds the pairs of a register of balls with one plane, and adds them to the sums of the plane.
template <class Lanes, bool kViscous, bool kRubs>
[[gnu::always_inline]] inline PlaneForces<Lanes> find_forces(
    const LinearPair& pair, const FrictionOfBatch<Lanes>& term, const PlaneRow& plane,
    std::size_t a, const PlaneBalls& all_balls, std::size_t m, const SomeBalls<Lanes>& balls,
    PlaneSum& sum) noexcept {
  using Row = typename Lanes::Row;
  const typename Lanes::Row3 normal = every<Lanes>(plane.normal);
  const typename Lanes::Row3 centre = every<Lanes>(plane.centre);
  const Row height = dot<Lanes>(
      normal, {balls.place.x - centre.x, balls.place.y - centre.y, balls.place.z - centre.z});
  const auto near = Lanes::both(balls.listed, Lanes::less(height, Lanes::every(all_balls.range)));
  const unsigned chosen = Lanes::bits(near);
  PlaneForces<Lanes> forces;
  if (chosen == 0U) {
    if constexpr (kRubs)
      Lanes::store(all_balls.friction.phase + a * all_balls.friction.stride + m, Lanes::zero());
    return forces;
  }
  Row rest_length = Lanes::every(plane.rest_length);
  if (balls.radius != nullptr) rest_length = rest_length + Lanes::load(balls.radius);
  const Row min_tension = Lanes::every(pair.min_tension);
  const Row max_tension = Lanes::every(pair.max_tension);
  const Row increment = dot<Lanes>(normal, balls.way) - Lanes::every(plane.moved);
  const Row elastic = Lanes::every(pair.stiffness) * (height - rest_length);
  const Row tension = elastic + Lanes::every(pair.viscosity_over_dt) * increment;
  const Row limited = Lanes::minimum(max_tension, Lanes::maximum(min_tension, tension));
  forces.factor = Lanes::select(near, limited, Lanes::zero());
  const std::size_t count = sum.count;
  Lanes::pack(sum.all.factor + count, forces.factor, chosen);
  forces.partners = partners_of<Lanes>(forces.factor);
  sum.all.partners += count_of<Lanes>(forces.partners);
  if constexpr (kViscous) {
    const Row stored = Lanes::minimum(max_tension, Lanes::maximum(min_tension, elastic));
    forces.viscous = Lanes::select(near, limited - stored, Lanes::zero());
    Lanes::pack(sum.viscous.factor + count, forces.viscous, chosen);
    sum.viscous.partners += count_of<Lanes>(partners_of<Lanes>(forces.viscous));
  }
  if constexpr (kRubs) {
    forces.friction = rub_on_plane<Lanes>(all_balls.friction, term, a, m, forces.factor, normal,
                                          increment, balls.way, sum.squares + m % kPairBatch);
    Lanes::pack(sum.friction[0] + count, forces.friction.x, chosen);
    Lanes::pack(sum.friction[1] + count, forces.friction.y, chosen);
    Lanes::pack(sum.friction[2] + count, forces.friction.z, chosen);
  }
  sum.count = count + count_of<Lanes>(chosen);
  if (sum.count >= kPairsOfPlane) add_full_batches<Lanes, kViscous, kRubs>(plane, sum);
  return forces;
}

/// Adds 8 works to the sums of their places.
template <class Lanes>
void add_batch(const double* work, typename Lanes::Column& sums) noexcept {
  sums = sums + Lanes::load_column(work);
  sums = sums + Lanes::load_column(work + 4);
}

/// What the forces of a batch have taken, and the sums of it: less the works.
template <class Lanes>
struct WorksOfBatches {
  alignas(64) double batch[kPairBatch];
  typename Lanes::Column sums = Lanes::broadcast(0.0);

  /// @param taken  the force is less this
  void enter(std::size_t place, const typename Lanes::Row3& taken,
             const typename Lanes::Row3& way) noexcept {
    Lanes::store(batch + place, dot<Lanes>(taken, way));
  }
  void write(double* works) noexcept { Lanes::store_column(works, Lanes::broadcast(0.0) - sums); }
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

/// Vectors of columns that follow one another, with the other sign.
template <class Lanes>
typename Lanes::Row3 less_neighbours(const double* columns) noexcept {
  const typename Lanes::Row3 v = Lanes::neighbours(columns);
  return {Lanes::zero() - v.x, Lanes::zero() - v.y, Lanes::zero() - v.z};
}

/// Enters what the last forces of a register of balls have done, from member m on, place i of its batch.
template <class Lanes, bool kViscous, bool kRubs>
[[gnu::always_inline]] inline void end_last_forces(const PlaneRow* planes, const PlaneBalls& balls,
                                                   const MemberValues& members, std::size_t m,
                                                   std::size_t i, const typename Lanes::Row3& way,
                                                   WorksOfStep<Lanes>& works) noexcept {
  using Row3 = typename Lanes::Row3;
  const std::size_t held = balls.held_plane[m / kPairBatch];
  if (held == kNoPlane) {
    works.last.enter(i, less_neighbours<Lanes>(members.force + 4 * m), way);
    if constexpr (kViscous)
      works.last_viscous.enter(i, less_neighbours<Lanes>(members.viscous + 4 * m), way);
    return;
  }
  const Row3 normal = every<Lanes>(planes[held].normal);
  Row3 friction{};
  if constexpr (kRubs) friction = load_vectors<Lanes>(balls.friction.force, m);
  const auto tension = [&](const double* factors) noexcept {
    return tension_of<Lanes, kRubs>(normal, Lanes::load(factors + m), friction);
  };
  works.last.enter(i, tension(balls.factor), way);
  if constexpr (kViscous) works.last_viscous.enter(i, tension(balls.viscous_factor), way);
}

/// Takes the places of the balls of a batch that are listed.
template <class Lanes>
[[gnu::always_inline]] inline void take_places(const PlaneBalls& balls, std::size_t batch,
                                               const double* position,
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

/// Finds the forces of a register of balls with one plane, and keeps them.
/// @return less the forces
template <class Lanes, bool kViscous, bool kRubs>
[[gnu::always_inline]] inline typename Lanes::Row3 step_with_one_plane(
    const LinearPair& pair, const FrictionOfBatch<Lanes>& term, const PlaneRow* planes,
    std::size_t a, const PlaneBalls& balls, std::size_t m, std::size_t i,
    const SomeBalls<Lanes>& some, PlaneSum* sums, WorksOfStep<Lanes>& works,
    std::uint32_t& largest_partners) noexcept {
  const PlaneForces<Lanes> forces =
      find_forces<Lanes, kViscous, kRubs>(pair, term, planes[a], a, balls, m, some, sums[a]);
  const typename Lanes::Row3 normal = every<Lanes>(planes[a].normal);
  Lanes::store(balls.factor + m, forces.factor);
  if constexpr (kRubs) store_vectors<Lanes>(balls.friction.force, m, forces.friction);
  if constexpr (kViscous) {
    Lanes::store(balls.viscous_factor + m, forces.viscous);
    works.now_viscous.enter(i, tension_of<Lanes, kRubs>(normal, forces.viscous, forces.friction),
                            some.way);
  }
  if (largest_partners == 0 && (forces.partners & some.masses) != 0U) largest_partners = 1;
  return tension_of<Lanes, kRubs>(normal, forces.factor, forces.friction);
}

/// Forces on a register of balls, and their partners.
template <class Lanes>
struct ForcesOnBalls {
  typename Lanes::Row3 force{Lanes::zero(), Lanes::zero(), Lanes::zero()};
  typename Lanes::Row partners = Lanes::zero();

  /// A factor that is 0 counts for no partner.
  void take_pairs(const typename Lanes::Row3& tension, typename Lanes::Row factor) noexcept {
    force.x = force.x - tension.x;
    force.y = force.y - tension.y;
    force.z = force.z - tension.z;
    partners = partners - less_one<Lanes>(Lanes::not_equal(factor, Lanes::zero()));
  }
  typename Lanes::Row3 less_force() const noexcept {
    return {Lanes::zero() - force.x, Lanes::zero() - force.y, Lanes::zero() - force.z};
  }
};

/// Likewise with several planes, whose forces are summed; keeps the sums.
template <class Lanes, bool kViscous, bool kRubs>
typename Lanes::Row3 step_with_planes(const LinearPair& pair, const FrictionOfBatch<Lanes>& term,
                                      const PlaneRow* planes, const PlaneBalls& balls,
                                      std::size_t m, std::size_t i, const SomeBalls<Lanes>& some,
                                      PlaneSum* sums, const MemberValues& members,
                                      WorksOfStep<Lanes>& works,
                                      std::uint32_t& largest_partners) noexcept {
  ForcesOnBalls<Lanes> on;
  ForcesOnBalls<Lanes> viscous_on;
  for (std::uint64_t left = balls.batches.surfaces[m / kPairBatch]; left != 0U; left &= left - 1U) {
    const auto a = static_cast<std::size_t>(__builtin_ctzll(left));
    const PlaneForces<Lanes> forces =
        find_forces<Lanes, kViscous, kRubs>(pair, term, planes[a], a, balls, m, some, sums[a]);
    const typename Lanes::Row3 normal = every<Lanes>(planes[a].normal);
    on.take_pairs(tension_of<Lanes, kRubs>(normal, forces.factor, forces.friction), forces.factor);
    if constexpr (kViscous)
      viscous_on.take_pairs(tension_of<Lanes, kRubs>(normal, forces.viscous, forces.friction),
                            forces.viscous);
  }
  Lanes::store_columns(members.force + 4 * m, on.force, on.partners);
  if constexpr (kViscous) {
    works.now_viscous.enter(i, viscous_on.less_force(), some.way);
    Lanes::store_columns(members.viscous + 4 * m, viscous_on.force, viscous_on.partners);
  }
  alignas(64) double partners[Lanes::kWidth];
  Lanes::store(partners, Lanes::select(Lanes::mask(some.masses), on.partners, Lanes::zero()));
  for (const double of_ball : partners) {
    const auto count = static_cast<std::uint32_t>(of_ball);
    largest_partners = count > largest_partners ? count : largest_partners;
  }
  return on.less_force();
}

template <class Lanes, bool kViscous, bool kRubs>
void step_near_planes(const LinearPair& law, const PlaneRow* planes, const PlaneBalls& all_balls,
                      const ForceColumns& mats, const MemberValues& all_members, PlaneSum* sums,
                      PlaneWorks& result) noexcept {
  using Row3 = typename Lanes::Row3;
  const LinearPair pair = law;
  const PlaneBalls balls = all_balls;
  const MemberValues members = all_members;
  const double* const position = mats.position;
  const double* const delayed = mats.delayed;
  double* const force = mats.force;
  const FrictionOfBatch<Lanes> term(balls.friction.term);
  WorksOfStep<Lanes> works;
  std::uint32_t partners = 0;

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
          balls.radius == nullptr ? nullptr : balls.radius + m,
          balls.masses[batch] >> i & first_lanes<Lanes>(Lanes::kWidth)};
      end_last_forces<Lanes, kViscous, kRubs>(planes, balls, members, m, i, some.way, works);
      // 0 of balls that are not listed, and no force on a MAT is -0
      const Row3 taken =
          is_one_plane
              ? step_with_one_plane<Lanes, kViscous, kRubs>(pair, term, planes, first_plane, balls,
                                                            m, i, some, sums, works, partners)
              : step_with_planes<Lanes, kViscous, kRubs>(pair, term, planes, balls, m, i, some,
                                                         sums, members, works, partners);
      works.now.enter(i, taken, some.way);
      if (is_run) {
        Lanes::subtract_from_neighbours(force + *column, taken);
      } else {
        Lanes::subtract(force, column, taken, Lanes::zero());
      }
    }
    works.template end_batch<kViscous>();
    balls.held_plane[batch] = is_one_plane ? static_cast<std::uint8_t>(first_plane) : kNoPlane;
    take_places<Lanes>(balls, batch, position, members.position);
  }

  for (std::size_t a = 0; a < balls.plane_count; ++a)
    end_sums<Lanes, kViscous, kRubs>(planes[a], a, members, sums[a]);
  works.last.write(result.last.all);
  works.now.write(result.now.all);
  if constexpr (kViscous) {
    works.last_viscous.write(result.last.viscous);
    works.now_viscous.write(result.now.viscous);
  }
  result.partners = partners;
}

template <class Lanes>
void step_planes(const LinearPair& pair, const PlaneRow* planes, const PlaneBalls& balls,
                 const ForceColumns& mats, const MemberValues& members, PlaneSum* sums,
                 PlaneWorks& works) noexcept {
  if (balls.friction.phase != nullptr) {  // its forces store no energy
    step_near_planes<Lanes, true, true>(pair, planes, balls, mats, members, sums, works);
  } else if (members.viscous != nullptr) {
    step_near_planes<Lanes, true, false>(pair, planes, balls, mats, members, sums, works);
  } else {
    step_near_planes<Lanes, false, false>(pair, planes, balls, mats, members, sums, works);
  }
}

}  // namespace cordis::engine
