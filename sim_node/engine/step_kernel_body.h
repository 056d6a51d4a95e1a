// sim_node/engine/step_kernel_body.h -- the loops of a step, written once over the vector registers
// of each width.
//
// `Lanes` is a type of an unnamed namespace, one for each width, and gives
//   Batch      8 values with + - *;  load, store, zero, sqrt, sum (in the order of the lanes)
//   Batch3     8 vectors x, y, z
//   Column     the 4 values of one MAT with + - *;  load, store, broadcast, is_finite
//   inverse_or_zero(square, length)    1 / length where square > 0, else 0
//   difference(columns, a, b)          the 8 vectors from a to b, one below the other
//   difference_1d(columns, a, b)       their first component
//   add_pairs(force, a, b, pull)       one by one: += at a, -= at b
// so every function here belongs to the file that instantiates it, and is never shared between
// widths. Each + - * is rounded by itself: no operation may be contracted or reordered.
#pragma once

#include "sim_node/engine/step_kernel.h"

namespace cordis::engine {

/// pull = K (b - a - rest) + Z (growth of b - a) / dt, signed; kViscous = false leaves the second
/// term out.
template <class Lanes, bool kViscous>
double add_link_forces_1d(const LinkRows& links, const ForceColumns& columns) noexcept {
  using Batch = typename Lanes::Batch;
  Batch work = Lanes::zero();

  for (std::size_t l = 0; l < links.count; l += kLinkBatch) {
    const std::uint32_t* a = links.column_a + l;
    const std::uint32_t* b = links.column_b + l;

    const Batch distance = Lanes::difference_1d(columns.position, a, b);
    Batch pull = Lanes::load(links.stiffness + l) * (distance - Lanes::load(links.rest_length + l));
    if constexpr (kViscous) {
      const Batch grown = distance - Lanes::difference_1d(columns.delayed, a, b);
      const Batch viscous_pull = Lanes::load(links.viscosity_over_dt + l) * grown;
      work = work + (viscous_pull + Lanes::load(links.viscous_factor + l)) * grown;
      Lanes::store(links.viscous_factor + l, viscous_pull);
      pull = pull + viscous_pull;
    }
    Lanes::add_pairs_1d(columns.force, a, b, pull);
  }
  return Lanes::sum(work);
}

/// pull = K (d - rest) + Z (growth of the link along its axis) / dt; none while d is 0, for lack of
/// a direction.
template <class Lanes, bool kViscous>
double add_link_forces_3d(const LinkRows& links, const ForceColumns& columns) noexcept {
  using Batch = typename Lanes::Batch;
  using Batch3 = typename Lanes::Batch3;
  Batch work = Lanes::zero();

  for (std::size_t l = 0; l < links.count; l += kLinkBatch) {
    const std::uint32_t* a = links.column_a + l;
    const std::uint32_t* b = links.column_b + l;

    const Batch3 along = Lanes::difference(columns.position, a, b);
    const Batch square = along.x * along.x + along.y * along.y + along.z * along.z;
    const Batch length = Lanes::sqrt(square);
    const Batch inverse = Lanes::inverse_or_zero(square, length);
    Batch factor =
        Lanes::load(links.stiffness + l) * (length - Lanes::load(links.rest_length + l)) * inverse;
    if constexpr (kViscous) {
      const Batch3 before = Lanes::difference(columns.delayed, a, b);
      const Batch moved_x = along.x - before.x;
      const Batch moved_y = along.y - before.y;
      const Batch moved_z = along.z - before.z;
      const Batch grown = (along.x * moved_x + along.y * moved_y + along.z * moved_z) * inverse;
      const Batch viscous_pull = Lanes::load(links.viscosity_over_dt + l) * grown;
      const Batch before_moved = before.x * moved_x + before.y * moved_y + before.z * moved_z;
      work = work + (viscous_pull * grown + Lanes::load(links.viscous_factor + l) * before_moved);
      const Batch viscous_factor = viscous_pull * inverse;
      Lanes::store(links.viscous_factor + l, viscous_factor);
      factor = factor + viscous_factor;
    }
    Lanes::add_pairs(columns.force, a, b,
                     Batch3{along.x * factor, along.y * factor, along.z * factor});
  }
  return Lanes::sum(work);
}

template <class Lanes, bool kMedium>
AdvanceResult advance_masses(const MassColumns& masses) noexcept {
  using Column = typename Lanes::Column;
  const Column weight_step = Lanes::load_column(masses.weight_step);
  Column product = Lanes::broadcast(0.0);
  Column blemish = Lanes::broadcast(0.0);

  for (std::size_t i = masses.first; i < masses.last; ++i) {
    const Column position = Lanes::load_column(masses.position + 4 * i);
    const Column moved = position - Lanes::load_column(masses.delayed + 4 * i);
    const Column pushed =
        Lanes::load_column(masses.force + 4 * i) * Lanes::broadcast(masses.dt2_over_mass[i]) +
        weight_step;
    Column moving = moved + pushed;
    if constexpr (kMedium) moving = moved * Lanes::broadcast(masses.persistence[i]) + pushed;
    const Column next = position + moving;
    if constexpr (kMedium) product = product + moved * (moved + (next - position));

    Lanes::store_column(masses.delayed + 4 * i, position);
    Lanes::store_column(masses.position + 4 * i, next);
    blemish = Lanes::unite(blemish, next - next);  // 0 for finite values, else NaN
  }
  return AdvanceResult{Lanes::sum_column(product), Lanes::is_zero(blemish)};
}

template <class Lanes>
constexpr StepKernel make_step_kernel() noexcept {
  return StepKernel{add_link_forces_1d<Lanes, false>, add_link_forces_1d<Lanes, true>,
                    add_link_forces_3d<Lanes, false>, add_link_forces_3d<Lanes, true>,
                    advance_masses<Lanes, false>,     advance_masses<Lanes, true>};
}

}  // namespace cordis::engine
