// sim_node/engine/links/state_links.cpp
#include "sim_node/engine/links/state_links.h"

#include <algorithm>
#include <limits>
#include <span>

#include "node/assert.h"
#include "sim_node/engine/links/elongation_increment.h"

namespace cordis::engine {
namespace {

double mass_of(const Mat& mat) {
  return mat.kind == MatKind::kMass ? mat.mass : 0.0;
}

}  // namespace

StateLinkArray::StateLinkArray(const NetworkDescription& description, const StateTable& table)
    : is_1d_(description.dimension == 1),
      dt_(description.step),
      rate_(1.0 / description.step),
      link_count_(description.state_links.size()),
      column_a_(padded(link_count_, kStateBatch), 0U),
      column_b_(column_a_.size(), 0U),
      mass_a_(column_a_.size(), 0.0),
      mass_b_(column_a_.size(), 0.0),
      state_machine_(column_a_.size(), 0U),
      state_(column_a_.size(), table.padding_state()),
      rest_length_(column_a_.size(), 0.0),
      tension_(column_a_.size(), 0.0),
      impulse_(column_a_.size(), 0.0),
      entered_(column_a_.size(), 0.0),
      forced_(column_a_.size(), kNotForced),
      elastic_factor_(column_a_.size(), 0.0),
      viscous_factor_(column_a_.size(), 0.0),
      active_(column_a_.size(), kStateBatch) {
  for (std::size_t l = 0; l < link_count_; ++l) {
    const StateLink& link = description.state_links[l];
    column_a_[l] = 4 * link.mat_a;
    column_b_[l] = 4 * link.mat_b;
    mass_a_[l] = mass_of(description.mats[link.mat_a]);
    mass_b_[l] = mass_of(description.mats[link.mat_b]);
    state_machine_[l] = link.state_machine;
    state_[l] = table.start_state(link.state_machine);
    rest_length_[l] = link.rest_length;
  }
  for (std::size_t l = link_count_; l < column_a_.size(); ++l) {
    column_a_[l] = column_b_[l] = column_of_padding(l, description.mats.size());
  }
  for (std::uint32_t l = 0; l < link_count_; ++l) {
    if (laws_ask_for_variable(description.state_machines[state_machine_[l]])) asking_.push_back(l);
  }
  adopt(table);
}

double StateLinkArray::parameter_energy(const StateTable& table,
                                        const ForceColumns& columns) const noexcept {
  double sum = 0.0;
  for (const std::uint32_t l : asking_) {
    if (!table.asks_for_variable(state_[l])) continue;
    const auto between = [&](const double* places) {
      return Vec3(Vec3::Map(places + column_b_[l]) - Vec3::Map(places + column_a_[l]));
    };
    const Vec3 along = between(columns.position);
    const Vec3 moved = along - between(columns.delayed);
    const double distance = is_1d_ ? along.x() : along.norm();
    if (!is_1d_ && distance == 0.0) continue;  // no direction, hence no force
    const double increment = is_1d_ ? moved.x() : along.dot(moved) / distance;
    sum += table.parameter_energy(state_[l], distance, rest_length_[l], {mass_a_[l], mass_b_[l]},
                                  increment);
  }
  return sum;
}

StateLinkRows StateLinkArray::rows(const StateTable& table, const ActiveLinks::Run& run) noexcept {
  StateLinkRows rows;
  const std::size_t first = run.first;
  rows.count = run.count;
  rows.column_a = column_a_.data() + first;
  rows.column_b = column_b_.data() + first;
  rows.mass_a = mass_a_.data() + first;
  rows.mass_b = mass_b_.data() + first;
  rows.states = table.terms();
  rows.state = state_.data() + first;
  rows.rest_length = rest_length_.data() + first;
  rows.tension = tension_.data() + first;
  rows.impulse = needs_impulse_ ? impulse_.data() + first : nullptr;
  rows.entered = entered_.data() + first;
  rows.memory = memory_.data() + first * slot_count_;
  rows.memory_slots = slot_count_;
  rows.forced = any_forced_ ? forced_.data() + first : nullptr;
  rows.elastic_factor = elastic_factor_.data() + first;
  rows.viscous_factor = viscous_factor_.data() + first;
  rows.dt = dt_;
  rows.rate = rate_;
  rows.needs_age = needs_age_;
  rows.needs_velocity = needs_velocity_;
  return rows;
}

void StateLinkArray::add_forces_before_start(const StateKernel& kernel, const StateTable& table,
                                             const ForceColumns& columns) noexcept {
  LinkWork none;
  for (const ActiveLinks::Run& run : active_.runs()) {
    StateLinkRows links = rows(table, run);
    links.frozen = true;
    links.impulse = nullptr;
    (is_1d_ ? kernel.state_links_1d : kernel.state_links_3d)(links, columns, none);
  }
}

void StateLinkArray::start() noexcept {
  forget_tensions();
  forget_viscous_forces();
}

void StateLinkArray::forget_tensions() noexcept {
  std::fill(tension_.begin(), tension_.end(), 0.0);
}

void StateLinkArray::forget_viscous_forces() noexcept {
  std::fill(viscous_factor_.begin(), viscous_factor_.end(), 0.0);
}

StepEnergy StateLinkArray::add_forces(const StateKernel& kernel, const StateTable& table,
                                      const ForceColumns& columns, std::uint64_t step,
                                      EventLog& log) noexcept {
  struct Entry {
    const StateLinkArray* links;
    const StateTable* table;
    EventLog* log;
    std::uint64_t step;
    std::size_t origin;  // link
    double switching;    // [J]
  };
  Entry entry{this, &table, &log, step, 0, 0.0};
  if (!asking_.empty()) entry.switching = parameter_energy(table, columns);
  const auto on_change = [](void* owner, std::size_t first, const StateMachineRows& rows) noexcept {
    auto& target = *static_cast<Entry*>(owner);
    for (std::size_t i = 0; i < kStateBatch; ++i) {
      if ((rows.changed >> i & 1U) == 0) continue;
      const std::size_t l = target.origin + first + i;
      const StateIndex first_state = target.table->first_state(target.links->state_machine_[l]);
      const double energy = target.table->change_energy(rows, i);
      target.switching += energy;
      target.log->add({target.step, static_cast<std::uint32_t>(l), target.links->column_a_[l] / 4,
                       target.links->column_b_[l] / 4, target.links->state_machine_[l],
                       rows.from[i] - first_state, rows.state[i] - first_state,
                       target.table->triggered(rows.from[i], rows.exit[i]), rows.trigger_value[i],
                       energy});
    }
  };
  LinkWork work;
  for (const ActiveLinks::Run& run : active_.runs()) {
    StateLinkRows links = rows(table, run);
    entry.origin = run.first;
    links.now = static_cast<double>(step);
    links.owner = &entry;
    links.on_change = on_change;
    (is_1d_ ? kernel.state_links_1d : kernel.state_links_3d)(links, columns, work);
  }
  any_forced_ = false;
  StepEnergy energy = half_of(work);
  energy.switching = entry.switching;
  return energy;
}

void StateLinkArray::mark_neighbours(const WakePropagation& pass,
                                     const std::vector<bool>& never_rests,
                                     MatRoles& roles) const noexcept {
  for (std::size_t l = 0; l < link_count_; ++l) {
    const std::uint32_t a = column_a_[l] / 4;
    const std::uint32_t b = column_b_[l] / 4;
    roles.join(a, b, pass);
    if (!never_rests[state_machine_[l]]) continue;
    const bool is_mass_a = roles.has(a, kIsMass);
    const bool is_mass_b = roles.has(b, kIsMass);
    if (is_mass_a || !is_mass_b) roles.add(a, kWholeForce);
    if (is_mass_b) roles.add(b, kWholeForce);
  }
}

void StateLinkArray::choose_active(MatRoles& roles) noexcept {
  active_.choose(column_a_.data(), column_b_.data(), roles);
}

StepEnergy StateLinkArray::work_since_last_call(const MatArray& mats) const noexcept {
  StepEnergy work;
  for (std::size_t l = 0; l < link_count_; ++l) {
    const double elongation_increment =
        half_elongation_increment(mats, column_a_[l], column_b_[l], is_1d_);
    work.elastic += elastic_factor_[l] * elongation_increment;
    work.dissipated += viscous_factor_[l] * elongation_increment;
  }
  return work;
}

double StateLinkArray::distance_at_last_call(const MatArray& mats,
                                             std::size_t link) const noexcept {
  const Vec3 along =
      mats.position_of_forces(column_b_[link] / 4) - mats.position_of_forces(column_a_[link] / 4);
  return is_1d_ ? along.x() : along.norm();
}

double StateLinkArray::stored_energy(const StateTable& table, const MatArray& mats) const noexcept {
  double sum = 0.0;
  for (std::size_t l = 0; l < link_count_; ++l) {
    sum += table.stored_energy(state_[l], distance_at_last_call(mats, l), rest_length_[l],
                               {mass_a_[l], mass_b_[l]});
  }
  return sum;
}

void StateLinkArray::force_state(const StateTable& table, std::uint32_t link,
                                 std::uint32_t state) noexcept {
  CORDIS_ASSERT(link < link_count_ &&
                state < table.state_machines()[state_machine_[link]].states.size());
  forced_[link] = table.first_state(state_machine_[link]) + state;
  any_forced_ = true;
}

void StateLinkArray::adopt(const StateTable& table) {
  if (slot_count_ != table.slot_count()) {
    slot_count_ = table.slot_count();
    memory_.assign(slot_count_ * column_a_.size(), kNoValue);
  }
  needs_impulse_ = table.needs(Quantity::kImpulse);
  needs_age_ = table.needs(Quantity::kAge);
  needs_velocity_ = false;
  for (const Quantity quantity :
       {Quantity::kSpeedX, Quantity::kSpeedY, Quantity::kSpeedZ, Quantity::kSlip}) {
    needs_velocity_ = needs_velocity_ || table.needs(quantity);
  }
}

std::uint32_t StateLinkArray::state_of(const StateTable& table, std::uint32_t link) const noexcept {
  return state_[link] - table.first_state(state_machine_[link]);
}

void StateLinkArray::serialize(Archive& archive, const StateTable& table) {
  const auto is_state = [this, &table](std::size_t l, StateIndex state) {
    return l < link_count_ ? table.has_state(state_machine_[l], state)
                           : state == table.padding_state();
  };
  archive.wholes(std::span(state_), is_state);
  archive.wholes(std::span(forced_), [&is_state](std::size_t l, StateIndex state) {
    return state == kNotForced || is_state(l, state);
  });
  for (auto* values : {&rest_length_, &tension_, &impulse_, &entered_, &elastic_factor_,
                       &viscous_factor_, &memory_}) {
    archive.reals(*values);
  }
  archive.hash_rows(link_count_, state_, rest_length_, tension_, impulse_, entered_);
  if (!archive.restores()) return;
  any_forced_ = std::any_of(forced_.begin(), forced_.end(),
                            [](std::uint32_t target) { return target != kNotForced; });
}

}  // namespace cordis::engine
