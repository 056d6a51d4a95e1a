// sim_node/engine/links/maxwell_links.cpp
#include "sim_node/engine/links/maxwell_links.h"

#include <algorithm>
#include <cmath>

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

MaxwellArray::MaxwellArray(const NetworkDescription& description, const StateTable& table,
                           const MatBlocks& blocks)
    : is_1d_(description.dimension == 1),
      dt_(description.step),
      rows_(description.maxwell_links, blocks, kStateBatch, column_a_, column_b_),
      groups_(blocks),
      velocity_retention_(rows_.count(), 0.0),
      gain_(rows_.count(), 0.0),
      compliance_(rows_.count(), 0.0),
      tension_(rows_.count(), 0.0),
      factor_(rows_.count(), 0.0) {
  for (std::size_t l = 0; l < description.maxwell_links.size(); ++l) {
    const MaxwellLink& link = description.maxwell_links[l];
    const std::uint32_t r = rows_.row_of_link[l];
    tension_[r] = link.start_force;
    if (link.follows_variables()) {
      following_.push_back({r, link.state_machine});
      continue;
    }
    const double share = share_of_decay(link.stiffness * description.step / link.viscosity);
    velocity_retention_[r] = 1.0 - share;
    gain_[r] = link.viscosity / description.step * share;
    compliance_[r] = 1.0 / link.stiffness;
  }
  take_parameters(table);
}

double MaxwellArray::stiffness_in(const Following& element, const StateTable& table) noexcept {
  constexpr double kSoftest = 1e-100;  // so that the spring keeps its elongation [N/m]
  const double stiffness = table.stiffness(table.start_state(element.state_machine));
  return stiffness > kSoftest ? stiffness : kSoftest;
}

double MaxwellArray::rate_in(const Following& element, const StateTable& table) noexcept {
  constexpr double kFastest = 1e100;  // [1/s]
  const double viscosity = table.viscosity(table.start_state(element.state_machine));
  if (!(viscosity > 0.0)) return kFastest;
  return std::min(stiffness_in(element, table) / viscosity, kFastest);
}

void MaxwellArray::put(std::uint32_t row, double stiffness, double rate) noexcept {
  const double decay = rate * dt_;
  const double share = share_of_decay(decay);
  velocity_retention_[row] = 1.0 - share;
  gain_[row] = decay > 0.0 ? stiffness / decay * share : stiffness;
  compliance_[row] = 1.0 / stiffness;
}

void MaxwellArray::take_parameters(const StateTable& table) noexcept {
  for (Following& element : following_) {
    element.stiffness = stiffness_in(element, table);
    element.rate = rate_in(element, table);
    put(element.row, element.stiffness, element.rate);
  }
}

/// A start force needs a stiffness: without one the element has no force.
void MaxwellArray::begin() noexcept {
  constexpr double kLongest = 1e50;  // elongation of a spring [m]
  for (const Following& element : following_) {
    double& tension = tension_[element.row];
    if (std::abs(tension) > kLongest * element.stiffness) tension = 0.0;
  }
}

/// As the kernel has it.
double MaxwellArray::elongation_increment(std::uint32_t row,
                                          const ForceColumns& columns) const noexcept {
  const auto between = [&](const double* places) {
    return Vec3(Vec3::Map(places + column_b_[row]) - Vec3::Map(places + column_a_[row]));
  };
  const Vec3 along = between(columns.position);
  const Vec3 before = between(columns.delayed);
  if (is_1d_) return along.x() - before.x();
  const double lengths = along.norm() + before.norm();
  return lengths > 0.0 ? dot(along + before, along - before) / lengths : 0.0;
}

/// The spring keeps its elongation. It takes the whole way of the ends during the step: an error of the order of
/// the others of a step.
double MaxwellArray::follow(const StateTable& table, const ForceColumns& columns) noexcept {
  double energy = 0.0;
  for (Following& element : following_) {
    const std::uint32_t r = element.row;
    const double stiffness = stiffness_in(element, table);
    const double rate = rate_in(element, table);
    const double before = tension_[r];
    const double stored = 0.5 * before * before * compliance_[r];
    const double share = stiffness / element.stiffness;
    tension_[r] = share * before;
    energy +=
        (share - 1.0) * stored + 0.5 * (tension_[r] - before) * elongation_increment(r, columns);
    put(r, stiffness, 0.5 * (element.rate + rate));
    element.stiffness = stiffness;
    element.rate = rate;
  }
  return energy;
}

MaxwellRows MaxwellArray::rows(std::size_t first, std::size_t count) noexcept {
  return {count,
          column_a_.data() + first,
          column_b_.data() + first,
          velocity_retention_.data() + first,
          gain_.data() + first,
          compliance_.data() + first,
          tension_.data() + first,
          factor_.data() + first};
}

StepEnergy MaxwellArray::add_forces(const StateKernel& kernel, const ForceColumns& columns,
                                    ThreadTeam& team) noexcept {
  if (rows_.count() == 0) return {};
  const AddMaxwellForces add = is_1d_ ? kernel.maxwell_1d : kernel.maxwell_3d;
  return half_of(groups_.add(team, [&](std::size_t group, LinkWork& work) noexcept {
    if (rows_.count(group) == 0) return;
    add(rows(rows_.first[group], rows_.count(group)), columns, work);
  }));
}

StepEnergy MaxwellArray::add_undecayed(const StateKernel& kernel, const ForceColumns& columns,
                                       bool grows) noexcept {
  alignas(64) static constexpr double kHeld[kStateBatch] = {1, 1, 1, 1, 1, 1, 1, 1};
  alignas(64) static constexpr double kNoGain[kStateBatch] = {};
  LinkWork work;
  for (std::size_t l = 0; l < column_a_.size(); l += kStateBatch) {
    MaxwellRows undecayed = rows(l, kStateBatch);
    undecayed.velocity_retention = kHeld;
    if (!grows) undecayed.gain = kNoGain;
    (is_1d_ ? kernel.maxwell_1d : kernel.maxwell_3d)(undecayed, columns, work);
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
  for (const std::uint32_t l : rows_.row_of_link) {
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
  for (const std::uint32_t l : rows_.row_of_link) {
    roles.join(column_a_[l] / 4, column_b_[l] / 4, pass);
    for (const std::uint32_t mat : {column_a_[l] / 4, column_b_[l] / 4}) {
      roles.add(mat, roles.has(mat, kIsMass) ? kWholeForce | kSomeForce : kSomeForce);
    }
  }
}

StepEnergy MaxwellArray::work_since_last_call(const MatArray& mats) const noexcept {
  StepEnergy work;
  for (const std::uint32_t l : rows_.row_of_link) {
    work.elastic +=
        factor_[l] * half_elongation_increment(mats, column_a_[l], column_b_[l], is_1d_);
  }
  return work;
}

double MaxwellArray::stored_energy() const noexcept {
  double sum = 0.0;
  for (const std::uint32_t l : rows_.row_of_link) sum += tension_[l] * tension_[l] * compliance_[l];
  return 0.5 * sum;
}

void MaxwellArray::serialize(Archive& archive) {
  archive.reals(tension_);
  archive.reals(factor_);
  archive.hash_rows_at(rows_.row_of_link, tension_);
}

}  // namespace cordis::engine
