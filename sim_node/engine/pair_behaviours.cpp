// sim_node/engine/pair_behaviours.cpp
#include "sim_node/engine/pair_behaviours.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cordis::engine {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t padded(std::size_t count) {
  return (count + kPairBatch - 1) / kPairBatch * kPairBatch;
}

}  // namespace

PairBehaviours::PairBehaviours(const NetworkDescription& description, const SetLiaison& set,
                               const StateTable& table, std::size_t capacity)
    : behaviour_(set.behaviour),
      dt_(description.step),
      row_count_(set.set_p.size()),
      row_size_(padded(set.set_p.size() + set.set_q.size()) + kPairBatch),
      capacity_(capacity),
      states_(0, 0, 0) {
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      const Mat& member = description.mats[mat];
      mat_.push_back(mat);
      mass_.push_back(member.kind == MatKind::kMass ? member.mass : 0.0);
    }
  }
  mass_.resize(row_size_, 0.0);
  state_.resize(row_size_, 0U);
  values_.resize(kArrayCount * row_size_, 0.0);
  merged_.resize(row_size_, 0U);
  adopt(table);
}

void PairBehaviours::adopt(const StateTable& table) {
  start_ = table.start_state(behaviour_);
  padding_ = table.padding_state();
  needs_velocity_ = false;
  for (const Quantity quantity :
       {Quantity::kSpeedX, Quantity::kSpeedY, Quantity::kSpeedZ, Quantity::kSlip}) {
    needs_velocity_ = needs_velocity_ || table.needs(quantity);
  }
  needs_mass_ = table.needs(Quantity::kMassA) || table.needs(Quantity::kMassB);
  needs_impulse_ = table.needs(Quantity::kImpulse);
  const bool was_stateless = stateless_;
  stateless_ = table.behaviours()[behaviour_].is_stateless();
  if (!stateless_ && was_stateless) {
    states_ = PairStates(row_count_, capacity_, table.slot_count());
  } else if (!stateless_ && states_.slot_count() != table.slot_count()) {
    states_.change_slots(table.slot_count());
  }
  memory_.assign(row_size_ * table.slot_count(), kNoValue);
}

void PairBehaviours::begin_step(const PairStep& step) noexcept {
  switching_ = 0.0;
  forgotten_ = 0;
  if (!stateless_ && !step.frozen) states_.begin_step();
}

std::size_t PairBehaviours::step_row(const PairKernel& kernel, const PairStep& step,
                                     const MemberColumns& members, std::size_t a, std::size_t count,
                                     double range_square, const PairRest& rest,
                                     const PairRow& row) noexcept {
  const bool remembers = !stateless_ && !step.frozen;
  if (remembers) count = add_bound(kernel, members, a, count, row);
  if (count > 0) {
    recall(a, count, rest, step, row);
    kernel.measure_row(members, a, count, row);
    find_quantities(members, a, count, step, row);
    for (std::size_t i = 0; i < count; i += kPairBatch) step_batch(step, a, i, row);
  }
  if (remembers) remember(a, count, range_square, row);

  double* pull = array(kPull);
  double* elastic = array(kElastic);
  for (std::size_t i = 0; i < padded(count); ++i) {
    const bool out_of_reach = state_[i] == start_ && !(row.square[i] < range_square);
    const double inverse = out_of_reach ? 0.0 : row.inverse[i];
    elastic[i] = (pull[i] - elastic[i]) * inverse;
    pull[i] = pull[i] * inverse;
  }
  return count;
}

/// Puts the bound pairs of the last step that are out of range among those in range.
std::size_t PairBehaviours::add_bound(const PairKernel& kernel, const MemberColumns& members,
                                      std::size_t a, std::size_t count,
                                      const PairRow& row) noexcept {
  std::size_t merged = 0;
  std::size_t next = 0;
  for (std::size_t old = states_.old_begin(a); old < states_.old_end(a); ++old) {
    const PairState& pair = states_.old_state(old);
    if (pair.state == start_) continue;
    while (next < count && row.column[next] < pair.column) merged_[merged++] = row.column[next++];
    if (next < count && row.column[next] == pair.column) continue;
    merged_[merged++] = pair.column;
  }
  if (merged + count - next == count) return count;
  while (next < count) merged_[merged++] = row.column[next++];
  return kernel.gather_row(members, a, merged_.data(), merged, kInfinity, row);
}

/// Of each pair of the row what it remembers, or what a new one begins with.
void PairBehaviours::recall(std::size_t a, std::size_t count, const PairRest& rest,
                            const PairStep& step, const PairRow& row) noexcept {
  const bool remembers = !stateless_ && !step.frozen;
  const std::size_t slots = states_.slot_count();
  std::size_t old = remembers ? states_.old_begin(a) : 0;
  const std::size_t old_end = remembers ? states_.old_end(a) : 0;
  for (std::size_t i = 0; i < padded(count); ++i) {
    double* memory = memory_.data() + i / kPairBatch * slots * kPairBatch + i % kPairBatch;
    while (i < count && old < old_end && states_.old_state(old).column < row.column[i]) ++old;
    if (i < count && old < old_end && states_.old_state(old).column == row.column[i]) {
      const PairState& pair = states_.old_state(old);
      state_[i] = pair.state;
      array(kRest)[i] = pair.rest_length;
      array(kPull)[i] = pair.pull;
      array(kImpulse)[i] = pair.impulse;
      array(kEntered)[i] = pair.entered;
      for (std::size_t s = 0; s < slots; ++s) {
        memory[s * kPairBatch] = states_.old_memory(old, s);
      }
      continue;
    }
    state_[i] = i < count ? start_ : padding_;
    array(kRest)[i] = i < count ? rest.of(a, row.column[i] / 4) : 0.0;
    array(kPull)[i] = 0.0;
    array(kImpulse)[i] = 0.0;
    array(kEntered)[i] = static_cast<double>(step.step);
    for (std::size_t s = 0; s < slots; ++s) memory[s * kPairBatch] = kNoValue;
  }
}

