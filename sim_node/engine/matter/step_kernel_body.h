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
template <class Lanes, int kAxes, bool kViscous, Works kWorks>
struct TensionNd {
  using Row = typename Lanes::Row;
  struct Parameters {
    Row stiffness;
    Row viscosity_over_dt;
    Row rest_length;
  };
  /// As of LinkRows.
  struct Factors {
    double* viscous;
    double* elastic;
  };

  static Row product(const Row* u, const Row* v) noexcept {
    Row sum = u[0] * v[0];
#pragma GCC unroll 3
    for (int axis = 1; axis < kAxes; ++axis) sum = sum + u[axis] * v[axis];
    return sum;
  }

  /// @return tension / d, from the vector from a to b now and a period before
  static Row over_length(const Parameters& parameters, const Row* along, const Row* before,
                         const Factors& factors, WorkRows<Lanes>& work) noexcept {
    const Row square = product(along, along);
    const Row length = Lanes::sqrt(square);
    const Row inverse = Lanes::inverse_or_zero(square, length);
    Row moved[kAxes];
#pragma GCC unroll 3
    for (int axis = 0; axis < kAxes; ++axis) moved[axis] = along[axis] - before[axis];
    const Row along_moved = product(along, moved);

    const Row elastic_factor = parameters.stiffness * (length - parameters.rest_length) * inverse;
    Row before_moved = Lanes::zero();
    if constexpr (kWorks == Works::kHalfStep) {
      before_moved = product(before, moved);
      work.elastic = work.elastic +
                     (elastic_factor * along_moved + Lanes::load(factors.elastic) * before_moved);
      Lanes::store(factors.elastic, elastic_factor);
    }
    Row factor = elastic_factor;
    if constexpr (kViscous) {
      const Row elongation_increment = along_moved * inverse;
      const Row viscous_tension = parameters.viscosity_over_dt * elongation_increment;
      const Row viscous_factor = viscous_tension * inverse;
      if constexpr (kWorks == Works::kHalfStep) {
        work.dissipated = work.dissipated + (viscous_tension * elongation_increment +
                                             Lanes::load(factors.viscous) * before_moved);
        Lanes::store(factors.viscous, viscous_factor);
      } else {
        work.dissipated = work.dissipated + viscous_tension * elongation_increment;
      }
      factor = factor + viscous_factor;
    }
    return factor;
  }
};

/// Ends of gathered links; the arrays are stored by MAT.
template <class Lanes>
struct EndsByMat {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;

  static void find(const ForceColumns& columns, const std::uint32_t* a, const std::uint32_t* b,
                   Row* along, Row* before) noexcept {
    Row3 now;
    Row3 then;
    Lanes::differences(columns.position, columns.delayed, a, b, now, then);
    along[0] = now.x, along[1] = now.y, along[2] = now.z;
    before[0] = then.x, before[1] = then.y, before[2] = then.z;
  }
  static void find(const ForceColumns& columns, const std::uint32_t* a, const std::uint32_t* b,
                   Row* along) noexcept {
    const Row3 now = Lanes::difference(columns.position, a, b);
    along[0] = now.x, along[1] = now.y, along[2] = now.z;
  }
  static void add(const ForceColumns& columns, const std::uint32_t* a, const std::uint32_t* b,
                  const Row* along, Row factor) noexcept {
    Lanes::add_pairs(columns.force, a, b,
                     Row3{along[0] * factor, along[1] * factor, along[2] * factor});
  }
};

/// Ends of gathered links; the arrays are stored by axis.
template <class Lanes>
struct EndsByAxis {
  using Row = typename Lanes::Row;

  static void find(const ForceColumns& rows, const std::uint32_t* a, const std::uint32_t* b,
                   Row* along, Row* before) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
      along[axis] = Lanes::difference_1d(rows.position + axis * rows.axis_stride, a, b);
      before[axis] = Lanes::difference_1d(rows.delayed + axis * rows.axis_stride, a, b);
    }
  }
  static void find(const ForceColumns& rows, const std::uint32_t* a, const std::uint32_t* b,
                   Row* along) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
      along[axis] = Lanes::difference_1d(rows.position + axis * rows.axis_stride, a, b);
    }
  }
  static void add(const ForceColumns& rows, const std::uint32_t* a, const std::uint32_t* b,
                  const Row* along, Row factor) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
      Lanes::add_pairs_1d(rows.force + axis * rows.axis_stride, a, b, along[axis] * factor);
    }
  }
};

