// sim_node/engine/links/bend_states.cpp
#include "sim_node/engine/links/bend_states.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::engine {

BendStates::BendStates(const NetworkDescription& description, const StateTable& table)
    : dimension_(description.dimension),
      dt_(description.step),
      row_count_(
          static_cast<std::size_t>(std::ranges::count_if(description.bends, &Bend::has_states))),
      state_machine_(padded(row_count_, kStateBatch), 0U),
      state_(state_machine_.size(), table.padding_state()),
      rest_angle_(state_.size(), 0.0),
      moment_(state_.size(), 0.0),
      entered_(state_.size(), 0.0),
      forced_(state_.size(), kNotForced),
      angle_(state_.size(), 0.0),
      increment_(state_.size(), 0.0) {
  std::size_t row = 0;
  for (const Bend& bend : description.bends) {
    if (!bend.has_states()) continue;
    state_machine_[row] = bend.state_machine;
    state_[row] = table.start_state(bend.state_machine);
    rest_angle_[row] = bend.rest_angle;
    ++row;
  }
  adopt(table);
}

void BendStates::set_angle(std::uint32_t row, const AngleAndRate& angle) noexcept {
  angle_[row] = angle.angle;
  increment_[row] = angle.rate;
}

void BendStates::step_batch(const StateKernel& kernel, const StateTable& table, std::uint64_t step,
                            std::size_t first, StateMachineRows& rows) noexcept {
  alignas(64) double beyond[kStateBatch];
  alignas(64) double speed[kStateBatch];
  alignas(64) double age[kStateBatch];
  alignas(64) double moment[kStateBatch];
  alignas(64) double elastic[kStateBatch];
  alignas(64) double elastic_before[kStateBatch];
  for (std::size_t i = 0; i < kStateBatch; ++i) {
    beyond[i] = angle_beyond(rest_angle_[first + i], angle_[first + i], dimension_);
    speed[i] = increment_[first + i] / dt_;
    age[i] = (static_cast<double>(step) - entered_[first + i]) * dt_;
    moment[i] = moment_[first + i];
  }
  const auto set = [&rows](Quantity quantity, const double* values) {
    rows.quantity[static_cast<std::size_t>(quantity)] = values;
  };
  set(Quantity::kDistance, angle_.data() + first);  // for `rest: here`
  set(Quantity::kAngle, angle_.data() + first);
  set(Quantity::kBend, beyond);
  set(Quantity::kElongation, beyond);  // triggers where a condition names none
  set(Quantity::kAngularSpeed, speed);
  set(Quantity::kMoment, moment_.data() + first);
  set(Quantity::kRestAngle, rest_angle_.data() + first);
  set(Quantity::kAge, age);
  rows.elongation_increment = increment_.data() + first;
  rows.dt = dt_;
  rows.rate = 1.0 / dt_;
  rows.now = static_cast<double>(step);
  rows.state = state_.data() + first;
  rows.rest_length = rest_angle_.data() + first;
  rows.elongation = beyond;
  rows.tension = moment;  // the law of a link: not that of a bend, which finds its own
  rows.entered = entered_.data() + first;
  rows.memory = memory_.data() + first * slot_count_;
  rows.memory_slots = slot_count_;
  rows.forced = any_forced_ ? forced_.data() + first : nullptr;
  rows.elastic = elastic;
  rows.elastic_before = elastic_before;
  kernel.step(table.terms(), rows);
}

BendChange BendStates::change_of(const StateTable& table, const StateMachineRows& rows,
                                 std::size_t first, std::size_t i) noexcept {
  BendChange change;
  change.row = static_cast<std::uint32_t>(first + i);
  change.from = rows.from[i];
  change.to = state_[first + i];
  change.quantity = table.triggered(rows.from[i], rows.exit[i]);
  change.value = rows.trigger_value[i];
  change.rest_before = rows.rest_before[i];
  if (change.quantity == Quantity::kElongation) change.quantity = Quantity::kBend;
  if (!table.keeps_rest(rows.from[i], rows.exit[i])) return change;
  if (const std::optional<double> own = table.state(change.to).rest_angle)
    rest_angle_[first + i] = *own;
  return change;
}

std::uint32_t BendStates::state_of(const StateTable& table, std::uint32_t row) const noexcept {
  return state_[row] - table.first_state(state_machine_[row]);
}

void BendStates::force_state(const StateTable& table, std::uint32_t row,
                             std::uint32_t state) noexcept {
  CORDIS_ASSERT(row < row_count_ &&
                state < table.state_machines()[state_machine_[row]].states.size());
  forced_[row] = table.first_state(state_machine_[row]) + state;
  any_forced_ = true;
}

void BendStates::adopt(const StateTable& table) {
  if (slot_count_ == table.slot_count()) return;
  slot_count_ = table.slot_count();
  memory_.assign(slot_count_ * state_.size(), kNoValue);
}

void BendStates::serialize(Archive& archive, const StateTable& table) {
  const auto is_state = [this, &table](std::size_t row, StateIndex state) {
    return row < row_count_ ? table.has_state(state_machine_[row], state)
                            : state == table.padding_state();
  };
  archive.wholes(std::span(state_), is_state);
  archive.wholes(std::span(forced_), [&is_state](std::size_t row, StateIndex state) {
    return state == kNotForced || is_state(row, state);
  });
  for (auto* values : {&rest_angle_, &moment_, &entered_, &memory_}) archive.reals(*values);
  archive.hash_rows(row_count_, state_, rest_angle_, moment_, entered_);
  if (!archive.restores()) return;
  any_forced_ = std::ranges::any_of(forced_, [](std::uint32_t t) { return t != kNotForced; });
}

}  // namespace cordis::engine
