// sim_node/engine/links/spring_damper.cpp
#include "sim_node/engine/links/spring_damper.h"

#include <algorithm>

#include "sim_node/engine/links/elongation_increment.h"

namespace cordis::engine {
namespace {

using Kind = SpringDamperArray::Kind;

bool is_of(Kind kind, const NetworkDescription& description, const Link& link) {
  return (description.dimension > 1 && link.isotropic) == (kind == Kind::kVectorSpring);
}

std::size_t axes_of(Kind kind, const NetworkDescription& description) {
  return kind == Kind::kVectorSpring ? static_cast<std::size_t>(description.dimension) : 1;
}

std::size_t row_count(Kind kind, const NetworkDescription& description) {
  const auto links =
      std::count_if(description.links.begin(), description.links.end(),
                    [&](const Link& link) { return is_of(kind, description, link); });
  return static_cast<std::size_t>(links) * axes_of(kind, description);
}

}  // namespace

// A row of padding joins a MAT to itself without stiffness or viscosity: its force is 0.
SpringDamperArray::SpringDamperArray(const NetworkDescription& description, Kind kind)
    : is_1d_(description.dimension == 1 || kind == Kind::kVectorSpring),
      column_a_(padded(row_count(kind, description), kLinkBatch), 0U),
      column_b_(column_a_.size(), 0U),
      stiffness_(column_a_.size(), 0.0),
      viscosity_over_dt_(column_a_.size(), 0.0),
      rest_length_(column_a_.size(), 0.0),
      viscous_factor_(column_a_.size(), 0.0),
      elastic_factor_(is_1d_ ? 0 : column_a_.size(), 0.0),
      active_(column_a_.size(), kLinkBatch) {
  std::size_t l = 0;
  for (const Link& link : description.links) {
    if (!is_of(kind, description, link)) continue;
    for (std::uint32_t axis = 0; axis < axes_of(kind, description); ++axis, ++l) {
      column_a_[l] = 4 * link.mat_a + axis;
      column_b_[l] = 4 * link.mat_b + axis;
      stiffness_[l] = link.stiffness;
      viscosity_over_dt_[l] = link.viscosity / description.step;
      rest_length_[l] = link.rest_length;
    }
    viscous_ = viscous_ || link.viscosity > 0.0;
  }
  for (; l < column_a_.size(); ++l) {
    column_a_[l] = column_b_[l] = column_of_padding(l, description.mats.size());
  }
}

LinkRows SpringDamperArray::rows(const ActiveLinks::Run& run) noexcept {
  const std::size_t first = run.first;
  return {run.count,
          column_a_.data() + first,
          column_b_.data() + first,
          stiffness_.data() + first,
          viscosity_over_dt_.data() + first,
          rest_length_.data() + first,
          viscous_factor_.data() + first,
          is_1d_ ? nullptr : elastic_factor_.data() + first};
}

StepEnergy SpringDamperArray::add(AddLinkForces add_link_forces,
                                  const ForceColumns& columns) noexcept {
  if (column_a_.empty()) return {};
  LinkWork work;
  for (const ActiveLinks::Run& run : active_.runs()) add_link_forces(rows(run), columns, work);
  return half_of(work);
}

StepEnergy SpringDamperArray::add_forces(const StepKernel& kernel,
                                         const ForceColumns& columns) noexcept {
  const AddLinkForces forces_1d = viscous_ ? kernel.spring_dampers_1d : kernel.springs_1d;
  const AddLinkForces forces_nd = viscous_ ? kernel.spring_dampers_3d : kernel.springs_3d;
  return add(is_1d_ ? forces_1d : forces_nd, columns);
}

StepEnergy SpringDamperArray::add_forces_at_full_step(const StepKernel& kernel,
                                                      const ForceColumns& columns) noexcept {
  const AddLinkForces forces_1d = viscous_ ? kernel.moment_spring_dampers_1d : kernel.springs_1d;
  const AddLinkForces forces_nd =
      viscous_ ? kernel.moment_spring_dampers_3d : kernel.moment_springs_3d;
  return {0.0, 2.0 * add(is_1d_ ? forces_1d : forces_nd, columns).dissipated, 0.0, 0.0};
}

void SpringDamperArray::mark_neighbours(const WakePropagation& pass,
                                        MatRoles& roles) const noexcept {
  for (std::size_t l = 0; l < column_a_.size(); ++l) {
    roles.join(column_a_[l] / 4, column_b_[l] / 4, pass);
  }
}

void SpringDamperArray::choose_active(MatRoles& roles) noexcept {
  active_.choose(column_a_.data(), column_b_.data(), roles);
}

StepEnergy SpringDamperArray::work_since_last_call(const MatArray& mats) const noexcept {
  StepEnergy work;
  if (is_1d_ && !viscous_) return work;
  for (std::size_t l = 0; l < column_a_.size(); ++l) {
    const double elongation_increment =
        half_elongation_increment(mats, column_a_[l], column_b_[l], is_1d_);
    work.dissipated += viscous_factor_[l] * elongation_increment;
    if (!is_1d_) work.elastic += elastic_factor_[l] * elongation_increment;
  }
  return work;
}

double SpringDamperArray::potential_energy(const MatArray& mats) const noexcept {
  double sum = 0.0;
  for (std::size_t l = 0; l < column_a_.size(); ++l) {
    const Vec3 along =
        mats.position_of_forces(column_b_[l] / 4) - mats.position_of_forces(column_a_[l] / 4);
    const double distance = is_1d_ ? along[column_a_[l] % 4] : along.norm();
    const double elongation = distance - rest_length_[l];
    sum += stiffness_[l] * elongation * elongation;
  }
  return 0.5 * sum;
}

void SpringDamperArray::start() noexcept {
  std::fill(viscous_factor_.begin(), viscous_factor_.end(), 0.0);
}

void SpringDamperArray::drop_viscosity() noexcept {
  std::fill(viscosity_over_dt_.begin(), viscosity_over_dt_.end(), 0.0);
  viscous_ = false;
}

void SpringDamperArray::serialize(Archive& archive) {
  archive.reals(viscous_factor_);
  archive.reals(elastic_factor_);
}

}  // namespace cordis::engine
