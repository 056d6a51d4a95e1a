// sim_node/engine/links/bends.cpp
#include "sim_node/engine/links/bends.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::engine {
namespace {

Vec3 column(const double* columns, std::uint32_t mat) noexcept {
  const double* x = columns + 4 * std::size_t{mat};
  return {x[0], x[1], x[2]};
}

void add(double* columns, std::uint32_t mat, const Vec3& force) noexcept {
  double* f = columns + 4 * std::size_t{mat};
  for (int axis = 0; axis < 3; ++axis) f[axis] += force[axis];
}

}  // namespace

BendArray::BendArray(const NetworkDescription& description)
    : is_1d_(description.dimension == 1), viscous_moment_(3 * description.bends.size(), 0.0) {
  rows_.reserve(description.bends.size());
  for (const Bend& bend : description.bends) {
    rows_.push_back({bend.mat_a, bend.mat_b, bend.mat_c, bend.stiffness,
                     bend.viscosity / description.step, BendShape(bend, description.dimension)});
  }
}

/// Across the bend there is none, for that would turn all three MATs about each other. A straight one has no
/// direction yet, and resists in all.
Vec3 BendArray::viscous_moment(const Row& row, const Vec3& bend, const Vec3& moved) const noexcept {
  const double square = dot(bend, bend);
  if (is_1d_ || !(square > 0.0)) return row.viscosity_over_dt * moved;
  return (row.viscosity_over_dt * (dot(bend, moved) / square)) * bend;
}

Vec3 BendArray::last_viscous_moment(std::size_t row) const noexcept {
  const double* moment = viscous_moment_.data() + 3 * row;
  return {moment[0], moment[1], moment[2]};
}

StepEnergy BendArray::add_forces(const ForceColumns& columns) noexcept {
  CORDIS_ASSERT(rows_.empty() || columns.axis_stride == 1);
  StepEnergy work;
  for (std::size_t l = 0; l < rows_.size(); ++l) {
    const Row& row = rows_[l];
    const auto bend_in = [&row](const double* from) {
      return row.shape(column(from, row.mat_a), column(from, row.mat_b), column(from, row.mat_c));
    };
    const Vec3 bend = bend_in(columns.position);
    const Vec3 before = bend_in(columns.delayed);
    const Vec3 moved = bend - before;
    work.elastic += 0.5 * row.stiffness * dot(bend + before, moved);
    Vec3 moment = row.stiffness * bend;
    if (row.viscosity_over_dt > 0.0) {
      const Vec3 viscous = viscous_moment(row, bend, moved);
      work.dissipated += 0.5 * dot(viscous + last_viscous_moment(l), moved);
      std::copy_n(viscous.data(), 3, viscous_moment_.data() + 3 * l);
      moment += viscous;
    }

    const Vec3 on_a = row.shape.force_on_a(moment);
    const Vec3 on_c = row.shape.force_on_c(moment);
    add(columns.force, row.mat_a, on_a);
    add(columns.force, row.mat_c, on_c);
    add(columns.force, row.mat_b, -(on_a + on_c));
  }
  return work;
}

StepEnergy BendArray::work_since_last_call(const MatArray& mats) const noexcept {
  CORDIS_ASSERT(rows_.empty() || !mats.layout().is_by_axis());
  StepEnergy work;
  for (std::size_t l = 0; l < rows_.size(); ++l) {
    const Row& row = rows_[l];
    const Vec3 before = row.shape(mats.delayed_at_rest(row.mat_a), mats.delayed_at_rest(row.mat_b),
                                  mats.delayed_at_rest(row.mat_c));
    const Vec3 moved =
        row.shape(mats.position(row.mat_a), mats.position(row.mat_b), mats.position(row.mat_c)) -
        before;
    work.elastic += 0.5 * row.stiffness * dot(before, moved);
    work.dissipated += 0.5 * dot(last_viscous_moment(l), moved);
  }
  return work;
}

double BendArray::potential_energy(const MatArray& mats) const noexcept {
  CORDIS_ASSERT(rows_.empty() || !mats.layout().is_by_axis());
  double sum = 0.0;
  for (const Row& row : rows_) {
    const Vec3 bend =
        row.shape(mats.position_of_forces(row.mat_a), mats.position_of_forces(row.mat_b),
                  mats.position_of_forces(row.mat_c));
    sum += row.stiffness * dot(bend, bend);
  }
  return 0.5 * sum;
}

void BendArray::forget_viscous_forces() noexcept {
  std::fill(viscous_moment_.begin(), viscous_moment_.end(), 0.0);
}

void BendArray::serialize(Archive& archive) {
  archive.reals(viscous_moment_);
}

}  // namespace cordis::engine
