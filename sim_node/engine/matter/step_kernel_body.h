// sim_node/engine/matter/step_kernel_body.h -- the loops of a step, written once over the vector
// registers of each width.
//
// `Lanes` is a type of SimdLanes.
#pragma once

#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// Works of some links, by their place in the batch.
template <class Lanes>
struct WorkRows {
  typename Lanes::Row elastic;
  typename Lanes::Row dissipated;
};

/// The account takes half of the work of the last forces and half of that of these, or the
/// viscous work of these alone; see LinkWork and StepKernel.
enum class Works { kHalfStep, kFullStep };

/// tension = K (b - a - rest) + Z (elongation increment of b - a) / dt, signed; kViscous = false
/// leaves the second term out.
template <class Lanes, bool kViscous, Works kWorks>
struct Links1d {
  using Row = typename Lanes::Row;

  static void add_forces(const LinkRows& links, const ForceColumns& columns, std::size_t l,
                         WorkRows<Lanes>& work) noexcept {
    const std::uint32_t* a = links.column_a + l;
    const std::uint32_t* b = links.column_b + l;

    const Row distance = Lanes::difference_1d(columns.position, a, b);
    Row tension =
        Lanes::load(links.stiffness + l) * (distance - Lanes::load(links.rest_length + l));
    if constexpr (kViscous) {
      const Row elongation_increment = distance - Lanes::difference_1d(columns.delayed, a, b);
      const Row viscous_tension = Lanes::load(links.viscosity_over_dt + l) * elongation_increment;
      if constexpr (kWorks == Works::kHalfStep) {
        work.dissipated =
            work.dissipated +
            (viscous_tension + Lanes::load(links.viscous_factor + l)) * elongation_increment;
        Lanes::store(links.viscous_factor + l, viscous_tension);
      } else {
        work.dissipated = work.dissipated + viscous_tension * elongation_increment;
      }
      tension = tension + viscous_tension;
    }
    Lanes::add_pairs_1d(columns.force, a, b, tension);
  }
};

/// tension = K (d - rest) + Z (elongation increment of the link along its axis) / dt; none while d is
/// 0, for lack of a direction.
template <class Lanes, bool kViscous, Works kWorks>
struct LinksNd {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;

  static void add_forces(const LinkRows& links, const ForceColumns& columns, std::size_t l,
                         WorkRows<Lanes>& work) noexcept {
    const std::uint32_t* a = links.column_a + l;
    const std::uint32_t* b = links.column_b + l;

    constexpr bool kMoves = kViscous || kWorks == Works::kHalfStep;
    Row3 along;
    Row3 before;
    if constexpr (kMoves) {
      Lanes::differences(columns.position, columns.delayed, a, b, along, before);
    } else {
      along = before = Lanes::difference(columns.position, a, b);
    }
    const Row square = along.x * along.x + along.y * along.y + along.z * along.z;
    const Row length = Lanes::sqrt(square);
    const Row inverse = Lanes::inverse_or_zero(square, length);
    const Row3 moved{along.x - before.x, along.y - before.y, along.z - before.z};
    const Row along_moved = along.x * moved.x + along.y * moved.y + along.z * moved.z;

    const Row elastic_factor =
        Lanes::load(links.stiffness + l) * (length - Lanes::load(links.rest_length + l)) * inverse;
    Row before_moved = Lanes::zero();
    if constexpr (kWorks == Works::kHalfStep) {
      before_moved = before.x * moved.x + before.y * moved.y + before.z * moved.z;
      work.elastic = work.elastic + (elastic_factor * along_moved +
                                     Lanes::load(links.elastic_factor + l) * before_moved);
      Lanes::store(links.elastic_factor + l, elastic_factor);
    }
    Row factor = elastic_factor;
    if constexpr (kViscous) {
      const Row elongation_increment = along_moved * inverse;
      const Row viscous_tension = Lanes::load(links.viscosity_over_dt + l) * elongation_increment;
      const Row viscous_factor = viscous_tension * inverse;
      if constexpr (kWorks == Works::kHalfStep) {
        work.dissipated = work.dissipated + (viscous_tension * elongation_increment +
                                             Lanes::load(links.viscous_factor + l) * before_moved);
        Lanes::store(links.viscous_factor + l, viscous_factor);
      } else {
        work.dissipated = work.dissipated + viscous_tension * elongation_increment;
      }
      factor = factor + viscous_factor;
    }
    Lanes::add_pairs(columns.force, a, b,
                     Row3{along.x * factor, along.y * factor, along.z * factor});
  }
};

/// A batch of 8 links at a time, in one register or in parts; the works are summed by the place in
/// the batch.
template <class Lanes, class Links>
void add_link_forces(const LinkRows& links, const ForceColumns& columns, LinkWork& sum) noexcept {
  constexpr std::size_t kParts = kLinkBatch / Lanes::kWidth;
  WorkRows<Lanes> work[kParts];
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t lane = part * Lanes::kWidth;
    work[part] = {Lanes::load(sum.elastic + lane), Lanes::load(sum.dissipated + lane)};
  }

  for (std::size_t l = 0; l < links.count; l += kLinkBatch) {
#pragma GCC unroll 4
    for (std::size_t part = 0; part < kParts; ++part) {
      Links::add_forces(links, columns, l + part * Lanes::kWidth, work[part]);
    }
  }

  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t lane = part * Lanes::kWidth;
    Lanes::store(sum.elastic + lane, work[part].elastic);
    Lanes::store(sum.dissipated + lane, work[part].dissipated);
  }
}

