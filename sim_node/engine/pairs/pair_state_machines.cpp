// sim_node/engine/pairs/pair_state_machines.cpp
#include "sim_node/engine/pairs/pair_state_machines.h"

#include <algorithm>
#include <cmath>

namespace cordis::engine {

PairStateMachines::PairStateMachines(const NetworkDescription& description, const SetLiaison& set,
                                     const StateTable& table, std::size_t capacity,
                                     std::size_t block_capacity)
    : state_machine_(set.state_machine),
      dt_(description.step),
      row_count_(set.set_p.size()),
      block_capacity_(block_capacity),
      capacity_(capacity),
      states_(0, 0, 0) {
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      const Mat& member = description.mats[mat];
      mat_.push_back(mat);
      mass_.push_back(member.kind == MatKind::kMass ? member.mass : 0.0);
    }
  }
  mass_.resize(padded(mat_.size(), kPairBatch) + kPairBatch, 0.0);
  state_.resize(block_capacity_, 0U);
  values_.resize(kArrayCount * block_capacity_, 0.0);
  merged_.resize(mass_.size(), 0U);
  adopt(table);
}

void PairStateMachines::adopt(const StateTable& table) {
  start_ = table.start_state(state_machine_);
  padding_ = table.padding_state();
  needs_velocity_ = false;
  for (const Quantity quantity :
       {Quantity::kSpeedX, Quantity::kSpeedY, Quantity::kSpeedZ, Quantity::kSlip}) {
    needs_velocity_ = needs_velocity_ || table.needs(quantity);
  }
  needs_mass_ = table.needs(Quantity::kMassA) || table.needs(Quantity::kMassB);
  needs_impulse_ = table.needs(Quantity::kImpulse);
  asks_for_variable_ = false;
  const StateIndex first = table.first_state(state_machine_);
  for (std::size_t s = 0; s < table.state_machines()[state_machine_].states.size(); ++s) {
    const auto state = static_cast<StateIndex>(first + s);
    asks_for_variable_ = asks_for_variable_ || table.asks_for_variable(state);
  }
  const bool was_stateless = stateless_;
  stateless_ = table.state_machines()[state_machine_].is_stateless();
  if (!stateless_ && was_stateless) {
    states_ = PairStates(row_count_, capacity_, table.slot_count());
  } else if (!stateless_ && states_.slot_count() != table.slot_count()) {
    states_.change_slots(table.slot_count());
  }
  memory_.assign(block_capacity_ * table.slot_count(), kNoValue);
}

void PairStateMachines::begin_step(const PairStep& step) noexcept {
  switching_ = 0.0;
  parameter_energy_ = 0.0;
  forgotten_ = 0;
  if (!stateless_ && !step.frozen) states_.begin_step();
}

std::span<const std::uint32_t> PairStateMachines::with_bound(const PairStep& step, std::size_t a,
                                                             std::size_t count,
                                                             const PairRow& row) noexcept {
  if (!remembers(step)) return {};
  std::size_t merged = 0;
  std::size_t next = 0;
  for (std::size_t old = states_.old_begin(a); old < states_.old_end(a); ++old) {
    const PairState& pair = states_.old_state(old);
    if (pair.state == start_) continue;
    while (next < count && row.column[next] < pair.column) merged_[merged++] = row.column[next++];
    if (next < count && row.column[next] == pair.column) continue;
    merged_[merged++] = pair.column;
  }
  if (merged + count - next == count) return {};
  while (next < count) merged_[merged++] = row.column[next++];
  return {merged_.data(), merged};
}

bool PairStateMachines::is_bound(std::size_t a, std::uint32_t column) const noexcept {
  if (stateless_) return false;
  std::size_t first = states_.begin(a);
  std::size_t last = states_.end(a);
  while (first < last) {
    const std::size_t middle = first + (last - first) / 2;
    (states_.state(middle).column < column ? first : last) =
        states_.state(middle).column < column ? middle + 1 : middle;
  }
  return first < states_.end(a) && states_.state(first).column == column &&
         states_.state(first).state != start_;
}

