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
      pull_(column_a_.size(), 0.0),
      factor_(column_a_.size(), 0.0) {
  for (std::size_t l = 0; l < link_count_; ++l) {
    const MaxwellLink& link = description.maxwell_links[l];
    const double share = share_of_decay(link.stiffness * description.step / link.viscosity);
    column_a_[l] = 4 * link.mat_a;
    column_b_[l] = 4 * link.mat_b;
    velocity_retention_[l] = 1.0 - share;
    gain_[l] = link.viscosity / description.step * share;
    compliance_[l] = 1.0 / link.stiffness;
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
      gain_.data(),     compliance_.data(), pull_.data(),     factor_.data()};
  LinkWork work;
  (is_1d_ ? kernel.maxwell_1d : kernel.maxwell_3d)(rows, columns, work);
  return half_of(work);
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
  for (std::size_t l = 0; l < link_count_; ++l) sum += pull_[l] * pull_[l] * compliance_[l];
  return 0.5 * sum;
}

void MaxwellArray::serialize(Archive& archive) {
  archive.reals(pull_);
  archive.reals(factor_);
  archive.hash_rows(link_count_, pull_);
}

}  // namespace cordis::engine