void PairBehaviours::find_quantities(const MemberColumns& members, std::size_t a, std::size_t count,
                                     const PairStep& step, const PairRow& row) noexcept {
  const double rate = 1.0 / dt_;
  const double* moved_a = members.moved + 4 * a;
  for (std::size_t i = 0; i < padded(count); ++i) {
    array(kElongation)[i] = row.length[i] - array(kRest)[i];
    array(kSpeed)[i] = row.growth[i] * rate;
    array(kAge)[i] = (static_cast<double>(step.step) - array(kEntered)[i]) * dt_;
    if (needs_mass_) {
      array(kMassA)[i] = mass_[a];
      array(kMassB)[i] = mass_[row.column[i] / 4];
    }
    if (!needs_velocity_) continue;
    const double* moved_b = members.moved + row.column[i];
    const double velocity[3] = {(moved_b[0] - moved_a[0]) * rate, (moved_b[1] - moved_a[1]) * rate,
                                (moved_b[2] - moved_a[2]) * rate};
    const double along[3] = {row.x[i], row.y[i], row.z[i]};
    double slip_square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      array(static_cast<Array>(kSpeedX + axis))[i] = velocity[axis];
      const double across = velocity[axis] - array(kSpeed)[i] * (along[axis] * row.inverse[i]);
      slip_square += across * across;
    }
    array(kSlip)[i] = std::sqrt(slip_square);
  }
}

void PairBehaviours::step_batch(const PairStep& step, std::size_t a, std::size_t i,
                                const PairRow& row) noexcept {
  alignas(64) double elastic_before[kBehaviourBatch] = {};
  BehaviourRows rows{};
  const auto set = [&rows](Quantity quantity, const double* values) {
    rows.quantity[static_cast<std::size_t>(quantity)] = values;
  };
  rows.growth = row.growth + i;
  rows.dt = dt_;
  rows.rate = 1.0 / dt_;
  rows.now = static_cast<double>(step.step);
  rows.frozen = step.frozen;
  for (std::uint32_t j = 0; j < kBehaviourBatch; ++j) {
    rows.still |= static_cast<std::uint32_t>(row.square[i + j] == 0.0) << j;
  }
  rows.state = state_.data() + i;
  rows.rest_length = array(kRest) + i;
  rows.elongation = array(kElongation) + i;
  rows.pull = array(kPull) + i;
  rows.impulse = needs_impulse_ ? array(kImpulse) + i : nullptr;
  rows.entered = array(kEntered) + i;
  rows.memory = memory_.data() + i * states_.slot_count();
  rows.memory_slots = states_.slot_count();
  rows.elastic = array(kElastic) + i;
  rows.elastic_before = elastic_before;
  set(Quantity::kDistance, row.length + i);
  set(Quantity::kElongation, rows.elongation);
  set(Quantity::kSpeed, array(kSpeed) + i);
  set(Quantity::kSpeedX, array(kSpeedX) + i);
  set(Quantity::kSpeedY, array(kSpeedY) + i);
  set(Quantity::kSpeedZ, array(kSpeedZ) + i);
  set(Quantity::kSlip, array(kSlip) + i);
  set(Quantity::kForce, rows.pull);
  set(Quantity::kImpulse, rows.impulse);
  set(Quantity::kAge, array(kAge) + i);
  set(Quantity::kRestLength, rows.rest_length);
  set(Quantity::kMassA, array(kMassA) + i);
  set(Quantity::kMassB, array(kMassB) + i);
  step.behaviours.step(step.table.terms(), rows);
  if (rows.changed != 0) note_changes(step, a, i, row, rows);
}

void PairBehaviours::note_changes(const PairStep& step, std::size_t a, std::size_t i,
                                  const PairRow& row, const BehaviourRows& rows) noexcept {
  const StateIndex first = step.table.first_state(behaviour_);
  for (std::size_t j = 0; j < kBehaviourBatch; ++j) {
    if ((rows.changed >> j & 1U) == 0) continue;
    const double energy = step.table.change_energy(rows, j);
    switching_ += energy;
    step.log.add({step.step, kNoLink, mat_[a], mat_[row.column[i + j] / 4], behaviour_,
                  rows.from[j] - first, rows.state[j] - first,
                  step.table.fired(rows.from[j], rows.exit[j]), rows.fired_value[j], energy});
  }
}

void PairBehaviours::remember(std::size_t a, std::size_t count, double range_square,
                              const PairRow& row) noexcept {
  const std::size_t slots = states_.slot_count();
  for (std::size_t i = 0; i < count; ++i) {
    if (state_[i] == start_ && !(row.square[i] < range_square)) continue;
    const double* memory = memory_.data() + i / kPairBatch * slots * kPairBatch + i % kPairBatch;
    const bool kept = states_.add({row.column[i], state_[i], array(kRest)[i], array(kPull)[i],
                                   array(kImpulse)[i], array(kEntered)[i]},
                                  memory, kPairBatch);
    if (!kept) ++forgotten_;
  }
  states_.end_row(a);
}

}  // namespace cordis::engine