template <class Lanes, bool kMedium>
AdvanceResult advance_masses(const MassColumns& masses) noexcept {
  using Column = typename Lanes::Column;
  const Column weight_step = Lanes::load_column(masses.weight_step);
  Column product = Lanes::broadcast(0.0);
  Column nonfinite = Lanes::broadcast(0.0);

  for (std::size_t i = masses.first; i < masses.last; ++i) {
    const Column position = Lanes::load_column(masses.position + 4 * i);
    const Column moved = Lanes::load_column(masses.moved + 4 * i);
    const Column pushed =
        Lanes::load_column(masses.force + 4 * i) * Lanes::broadcast(masses.dt2_over_mass[i]) +
        weight_step;
    Column moving = moved + pushed;
    if constexpr (kMedium) moving = moved * Lanes::broadcast(masses.velocity_retention[i]) + pushed;
    const Column next = position + moving;
    if constexpr (kMedium) product = product + moved * (moved + moving);

    Lanes::store_column(masses.delayed + 4 * i, next);
    Lanes::store_column(masses.moved + 4 * i, moving);
    // 0 for finite values, else NaN
    nonfinite = Lanes::unite(nonfinite, next - next);  // NOLINT(misc-redundant-expression)
  }
  return AdvanceResult{Lanes::sum_column(product), Lanes::is_zero(nonfinite)};
}

template <class Lanes, bool kMedium>
AdvanceResult extrapolate_masses(const MassColumns& masses) noexcept {
  using Column = typename Lanes::Column;
  const Column weight_step = Lanes::load_column(masses.weight_step);
  const Column one = Lanes::broadcast(1.0);
  const Column half = Lanes::broadcast(0.5);
  Column product = Lanes::broadcast(0.0);
  Column nonfinite = Lanes::broadcast(0.0);

  for (std::size_t i = masses.first; i < masses.last; ++i) {
    const Column position = Lanes::load_column(masses.position + 4 * i);
    const Column moved = position - Lanes::load_column(masses.delayed + 4 * i);
    Column pushed =
        Lanes::load_column(masses.force + 4 * i) * Lanes::broadcast(masses.dt2_over_mass[i]) +
        weight_step;
    if constexpr (kMedium) {
      const Column seen = position - Lanes::load_column(masses.extrapolated + 4 * i);
      pushed = pushed - seen * (one - Lanes::broadcast(masses.velocity_retention[i]));
      product = product + seen * seen;
    }
    const Column moving = moved + pushed;
    const Column next = position + moving;

    Lanes::store_column(masses.delayed + 4 * i, position);
    Lanes::store_column(masses.position + 4 * i, next);
    Lanes::store_column(masses.extrapolated + 4 * i, position - half * pushed);
    // 0 for finite values, else NaN
    nonfinite = Lanes::unite(nonfinite, next - next);  // NOLINT(misc-redundant-expression)
  }
  return AdvanceResult{Lanes::sum_column(product), Lanes::is_zero(nonfinite)};
}

template <class Lanes, bool kDrifts>
void kick_masses(const MassColumns& masses, const KickColumns& by) noexcept {
  using Column = typename Lanes::Column;
  const Column weight_step = Lanes::load_column(masses.weight_step);
  const Column kick = Lanes::broadcast(by.kick_over_dt);
  const Column drift = Lanes::broadcast(by.drift);
  const Column none = Lanes::broadcast(0.0);

  for (std::size_t i = masses.first; i < masses.last; ++i) {
    const Column pushed =
        Lanes::broadcast(masses.dt2_over_mass[i]) * Lanes::load_column(masses.force + 4 * i) +
        weight_step;
    const Column velocity = Lanes::load_column(by.velocity + 4 * i) + kick * pushed;
    Lanes::store_column(by.velocity + 4 * i, velocity);
    if constexpr (kDrifts) {
      const Column position = Lanes::load_column(masses.position + 4 * i);
      Lanes::store_column(masses.position + 4 * i, position + drift * velocity);
      Lanes::store_column(by.force + 4 * i, none);
    }
  }
}

template <class Lanes>
AdvanceResult delay_masses(const MassColumns& masses, const double* velocity, double dt) noexcept {
  using Column = typename Lanes::Column;
  const Column period = Lanes::broadcast(dt);
  Column nonfinite = Lanes::broadcast(0.0);

  for (std::size_t i = masses.first; i < masses.last; ++i) {
    const Column position = Lanes::load_column(masses.position + 4 * i);
    const Column delayed = position - period * Lanes::load_column(velocity + 4 * i);
    Lanes::store_column(masses.delayed + 4 * i, delayed);
    // 0 for finite values, else NaN
    nonfinite = Lanes::unite(nonfinite, position - position);  // NOLINT(misc-redundant-expression)
  }
  return AdvanceResult{0.0, Lanes::is_zero(nonfinite)};
}

template <class Lanes>
constexpr StepKernel make_step_kernel() noexcept {
  constexpr Works kHalf = Works::kHalfStep;
  constexpr Works kFull = Works::kFullStep;
  return StepKernel{add_link_forces<Lanes, Links1d<Lanes, false, kHalf>>,
                    add_link_forces<Lanes, Links1d<Lanes, true, kHalf>>,
                    add_link_forces<Lanes, LinksNd<Lanes, false, kHalf>>,
                    add_link_forces<Lanes, LinksNd<Lanes, true, kHalf>>,
                    add_link_forces<Lanes, Links1d<Lanes, true, kFull>>,
                    add_link_forces<Lanes, LinksNd<Lanes, false, kFull>>,
                    add_link_forces<Lanes, LinksNd<Lanes, true, kFull>>,
                    advance_masses<Lanes, false>,
                    advance_masses<Lanes, true>,
                    extrapolate_masses<Lanes, false>,
                    extrapolate_masses<Lanes, true>,
                    kick_masses<Lanes, false>,
                    kick_masses<Lanes, true>,
                    delay_masses<Lanes>};
}

}  // namespace cordis::engine