void PairStateMachines::step(const PairStep& step, const MemberColumns& members, const double* slid,
                             const PairRest& rest, double range, PairBlock& block) noexcept {
  const double range_square = range * range;
  if (needs_mass_) find_masses(block.rows());
  if (stateless_) {
    add_parameter_energy(step, rest, range, block);
    find_plain_tensions(step, block);
    return;
  }
  recall(step, block);
  add_parameter_energy(step, rest, range, block);
  if (needs_velocity_) find_velocities(members, block.rows());
  find_quantities(step, block);
  step_batches(step, slid, block);
  if (remembers(step)) remember(range_square, block);
  find_factors(range_square, block);
}

namespace {

/// How much longer a pair has become in the last period [m]; 0 for MATs at one point, which have no direction.
double increment_of(const PairRow& pairs, std::size_t i) noexcept {
  return pairs.square[i] == 0.0 ? 0.0 : pairs.elongation_increment[i];
}

}  // namespace

/// Such energy of pairs in one state, a spring without a force limit. Beyond its range a pair has what it has there.
double PairStateMachines::linear_parameter_energy(const PairStep& step, const PairRest& rest,
                                                  double range, PairBlock& block) const noexcept {
  const StateTerm& term = step.table.terms()[start_];
  const double now = step.table.stiffness(start_);
  const double before = step.table.stiffness_before(start_);
  if (now == before) return 0.0;
  // Where a stiffness is below 0, a contact pushes what is apart.
  const auto energy = [&term](double stiffness, double elongation, double increment) {
    const double tension =
        std::min(term.max_tension, std::max(term.min_tension, stiffness * elongation));
    return tension * (elongation - increment);
  };
  const auto more = [&](double elongation, double increment) {
    return energy(now, elongation, increment) - energy(before, elongation, increment);
  };
  const PairRows rows = block.rows();
  const PairRow pairs = rows.pairs;
  double sum = 0.0;
  for (std::size_t i = 0; i < rows.count; ++i) {
    const double rest_length = rest.length(rows.column_a[i] / 4, pairs.column[i] / 4);
    sum += more(pairs.length[i] - rest_length, increment_of(pairs, i)) -
           more(range - rest_length, 0.0);
  }
  return 0.5 * sum;
}

void PairStateMachines::add_parameter_energy(const PairStep& step, const PairRest& rest,
                                             double range, PairBlock& block) noexcept {
  if (!asks_for_variable_ || step.frozen) return;
  const bool has_limit = std::isfinite(step.table.state(start_).force_limit);
  if (stateless_ && step.table.is_linear(start_) && !has_limit) {
    parameter_energy_ += linear_parameter_energy(step, rest, range, block);
    return;
  }
  const PairRows rows = block.rows();
  const PairRow pairs = rows.pairs;
  const bool asks_at_range = step.table.asks_for_variable(start_);
  for (std::size_t i = 0; i < rows.count; ++i) {
    const StateIndex state = stateless_ ? start_ : state_[i];
    const bool out_of_reach = state == start_ && !(pairs.square[i] < range * range);
    if (out_of_reach) continue;
    const std::size_t a = rows.column_a[i] / 4;
    const std::size_t b = pairs.column[i] / 4;
    const EndMasses mass = masses_of(a, b);
    if (step.table.asks_for_variable(state)) {
      parameter_energy_ += step.table.parameter_energy(
          state, pairs.length[i], block.rest_length()[i], mass, increment_of(pairs, i));
    }
    if (asks_at_range)
      parameter_energy_ -= step.table.parameter_energy(start_, range, rest.length(a, b), mass, 0.0);
  }
}

void PairStateMachines::find_plain_tensions(const PairStep& step, PairBlock& block) noexcept {
  const PairRow pairs = block.rows().pairs;
  PlainRows plain;
  plain.count = block.padded_count();
  plain.distance = pairs.length;
  plain.inverse = pairs.inverse;
  plain.elongation_increment = pairs.elongation_increment;
  plain.rest_length = block.rest_length();
  plain.mass_a = array(kMassA);
  plain.mass_b = array(kMassB);
  plain.rate = 1.0 / dt_;
  plain.factor = block.factor();
  plain.viscous_factor = block.viscous_factor();
  step.state_machines.tensions(step.table.terms()[start_], plain);
}