template <class Lanes, bool kViscous, Works kWorks, class Ends = EndsByMat<Lanes>>
struct LinksNd {
  using Row = typename Lanes::Row;
  using Tension = TensionNd<Lanes, 3, kViscous, kWorks>;

  static void add_forces(const LinkRows& links, const ForceColumns& columns, std::size_t l,
                         WorkRows<Lanes>& work) noexcept {
    const std::uint32_t* a = links.column_a + l;
    const std::uint32_t* b = links.column_b + l;

    Row along[3];
    Row before[3];
    if constexpr (kViscous || kWorks == Works::kHalfStep) {
      Ends::find(columns, a, b, along, before);
    } else {
      Ends::find(columns, a, b, along);
      for (int axis = 0; axis < 3; ++axis) before[axis] = along[axis];
    }
    const typename Tension::Parameters parameters{Lanes::load(links.stiffness + l),
                                                  Lanes::load(links.viscosity_over_dt + l),
                                                  Lanes::load(links.rest_length + l)};
    const Row factor = Tension::over_length(
        parameters, along, before, {links.viscous_factor + l, links.elastic_factor + l}, work);
    Ends::add(columns, a, b, along, factor);
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
    const Column kick =
        Lanes::load_column(masses.force + 4 * i) * Lanes::broadcast(masses.dt2_over_mass[i]) +
        weight_step;
    Column moving = moved + kick;
    if constexpr (kMedium) moving = moved * Lanes::broadcast(masses.velocity_retention[i]) + kick;
    const Column next = position + moving;
    if constexpr (kMedium) product = product + moved * (moved + moving);

    Lanes::store_column(masses.delayed + 4 * i, next);
    Lanes::store_column(masses.moved + 4 * i, moving);
    // 0 for finite values, else NaN
    nonfinite = Lanes::unite(nonfinite, next - next);  // NOLINT(misc-redundant-expression)
  }
  return AdvanceResult{Lanes::sum_column(product), Lanes::is_zero(nonfinite)};
}

/// What moves the masses of one axis gathers over them.
template <class Lanes>
struct AxisSums {
  static constexpr std::size_t kParts = kLinkBatch / Lanes::kWidth;

  typename Lanes::Row product[kParts];  // by the place in the batch
  typename Lanes::Row nonfinite;        // 0 for finite values, else NaN
};

/// The masses of one axis move as Advance says.
template <class Lanes, bool kMedium>
struct AxisAdvance {
  using Row = typename Lanes::Row;

  const double* position;
  double* delayed;
  double* moved;
  const double* force;
  double weight_step;

  static AxisAdvance of_axis(const MassColumns& masses, std::size_t axis) noexcept {
    const std::size_t row = axis * masses.axis_stride;
    return {masses.position + row, masses.delayed + row, masses.moved + row, masses.force + row,
            masses.weight_step[axis]};
  }
  void step(const MassColumns& masses, std::size_t i, std::size_t part,
            AxisSums<Lanes>& sums) noexcept {
    const Row before = Lanes::load_any(moved + i);
    const Row kick = Lanes::load_any(force + i) * Lanes::load_any(masses.dt2_over_mass + i) +
                     Lanes::every(weight_step);
    Row moving = before + kick;
    if constexpr (kMedium) {
      moving = before * Lanes::load_any(masses.velocity_retention + i) + kick;
      sums.product[part] = sums.product[part] + before * (before + moving);
    }
    const Row next = Lanes::load_any(position + i) + moving;
    Lanes::store_any(delayed + i, next);
    Lanes::store_any(moved + i, moving);
    sums.nonfinite = sums.nonfinite + (next - next);  // NOLINT(misc-redundant-expression)
  }
  /// @param in_place  sums by the place in the batch @return 0, or NaN if it is not finite
  double step_one(const MassColumns& masses, std::size_t i, double& in_place) noexcept {
    const double before = moved[i];
    const double kick = force[i] * masses.dt2_over_mass[i] + weight_step;
    double moving = before + kick;
    if constexpr (kMedium) {
      moving = before * masses.velocity_retention[i] + kick;
      in_place = in_place + before * (before + moving);
    }
    const double next = position[i] + moving;
    delayed[i] = next;
    moved[i] = moving;
    return next - next;  // NOLINT(misc-redundant-expression)
  }
};

/// The masses of one axis move as StepKernel says of those that extrapolate.
template <class Lanes, bool kMedium>
struct AxisExtrapolation {
  using Row = typename Lanes::Row;

  double* position;
  double* delayed;
  double* extrapolated;
  double* carried;
  const double* force;
  double weight_step;

