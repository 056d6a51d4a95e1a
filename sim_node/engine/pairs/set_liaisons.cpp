// sim_node/engine/pairs/set_liaisons.cpp
#include "sim_node/engine/pairs/set_liaisons.h"

#include <algorithm>

namespace cordis::engine {

SetLiaisons::SetLiaisons(const NetworkDescription& description, const StateTable& table,
                         const PairKernel& kernel) {
  sets_.reserve(description.sets.size());
  for (std::size_t s = 0; s < description.sets.size(); ++s) {
    sets_.emplace_back(description, s, table, kernel);
  }
}

StepEnergy SetLiaisons::add_forces(const PairStep& step, const ForceColumns& columns,
                                   ThreadTeam* team) noexcept {
  StepEnergy energy;
  for (SetPairs& set : sets_) energy += set.add_forces(step, columns, team);
  return energy;
}

std::size_t SetLiaisons::part_count() const noexcept {
  std::size_t parts = 1;
  for (const SetPairs& set : sets_) parts = std::max(parts, set.part_count());
  return parts;
}

void SetLiaisons::expect_team(std::size_t member_count) noexcept {
  for (SetPairs& set : sets_) set.expect_team(member_count);
}

void SetLiaisons::swap_team_room(SetLiaisons& other) noexcept {
  for (std::size_t s = 0; s < std::min(sets_.size(), other.sets_.size()); ++s)
    sets_[s].swap_team_room(other.sets_[s]);
}

StepEnergy SetLiaisons::take_positions(const ForceColumns& columns) noexcept {
  StepEnergy energy;
  for (SetPairs& set : sets_) energy += set.take_positions(columns);
  return energy;
}

bool SetLiaisons::refresh() noexcept {
  bool changed = false;
  for (SetPairs& set : sets_) changed = set.refresh() || changed;
  return changed;
}

StepEnergy SetLiaisons::add_pair_forces(const PairStep& step,
                                        const ForceColumns& columns) noexcept {
  StepEnergy energy;
  for (SetPairs& set : sets_) energy += set.add_pair_forces(step, columns);
  return energy;
}

void SetLiaisons::mark_neighbours(const WakePropagation& pass, const std::vector<bool>& never_rests,
                                  MatRoles& roles) noexcept {
  for (SetPairs& set : sets_) set.mark_neighbours(pass, never_rests, roles);
}

void SetLiaisons::choose_active(const std::vector<bool>& never_rests, MatRoles& roles) noexcept {
  for (SetPairs& set : sets_) set.choose_active(never_rests, roles);
}

StepEnergy SetLiaisons::work_since_last_call(const MatArray& mats) const noexcept {
  StepEnergy energy;
  for (const SetPairs& set : sets_) energy += set.work_since_last_call(mats);
  return energy;
}

void SetLiaisons::add_viscous_forces(AlignedVector<double>& force) const noexcept {
  for (const SetPairs& set : sets_) set.add_viscous_forces(force);
}

double SetLiaisons::stored_energy(const StateTable& table) noexcept {
  double sum = 0.0;
  for (SetPairs& set : sets_) sum += set.stored_energy(table);
  return sum;
}

Vec3 SetLiaisons::contact_force(std::uint32_t contact) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (const SetPairs& set : sets_) sum += set.contact_force(contact);
  return sum;
}

void SetLiaisons::start() noexcept {
  for (SetPairs& set : sets_) set.start();
}

void SetLiaisons::adopt(const StateTable& table) {
  for (SetPairs& set : sets_) set.adopt(table);
}

std::uint32_t SetLiaisons::overflowed_count() const noexcept {
  std::uint32_t count = 0;
  for (const SetPairs& set : sets_) count += set.is_overflowed() ? 1U : 0U;
  return count;
}

std::uint32_t SetLiaisons::forgotten_count() const noexcept {
  std::uint32_t count = 0;
  for (const SetPairs& set : sets_) count += set.forgotten_count();
  return count;
}

bool SetLiaisons::want_room(const double* position) const noexcept {
  bool wanted = false;
  for (const SetPairs& set : sets_) wanted = wanted || set.wants_room(position);
  return wanted;
}

void SetLiaisons::make_room(const double* position) noexcept {
  for (SetPairs& set : sets_) {
    if (set.wants_room(position)) set.make_room(position);
  }
}

void SetLiaisons::make_room_of(std::size_t value_count) noexcept {
  for (SetPairs& set : sets_) set.make_room_of(value_count);
}

void SetLiaisons::forget_partners() noexcept {
  for (SetPairs& set : sets_) set.forget_partners();
}

void SetLiaisons::serialize(Archive& archive, const StateTable& table) {
  for (SetPairs& set : sets_) set.serialize(archive, table);
}

}  // namespace cordis::engine