/// Loads what each pair of the block remembers, or what a new one begins with.
void PairStateMachines::recall(const PairStep& step, PairBlock& block) noexcept {
  const std::size_t slots = states_.slot_count();
  const std::uint32_t* column = block.rows().pairs.column;
  for (std::size_t a = block.first(); a < block.last(); ++a) {
    std::size_t old = remembers(step) ? states_.old_begin(a) : 0;
    const std::size_t old_end = remembers(step) ? states_.old_end(a) : 0;
    for (std::size_t i = block.begin_of(a); i < block.end_of(a); ++i) {
      while (old < old_end && states_.old_state(old).column < column[i]) ++old;
      if (old == old_end || states_.old_state(old).column != column[i]) {
        begin_pair(i, start_, step);
        continue;
      }
      const PairState& pair = states_.old_state(old);
      state_[i] = pair.state;
      block.rest_length()[i] = pair.rest_length;
      array(kTension)[i] = pair.tension;
      array(kImpulse)[i] = pair.impulse;
      array(kEntered)[i] = pair.entered;
      for (std::size_t s = 0; s < slots; ++s) {
        memory_of(i)[s * kPairBatch] = states_.old_memory(old, s);
      }
    }
  }
  for (std::size_t i = block.count(); i < block.padded_count(); ++i) begin_pair(i, padding_, step);
}

void PairStateMachines::begin_pair(std::size_t pair, StateIndex state,
                                   const PairStep& step) noexcept {
  state_[pair] = state;
  array(kTension)[pair] = 0.0;
  array(kImpulse)[pair] = 0.0;
  array(kEntered)[pair] = static_cast<double>(step.step);
  for (std::size_t s = 0; s < states_.slot_count(); ++s) memory_of(pair)[s * kPairBatch] = kNoValue;
}

void PairStateMachines::find_masses(const PairRows& rows) noexcept {
  for (std::size_t i = 0; i < padded(rows.count, kPairBatch); ++i) {
    array(kMassA)[i] = mass_[rows.column_a[i] / 4];
    array(kMassB)[i] = mass_[rows.pairs.column[i] / 4];
  }
}

void PairStateMachines::find_velocities(const MemberColumns& members,
                                        const PairRows& rows) noexcept {
  const double rate = 1.0 / dt_;
  const PairRow& pairs = rows.pairs;
  for (std::size_t i = 0; i < padded(rows.count, kPairBatch); ++i) {
    const double* moved_a = members.moved + rows.column_a[i];
    const double* moved_b = members.moved + pairs.column[i];
    const double along[3] = {pairs.x[i], pairs.y[i], pairs.z[i]};
    const double speed = pairs.elongation_increment[i] * rate;
    double slip_square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double velocity = (moved_b[axis] - moved_a[axis]) * rate;
      array(static_cast<Array>(kSpeedX + axis))[i] = velocity;
      const double across = velocity - speed * (along[axis] * pairs.inverse[i]);
      slip_square += across * across;
    }
    array(kSlip)[i] = std::sqrt(slip_square);
  }
}

void PairStateMachines::find_quantities(const PairStep& step, PairBlock& block) noexcept {
  const double rate = 1.0 / dt_;
  const PairRow pairs = block.rows().pairs;
  const double* rest_length = block.rest_length();
  const double* entered = array(kEntered);
  double* elongation = array(kElongation);
  double* speed = array(kSpeed);
  double* age = array(kAge);
  const auto now = static_cast<double>(step.step);
  for (std::size_t i = 0; i < block.padded_count(); ++i) {
    elongation[i] = pairs.length[i] - rest_length[i];
    speed[i] = pairs.elongation_increment[i] * rate;
    age[i] = (now - entered[i]) * dt_;
  }
}

