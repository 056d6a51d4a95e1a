// sim_node/engine/links/state_links.cpp
#include "sim_node/engine/links/state_links.h"

#include <algorithm>
#include <span>

#include "node/assert.h"
#include "sim_node/engine/links/elongation_increment.h"

namespace cordis::engine {
namespace {

double mass_of(const Mat& mat) {
  return mat.kind == MatKind::kMass ? mat.mass : 0.0;
}

}  // namespace

StateLinkArray::StateLinkArray(const NetworkDescription& description, const StateTable& table,
                               const MatBlocks& blocks)
    : is_1d_(description.dimension == 1),
      freezes_(description.freeze_tolerance > 0.0),
      dt_(description.step),
      rate_(1.0 / description.step),
      rows_(description.state_links, blocks, kStateBatch, column_a_, column_b_),
      groups_(blocks),
      change_counts_(blocks.group_count(), 0),
      mass_a_(rows_.count(), 0.0),
      mass_b_(rows_.count(), 0.0),
      state_machine_(rows_.count(), 0U),
      state_(rows_.count(), table.padding_state()),
      rest_length_(rows_.count(), 0.0),
      tension_(rows_.count(), 0.0),
      impulse_(rows_.count(), 0.0),
      entered_(rows_.count(), 0.0),
      forced_(rows_.count(), kNotForced),
      elastic_factor_(rows_.count(), 0.0),
      viscous_factor_(rows_.count(), 0.0),
      active_(rows_.count(), kStateBatch) {
  for (std::size_t l = 0; l < description.state_links.size(); ++l) {
    const StateLink& link = description.state_links[l];
    const std::uint32_t r = rows_.row_of_link[l];
    mass_a_[r] = mass_of(description.mats[link.mat_a]);
    mass_b_[r] = mass_of(description.mats[link.mat_b]);
    state_machine_[r] = link.state_machine;
    state_[r] = table.start_state(link.state_machine);
    rest_length_[r] = link.rest_length;
  }
  for (const std::uint32_t r : rows_.row_of_link) {
    if (laws_ask_for_variable(description.state_machines[state_machine_[r]])) asking_.push_back(r);
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
    double increment = 0.0;  // where a link has no direction it has no force, hence no work
    if (is_1d_) {
      increment = moved.x();
    } else if (distance != 0.0) {
      increment = along.dot(moved) / distance;
    }
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

/// @param changes  room for one of each link  @return how many there are
std::size_t StateLinkArray::step_rows(const StateKernel& kernel, const StateTable& table,
                                      const ForceColumns& columns, std::uint64_t step,
                                      const ActiveLinks::Run& run, LinkEvent* changes,
                                      LinkWork& work) noexcept {
  struct Entry {
    const StateLinkArray* links;
    const StateTable* table;
    std::uint64_t step;
    std::size_t first_row;
    LinkEvent* next;
  };
  Entry entry{this, &table, step, run.first, changes};
  StateLinkRows links = rows(table, run);
  links.now = static_cast<double>(step);
  links.owner = &entry;
  links.on_change = [](void* owner, std::size_t first, const StateMachineRows& batch) noexcept {
    auto& target = *static_cast<Entry*>(owner);
    for (std::size_t i = 0; i < kStateBatch; ++i) {
      if ((batch.changed >> i & 1U) == 0) continue;
      const StateLinkArray& array = *target.links;
      const std::size_t row = target.first_row + first + i;
      const StateIndex first_state = target.table->first_state(array.state_machine_[row]);
      *target.next++ = {target.step,
                        array.rows_.link_of_row[row],
                        array.column_a_[row] / 4,
                        array.column_b_[row] / 4,
                        array.state_machine_[row],
                        batch.from[i] - first_state,
                        batch.state[i] - first_state,
                        target.table->triggered(batch.from[i], batch.exit[i]),
                        batch.trigger_value[i],
                        target.table->change_energy(batch, i)};
    }
  };
  (is_1d_ ? kernel.state_links_1d : kernel.state_links_3d)(links, columns, work);
  return static_cast<std::size_t>(entry.next - changes);
}

/// Enters the changes of all groups, which stand in the room of the log, in link order.
/// @return `energy`, and what they have brought into the links [J]
double StateLinkArray::enter_changes(EventLog& log, double energy) noexcept {
  const auto begin = log.room().begin();
  auto end = begin;
  for (std::size_t group = 0; group < change_counts_.size(); ++group) {
    const auto first = begin + static_cast<std::ptrdiff_t>(rows_.links_before[group]);
    const auto last = first + static_cast<std::ptrdiff_t>(change_counts_[group]);
    end = first == end ? last : std::move(first, last, end);
    change_counts_[group] = 0;
  }
  if (!groups_.are_one()) std::ranges::sort(begin, end, {}, &LinkEvent::link);
  for (auto change = begin; change != end; ++change) energy += change->energy;
  log.enter(static_cast<std::size_t>(end - begin));
  return energy;
}

StepEnergy StateLinkArray::add_forces(const StateKernel& kernel, const StateTable& table,
                                      const ForceColumns& columns, std::uint64_t step,
                                      EventLog& log, ThreadTeam& team) noexcept {
  CORDIS_ASSERT(rows_.row_of_link.size() <= log.room().size());
  LinkEvent* const changes = log.room().data();
  const double of_parameters = asking_.empty() ? 0.0 : parameter_energy(table, columns);
  LinkWork work;
  if (!groups_.are_one() && !freezes_) {
    work = groups_.add(team, [&](std::size_t group, LinkWork& of_group) noexcept {
      const ActiveLinks::Run run{rows_.first[group], rows_.count(group)};
      if (run.count == 0) return;
      change_counts_[group] = step_rows(kernel, table, columns, step, run,
                                        changes + rows_.links_before[group], of_group);
    });
  } else {
    for (const ActiveLinks::Run& run : active_.runs()) {
      change_counts_[0] +=
          step_rows(kernel, table, columns, step, run, changes + change_counts_[0], work);
    }
  }
  any_forced_ = false;
  StepEnergy energy = half_of(work);
  energy.switching = enter_changes(log, of_parameters);
  return energy;
}

void StateLinkArray::mark_neighbours(const WakePropagation& pass,
                                     const std::vector<bool>& never_rests,
                                     MatRoles& roles) const noexcept {
  for (const std::uint32_t r : rows_.row_of_link) {
    const std::uint32_t a = column_a_[r] / 4;
    const std::uint32_t b = column_b_[r] / 4;
    roles.join(a, b, pass);
    if (!never_rests[state_machine_[r]]) continue;
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
  for (const std::uint32_t r : rows_.row_of_link) {
    const double elongation_increment =
        half_elongation_increment(mats, column_a_[r], column_b_[r], is_1d_);
    work.elastic += elastic_factor_[r] * elongation_increment;
    work.dissipated += viscous_factor_[r] * elongation_increment;
  }
  return work;
}

void StateLinkArray::add_viscous_forces(const MatArray& mats,
                                        AlignedVector<double>& force) const noexcept {
  const MatLayout& layout = mats.layout();
  for (const std::uint32_t r : rows_.row_of_link) {
    const std::uint32_t a = layout.mat_of(column_a_[r]);
    const std::uint32_t b = layout.mat_of(column_b_[r]);
    const Vec3 along = is_1d_ ? Vec3(Vec3::Unit(layout.axis_of(column_a_[r])))
                              : Vec3(mats.position(b) - mats.position(a));
    column(force, a) += viscous_factor_[r] * along;
    column(force, b) -= viscous_factor_[r] * along;
  }
}

double StateLinkArray::distance_at_last_call(const MatArray& mats, std::size_t row) const noexcept {
  const Vec3 along =
      mats.position_of_forces(column_b_[row] / 4) - mats.position_of_forces(column_a_[row] / 4);
  return is_1d_ ? along.x() : along.norm();
}

double StateLinkArray::stored_energy(const StateTable& table, const MatArray& mats) const noexcept {
  double sum = 0.0;
  for (const std::uint32_t r : rows_.row_of_link) {
    sum += table.stored_energy(state_[r], distance_at_last_call(mats, r), rest_length_[r],
                               {mass_a_[r], mass_b_[r]});
  }
  return sum;
}

void StateLinkArray::force_state(const StateTable& table, std::uint32_t link,
                                 std::uint32_t state) noexcept {
  CORDIS_ASSERT(link < rows_.row_of_link.size());
  const std::uint32_t row = row_of(link);
  CORDIS_ASSERT(state < table.state_machines()[state_machine_[row]].states.size());
  forced_[row] = table.first_state(state_machine_[row]) + state;
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
  const std::uint32_t row = row_of(link);
  return state_[row] - table.first_state(state_machine_[row]);
}

void StateLinkArray::serialize(Archive& archive, const StateTable& table) {
  const auto is_state = [this, &table](std::size_t row, StateIndex state) {
    return rows_.is_padding(row) ? state == table.padding_state()
                                 : table.has_state(state_machine_[row], state);
  };
  archive.wholes(std::span(state_), is_state);
  archive.wholes(std::span(forced_), [&is_state](std::size_t row, StateIndex state) {
    return state == kNotForced || is_state(row, state);
  });
  for (auto* values : {&rest_length_, &tension_, &impulse_, &entered_, &elastic_factor_,
                       &viscous_factor_, &memory_}) {
    archive.reals(*values);
  }
  archive.hash_rows_at(rows_.row_of_link, state_, rest_length_, tension_, impulse_, entered_);
  if (!archive.restores()) return;
  any_forced_ = std::any_of(forced_.begin(), forced_.end(),
                            [](std::uint32_t target) { return target != kNotForced; });
}

}  // namespace cordis::engine