  static AxisExtrapolation of_axis(const MassColumns& masses, std::size_t axis) noexcept {
    const std::size_t row = axis * masses.axis_stride;
    return {masses.position + row, masses.delayed + row, masses.extrapolated + row,
            masses.moved + row,    masses.force + row,   masses.weight_step[axis]};
  }
  void step(const MassColumns& masses, std::size_t i, std::size_t part,
            AxisSums<Lanes>& sums) noexcept {
    const Row now = Lanes::load_any(position + i);
    Row kick = Lanes::load_any(force + i) * Lanes::load_any(masses.dt2_over_mass + i) +
               Lanes::every(weight_step);
    if constexpr (kMedium) {
      const Row seen = now - Lanes::load_any(extrapolated + i);
      const Row retention = Lanes::load_any(masses.velocity_retention + i);
      kick = kick - seen * (Lanes::every(1.0) - retention);
      sums.product[part] = sums.product[part] + seen * seen;
    }
    const Row moving = Lanes::load_any(carried + i) + kick;
    const Row next = now + moving;
    Lanes::store_any(carried + i, moving);
    Lanes::store_any(delayed + i, now);
    Lanes::store_any(position + i, next);
    Lanes::store_any(extrapolated + i, now - Lanes::every(0.5) * kick);
    sums.nonfinite = sums.nonfinite + (next - next);  // NOLINT(misc-redundant-expression)
  }
  /// @param in_place  sums by the place in the batch @return 0, or NaN if it is not finite
  double step_one(const MassColumns& masses, std::size_t i, double& in_place) noexcept {
    const double now = position[i];
    double kick = force[i] * masses.dt2_over_mass[i] + weight_step;
    if constexpr (kMedium) {
      const double seen = now - extrapolated[i];
      kick = kick - seen * (1.0 - masses.velocity_retention[i]);
      in_place = in_place + seen * seen;
    }
    carried[i] += kick;
    const double next = now + carried[i];
    delayed[i] = now;
    position[i] = next;
    extrapolated[i] = now - 0.5 * kick;
    return next - next;  // NOLINT(misc-redundant-expression)
  }
};

