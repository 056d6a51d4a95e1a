// sim_node/engine/links/maxwell_links.cpp
#include "sim_node/engine/links/maxwell_links.h"

#include <algorithm>

#include "sim_node/engine/links/elongation_increment.h"

namespace cordis::engine {
double share_of_decay(double x) noexcept {
  if (x > 64.0) return 1.0;
  // the series for a small part of x, then 1 - (1 - s)^2 = s (2 - s) for its double
  int doublings = 0;
  for (; x > 0.125; x *= 0.5) ++doublings;
  double share = 0.0;
  for (int k = 12; k >= 1; --k) share = x / k * (1.0 - share);
  for (; doublings > 0; --doublings) share = share * (2.0 - share);
  return share;
}

MaxwellArray::MaxwellArray(const NetworkDescription& description)
    : is_1d_(description.dimension == 1),
      link_count_(description.maxwell_links.size()),
      column_a_(padded(link_count_, kStateBatch), 0U),
      column_b_(column_a_.size(), 0U),
      velocity_retention_(column_a_.size(), 0.0),
      gain_(column_a_.size(), 0.0),
      compliance_(column_a_.size(), 0.0),
      tension_(column_a_.size(), 0.0),
      factor_(column_a_.size(), 0.0) {
  for (std::size_t l = 0; l < link_count_; ++l) {
    const MaxwellLink& link = description.maxwell_links[l];
    const double share = share_of_decay(link.stiffness * description.step / link.viscosity);
    column_a_[l] = 4 * link.mat_a;
    column_b_[l] = 4 * link.mat_b;
    velocity_retention_[l] = 1.0 - share;
    gain_[l] = link.viscosity / description.step * share;
    compliance_[l] = 1.0 / link.stiffness;
    tension_[l] = link.start_force;
  }
  for (std::size_t l = link_count_; l < column_a_.size(); ++l) {
    column_a_[l] = column_b_[l] = column_of_padding(l, description.mats.size());
  }
}

StepEnergy MaxwellArray::add_forces(const StateKernel& kernel,
                                    const ForceColumns& columns) noexcept {
  if (link_count_ == 0) return {};
  const MaxwellRows rows{
      column_a_.size(), column_a_.data(),   column_b_.data(), velocity_retention_.data(),
      gain_.data(),     compliance_.data(), tension_.data(),  factor_.data()};
  LinkWork work;
  (is_1d_ ? kernel.maxwell_1d : kernel.maxwell_3d)(rows, columns, work);
  return half_of(work);
}

StepEnergy MaxwellArray::add_undecayed(const StateKernel& kernel, const ForceColumns& columns,
                                       bool grows) noexcept {
  alignas(64) static constexpr double kHeld[kStateBatch] = {1, 1, 1, 1, 1, 1, 1, 1};
  alignas(64) static constexpr double kNoGain[kStateBatch] = {};
  LinkWork work;
  for (std::size_t l = 0; l < column_a_.size(); l += kStateBatch) {
    const MaxwellRows rows{kStateBatch,
                           column_a_.data() + l,
                           column_b_.data() + l,
                           kHeld,
                           grows ? gain_.data() + l : kNoGain,
                           compliance_.data() + l,
                           tension_.data() + l,
                           factor_.data() + l};
    (is_1d_ ? kernel.maxwell_1d : kernel.maxwell_3d)(rows, columns, work);
  }
  return half_of(work);
}

StepEnergy MaxwellArray::add_held_forces(const StateKernel& kernel,
                                         const ForceColumns& columns) noexcept {
  return add_undecayed(kernel, columns, /*grows=*/false);
}

StepEnergy MaxwellArray::add_first_forces(const StateKernel& kernel,
                                          const ForceColumns& columns) noexcept {
  return add_undecayed(kernel, columns, /*grows=*/true);
}

void MaxwellArray::go_back(const MatArray& mats) noexcept {
  for (std::size_t l = 0; l < link_count_; ++l) {
    const std::uint32_t a = column_a_[l] / 4;
    const std::uint32_t b = column_b_[l] / 4;
    const Vec3 along = mats.position(b) - mats.position(a);
    const Vec3 moved =
        along - (mats.delayed_at_rest(b) - mats.delayed_at_rest(a));  // ports have none to undo
    const Vec3 before = along - moved;
    const double length = is_1d_ ? 1.0 : along.norm() + before.norm();
    const double product = is_1d_ ? moved.x() : (along + before).dot(moved);
    if (length > 0.0) tension_[l] -= gain_[l] * (product / length);
  }
}

void MaxwellArray::mark_neighbours(const WakePropagation& pass, MatRoles& roles) const noexcept {
  for (std::size_t l = 0; l < link_count_; ++l) {
    roles.join(column_a_[l] / 4, column_b_[l] / 4, pass);
    for (const std::uint32_t mat : {column_a_[l] / 4, column_b_[l] / 4}) {
      roles.add(mat, roles.has(mat, kIsMass) ? kWholeForce | kSomeForce : kSomeForce);
    }
  }
}

StepEnergy MaxwellArray::work_since_last_call(const MatArray& mats) const noexcept {
  StepEnergy work;
  for (std::size_t l = 0; l < link_count_; ++l) {
    work.elastic +=
        factor_[l] * half_elongation_increment(mats, column_a_[l], column_b_[l], is_1d_);
  }
  return work;
}

double MaxwellArray::stored_energy() const noexcept {
  double sum = 0.0;
  for (std::size_t l = 0; l < link_count_; ++l) sum += tension_[l] * tension_[l] * compliance_[l];
  return 0.5 * sum;
}

void MaxwellArray::serialize(Archive& archive) {
  archive.reals(tension_);
  archive.reals(factor_);
  archive.hash_rows(link_count_, tension_);
}

}  // namespace cordis::engine