void PairStateMachines::step_batches(const PairStep& step, const double* slid,
                                     PairBlock& block) noexcept {
  alignas(64) double elastic_before[kStateBatch] = {};
  const PairRows pairs = block.rows();
  StateMachineRows rows{};
  rows.dt = dt_;
  rows.rate = 1.0 / dt_;
  rows.now = static_cast<double>(step.step);
  rows.frozen = step.frozen;
  rows.memory_slots = states_.slot_count();
  rows.elastic_before = elastic_before;
  for (std::size_t i = 0; i < block.padded_count(); i += kStateBatch) {
    const auto set = [&rows](Quantity quantity, const double* values) {
      rows.quantity[static_cast<std::size_t>(quantity)] = values;
    };
    rows.elongation_increment = pairs.pairs.elongation_increment + i;
    rows.still = 0;
    for (std::uint32_t j = 0; j < kStateBatch; ++j) {
      rows.still |= static_cast<std::uint32_t>(pairs.pairs.square[i + j] == 0.0) << j;
    }
    rows.state = state_.data() + i;
    rows.rest_length = block.rest_length() + i;
    rows.elongation = array(kElongation) + i;
    rows.tension = array(kTension) + i;
    rows.impulse = needs_impulse_ ? array(kImpulse) + i : nullptr;
    rows.entered = array(kEntered) + i;
    rows.memory = memory_.data() + i * states_.slot_count();
    rows.elastic = array(kElastic) + i;
    set(Quantity::kDistance, pairs.pairs.length + i);
    set(Quantity::kElongation, rows.elongation);
    set(Quantity::kSpeed, array(kSpeed) + i);
    set(Quantity::kSpeedX, array(kSpeedX) + i);
    set(Quantity::kSpeedY, array(kSpeedY) + i);
    set(Quantity::kSpeedZ, array(kSpeedZ) + i);
    set(Quantity::kSlip, array(kSlip) + i);
    set(Quantity::kSlid, (slid == nullptr ? array(kNotSlid) : slid) + i);
    set(Quantity::kForce, rows.tension);
    set(Quantity::kImpulse, rows.impulse);
    set(Quantity::kAge, array(kAge) + i);
    set(Quantity::kRestLength, rows.rest_length);
    set(Quantity::kMassA, array(kMassA) + i);
    set(Quantity::kMassB, array(kMassB) + i);
    step.state_machines.step(step.table.terms(), rows);
    if (rows.changed != 0) record_changes(step, i, pairs, rows);
  }
}

void PairStateMachines::record_changes(const PairStep& step, std::size_t i, const PairRows& pairs,
                                       const StateMachineRows& rows) noexcept {
  const StateIndex first = step.table.first_state(state_machine_);
  for (std::size_t j = 0; j < kStateBatch; ++j) {
    if ((rows.changed >> j & 1U) == 0) continue;
    const double energy = step.table.change_energy(rows, j);
    switching_ += energy;
    step.log.add({step.step, kNoLink, mat_[pairs.column_a[i + j] / 4],
                  mat_[pairs.pairs.column[i + j] / 4], state_machine_, rows.from[j] - first,
                  rows.state[j] - first, step.table.triggered(rows.from[j], rows.exit[j]),
                  rows.trigger_value[j], energy});
  }
}

void PairStateMachines::remember(double range_square, PairBlock& block) noexcept {
  const PairRow pairs = block.rows().pairs;
  for (std::size_t a = block.first(); a < block.last(); ++a) {
    for (std::size_t i = block.begin_of(a); i < block.end_of(a); ++i) {
      if (state_[i] == start_ && !(pairs.square[i] < range_square)) continue;
      const bool kept = states_.add({pairs.column[i], state_[i], block.rest_length()[i],
                                     array(kTension)[i], array(kImpulse)[i], array(kEntered)[i]},
                                    memory_of(i), kPairBatch);
      if (!kept) ++forgotten_;
    }
    states_.end_row(a);
  }
}

void PairStateMachines::find_factors(double range_square, PairBlock& block) noexcept {
  const PairRow pairs = block.rows().pairs;
  const double* tension = array(kTension);
  const double* elastic = array(kElastic);
  double* factor = block.factor();
  double* viscous_factor = block.viscous_factor();
  for (std::size_t i = 0; i < block.padded_count(); ++i) {
    const bool out_of_reach = state_[i] == start_ && !(pairs.square[i] < range_square);
    const double inverse = out_of_reach ? 0.0 : pairs.inverse[i];
    factor[i] = tension[i] * inverse;
    viscous_factor[i] = (tension[i] - elastic[i]) * inverse;
  }
}

}  // namespace cordis::engine