/// Axis by axis; 8 masses at a time, then those that are left.
template <class Lanes, class Axis>
AdvanceResult move_masses_by_axis(const MassColumns& masses) noexcept {
  constexpr std::size_t kParts = AxisSums<Lanes>::kParts;
  AdvanceResult result;
  for (std::size_t axis = 0; axis < masses.axis_count; ++axis) {
    Axis moves = Axis::of_axis(masses, axis);
    AxisSums<Lanes> sums;
    sums.nonfinite = Lanes::zero();
    for (std::size_t part = 0; part < kParts; ++part) sums.product[part] = Lanes::zero();
    std::size_t i = masses.first;
    for (; i + kLinkBatch <= masses.last; i += kLinkBatch) {
#pragma GCC unroll 4
      for (std::size_t part = 0; part < kParts; ++part) {
        moves.step(masses, i + part * Lanes::kWidth, part, sums);
      }
    }

    alignas(64) double product[kLinkBatch];
    alignas(64) double nonfinite[Lanes::kWidth];
    for (std::size_t part = 0; part < kParts; ++part) {
      Lanes::store(product + part * Lanes::kWidth, sums.product[part]);
    }
    Lanes::store(nonfinite, sums.nonfinite);
    double all_nonfinite = 0.0;
    for (std::size_t place = 0; i < masses.last; ++i, ++place) {
      all_nonfinite += moves.step_one(masses, i, product[place]);
    }
    for (const double value : nonfinite) all_nonfinite += value;
    for (const double value : product) result.moved_product += value;
    result.all_finite = result.all_finite && all_nonfinite == 0.0;
  }
  return result;
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
    Column kick =
        Lanes::load_column(masses.force + 4 * i) * Lanes::broadcast(masses.dt2_over_mass[i]) +
        weight_step;
    if constexpr (kMedium) {
      const Column seen = position - Lanes::load_column(masses.extrapolated + 4 * i);
      kick = kick - seen * (one - Lanes::broadcast(masses.velocity_retention[i]));
      product = product + seen * seen;
    }
    const Column moving = Lanes::load_column(masses.moved + 4 * i) + kick;
    const Column next = position + moving;

    Lanes::store_column(masses.moved + 4 * i, moving);
    Lanes::store_column(masses.delayed + 4 * i, position);
    Lanes::store_column(masses.position + 4 * i, next);
    Lanes::store_column(masses.extrapolated + 4 * i, position - half * kick);
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
    const Column displacement =
        Lanes::broadcast(masses.dt2_over_mass[i]) * Lanes::load_column(masses.force + 4 * i) +
        weight_step;
    const Column velocity = Lanes::load_column(by.velocity + 4 * i) + kick * displacement;
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

/// Links of a run; the MATs are stored by axis. Of those that share a MAT the one before in link
/// order adds its force first: a is below b, so the forces on b of a batch precede those on a. In a
/// chain, b = a + 1, each MAT is read and written once: the force of the link before comes from a
/// register.
template <class Lanes, int kAxes, Works kWorks, bool kViscous, bool kChained>
struct RunLoop {
  using Row = typename Lanes::Row;
  using Tension = TensionNd<Lanes, kAxes, kViscous, kWorks>;
  static constexpr std::size_t kParts = kLinkBatch / Lanes::kWidth;
  static constexpr std::uint32_t kAllRows = (1U << kLinkBatch) - 1U;

  const RunRows& run;
  const ForceColumns& rows;
  WorkRows<Lanes> work[kParts];
  Row carried[kAxes];  // the last lane: force of the last link, not yet subtracted at its end b

  static Row tension_1d(const typename Tension::Parameters& parameters, Row along, Row before,
                        const typename Tension::Factors& factors, WorkRows<Lanes>& work) noexcept {
    Row tension = parameters.stiffness * (along - parameters.rest_length);
    if constexpr (kViscous) {
      const Row elongation_increment = along - before;
      const Row viscous_tension = parameters.viscosity_over_dt * elongation_increment;
      if constexpr (kWorks == Works::kHalfStep) {
        work.dissipated = work.dissipated +
                          (viscous_tension + Lanes::load(factors.viscous)) * elongation_increment;
        Lanes::store(factors.viscous, viscous_tension);
      } else {
        work.dissipated = work.dissipated + viscous_tension * elongation_increment;
      }
      tension = tension + viscous_tension;
    }
    return tension;
  }

  /// The rows of a batch from l on; only those of `used` are links.
  template <bool kAllUsed>
  void find_forces(std::size_t l, std::size_t part, std::uint32_t used, Row* force) noexcept {
    const std::size_t i = l + part * Lanes::kWidth;
    const std::size_t a = run.first_a + i;
    const std::size_t b = run.first_b + i;
    const std::size_t p = l / kLinkBatch * run.parameter_step + part * Lanes::kWidth;
    const typename Lanes::Mask links = Lanes::mask(used >> (part * Lanes::kWidth));
    Row along[kAxes];
    Row before[kAxes];
#pragma GCC unroll 3
    for (int axis = 0; axis < kAxes; ++axis) {
      const double* position = rows.position + axis * rows.axis_stride;
      const double* delayed = rows.delayed + axis * rows.axis_stride;
      along[axis] = Lanes::load_any(position + b) - Lanes::load_any(position + a);
      before[axis] = Lanes::load_any(delayed + b) - Lanes::load_any(delayed + a);
      if constexpr (kAllUsed) continue;
      along[axis] = Lanes::select(links, along[axis], Lanes::zero());
      before[axis] = Lanes::select(links, before[axis], Lanes::zero());
    }
    const typename Tension::Parameters parameters{Lanes::load(run.stiffness + p),
                                                  Lanes::load(run.viscosity_over_dt + p),
                                                  Lanes::load(run.rest_length + p)};
    const typename Tension::Factors factors{run.viscous_factor + i,
                                            kAxes == 1 ? nullptr : run.elastic_factor + i};
    if constexpr (kAxes == 1) {
      force[0] = tension_1d(parameters, along[0], before[0], factors, work[part]);
      if constexpr (!kAllUsed) force[0] = Lanes::select(links, force[0], Lanes::zero());
    } else {
      const Row factor = Tension::over_length(parameters, along, before, factors, work[part]);
#pragma GCC unroll 3
      for (int axis = 0; axis < kAxes; ++axis) force[axis] = along[axis] * factor;
    }
  }

  void add(std::size_t first, const Row* force) noexcept {
#pragma GCC unroll 3
    for (int axis = 0; axis < kAxes; ++axis) {
      double* sum = rows.force + axis * rows.axis_stride + first;
      Lanes::store_any(sum, Lanes::load_any(sum) + force[axis]);
    }
  }
  void subtract(std::size_t first, const Row* force) noexcept {
#pragma GCC unroll 3
    for (int axis = 0; axis < kAxes; ++axis) {
      double* sum = rows.force + axis * rows.axis_stride + first;
      Lanes::store_any(sum, Lanes::load_any(sum) - force[axis]);
    }
  }
  void add_chained(std::size_t first, const Row* force) noexcept {
#pragma GCC unroll 3
    for (int axis = 0; axis < kAxes; ++axis) {
      double* sum = rows.force + axis * rows.axis_stride + first;
      const Row of_link_before = Lanes::shifted(carried[axis], force[axis]);
      carried[axis] = force[axis];
      Lanes::store_any(sum, Lanes::load_any(sum) - of_link_before + force[axis]);
    }
  }

  template <bool kAllUsed>
  void step(std::size_t l, std::uint32_t used) noexcept {
    Row force[kParts][kAxes];
#pragma GCC unroll 4
    for (std::size_t part = 0; part < kParts; ++part) {
      find_forces<kAllUsed>(l, part, used, force[part]);
      if constexpr (kChained) {
        add_chained(run.first_a + l + part * Lanes::kWidth, force[part]);
      } else {
        subtract(run.first_b + l + part * Lanes::kWidth, force[part]);
        add(run.first_a + l + part * Lanes::kWidth, force[part]);
      }
    }
  }

  void subtract_carried() noexcept {
    for (int axis = 0; axis < kAxes; ++axis) {
      alignas(64) double lane[Lanes::kWidth];
      Lanes::store(lane, carried[axis]);
      rows.force[axis * rows.axis_stride + run.first_a + run.count] -= lane[Lanes::kWidth - 1];
    }
  }

  static void add_forces(const RunRows& run, const ForceColumns& rows, LinkWork& sum) noexcept {
    RunLoop loop{run, rows, {}, {}};
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t place = part * Lanes::kWidth;
      loop.work[part] = {Lanes::load(sum.elastic + place), Lanes::load(sum.dissipated + place)};
    }
    for (int axis = 0; axis < kAxes; ++axis) loop.carried[axis] = Lanes::zero();
    for (std::size_t l = 0; l < run.count; l += kLinkBatch) {
      const std::uint32_t used = run.used_rows[l / kLinkBatch];
      if (used == kAllRows) {
        loop.template step<true>(l, used);
      } else {
        loop.template step<false>(l, used);
      }
    }
    if constexpr (kChained) loop.subtract_carried();
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t place = part * Lanes::kWidth;
      Lanes::store(sum.elastic + place, loop.work[part].elastic);
      Lanes::store(sum.dissipated + place, loop.work[part].dissipated);
    }
  }
};

template <class Lanes, int kAxes, Works kWorks>
constexpr RunLoops make_run_loops() noexcept {
  return {RunLoop<Lanes, kAxes, kWorks, false, false>::add_forces,
          RunLoop<Lanes, kAxes, kWorks, true, false>::add_forces,
          RunLoop<Lanes, kAxes, kWorks, false, true>::add_forces,
          RunLoop<Lanes, kAxes, kWorks, true, true>::add_forces};
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
                    add_link_forces<Lanes, LinksNd<Lanes, false, kHalf, EndsByAxis<Lanes>>>,
                    add_link_forces<Lanes, LinksNd<Lanes, true, kHalf, EndsByAxis<Lanes>>>,
                    add_link_forces<Lanes, LinksNd<Lanes, false, kFull, EndsByAxis<Lanes>>>,
                    add_link_forces<Lanes, LinksNd<Lanes, true, kFull, EndsByAxis<Lanes>>>,
                    {make_run_loops<Lanes, 1, kHalf>(), make_run_loops<Lanes, 2, kHalf>(),
                     make_run_loops<Lanes, 3, kHalf>()},
                    {make_run_loops<Lanes, 1, kFull>(), make_run_loops<Lanes, 2, kFull>(),
                     make_run_loops<Lanes, 3, kFull>()},
                    advance_masses<Lanes, false>,
                    advance_masses<Lanes, true>,
                    move_masses_by_axis<Lanes, AxisAdvance<Lanes, false>>,
                    move_masses_by_axis<Lanes, AxisAdvance<Lanes, true>>,
                    extrapolate_masses<Lanes, false>,
                    extrapolate_masses<Lanes, true>,
                    move_masses_by_axis<Lanes, AxisExtrapolation<Lanes, false>>,
                    move_masses_by_axis<Lanes, AxisExtrapolation<Lanes, true>>,
                    kick_masses<Lanes, false>,
                    kick_masses<Lanes, true>,
                    delay_masses<Lanes>};
}

}  // namespace cordis::engine
