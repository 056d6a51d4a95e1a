// sim_node/engine/links/bends.cpp
#include "sim_node/engine/links/bends.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::engine {
namespace {

Vec3 column(const double* columns, std::uint32_t mat) noexcept {
  const double* x = columns + 4 * std::size_t{mat};
  return {x[0], x[1], x[2]};
}

void add(double* columns, std::uint32_t mat, const Vec3& force) noexcept {
  double* f = columns + 4 * std::size_t{mat};
  for (int axis = 0; axis < 3; ++axis) f[axis] += force[axis];
}

}  // namespace

BendArray::BendArray(const NetworkDescription& description, const StateTable& table,
                     const MatBlocks& blocks)
    : dimension_(description.dimension),
      dt_(description.step),
      states_(description, table),
      groups_(blocks),
      works_(blocks.group_count()),
      viscous_moment_(3 * description.bends.size(), 0.0) {
  rows_.reserve(description.bends.size());
  std::vector<std::size_t> group;
  group.reserve(description.bends.size());
  for (const Bend& bend : description.bends) {
    const auto [low, high] = std::minmax({bend.mat_a, bend.mat_b, bend.mat_c});
    group.push_back(blocks.group_of(low, high));
    std::uint32_t state_row = kNoRow;
    if (bend.has_states()) {
      state_row = static_cast<std::uint32_t>(bend_of_row_.size());
      bend_of_row_.push_back(static_cast<std::uint32_t>(rows_.size()));
      with_states_.push_back(bend);
    }
    rows_.push_back({bend.mat_a, bend.mat_b, bend.mat_c, state_row, bend.stiffness,
                     bend.viscosity / description.step, BendShape(bend, description.dimension)});
  }
  order_ = by_group(group, blocks.group_count());
  const bool has_laws = std::ranges::any_of(with_states_, [&](const Bend& bend) {
    return has_laws_of_bends(description.state_machines[bend.state_machine]);
  });
  if (has_laws) law_moment_.assign(3 * with_states_.size(), 0.0);
  changes_.reserve(bend_of_row_.size());
  change_of_row_.assign(bend_of_row_.size(), kNoChange);
  following_of_row_.assign(bend_of_row_.size(), kNoChange);
  for (std::uint32_t r = 0; r < bend_of_row_.size(); ++r) {
    const StateMachine& machine = description.state_machines[with_states_[r].state_machine];
    if (!laws_ask_for_variable(machine)) continue;
    following_of_row_[r] = static_cast<std::uint32_t>(following_.size());
    following_.push_back({bend_of_row_[r], {0.0, rows_[bend_of_row_[r]].shape}});
  }
  states_.adopt(table);
  // The variables are not known yet.
  for (const std::uint32_t bend : bend_of_row_) put_state_at_rest_angle(table, rows_[bend]);
}

void BendArray::adopt(const StateTable& table) {
  states_.adopt(table);
  take_parameters(table);
}

void BendArray::take_parameters(const StateTable& table) noexcept {
  for (const std::uint32_t bend : bend_of_row_) put_state(table, rows_[bend]);
}

void BendArray::put_state(const StateTable& table, Row& row) noexcept {
  if (const std::optional<double> rest = table.rest_angle(states_.state_index(row.state_row)))
    states_.set_rest_angle(row.state_row, *rest);
  put_state_at_rest_angle(table, row);
}

/// Likewise, with the rest angle it has.
void BendArray::put_state_at_rest_angle(const StateTable& table, Row& row) noexcept {
  const StateIndex state = states_.state_index(row.state_row);
  row.stiffness = table.stiffness(state);
  row.viscosity_over_dt = table.viscosity(state) / dt_;
  row.shape.set_rest(states_.rest_angle(row.state_row), dimension_);
  row.has_law = !law_moment_.empty() && laws_of_bend(table.state(state)).any();
}

/// Across the bend there is none, for that would turn all three MATs about each other. A straight one has no
/// direction yet, and resists in all.
Vec3 BendArray::viscous_moment(const Row& row, const Vec3& bend, const Vec3& moved) const noexcept {
  const double square = dot(bend, bend);
  if (dimension_ == 1 || !(square > 0.0)) return row.viscosity_over_dt * moved;
  return (row.viscosity_over_dt * (dot(bend, moved) / square)) * bend;
}

Vec3 BendArray::last_viscous_moment(std::size_t row) const noexcept {
  const double* moment = viscous_moment_.data() + 3 * row;
  return {moment[0], moment[1], moment[2]};
}

Vec3 BendArray::last_law_moment(const Row& row) const noexcept {
  const double* moment = law_moment_.data() + 3 * std::size_t{row.state_row};
  return {moment[0], moment[1], moment[2]};
}

void BendArray::add_moment(const Row& row, const Vec3& moment, double* force) noexcept {
  const Vec3 on_a = row.shape.force_on_a(moment);
  const Vec3 on_c = row.shape.force_on_c(moment);
  add(force, row.mat_a, on_a);
  add(force, row.mat_c, on_c);
  add(force, row.mat_b, -(on_a + on_c));
}

BendSides BendArray::sides_of(const Row& row, const ForceColumns& columns) noexcept {
  const auto place = [&](std::uint32_t mat) -> Vec3 { return column(columns.position, mat); };
  const auto way = [&](std::uint32_t mat) -> Vec3 {
    return place(mat) - column(columns.delayed, mat);
  };
  return {place(row.mat_b) - place(row.mat_a), place(row.mat_c) - place(row.mat_b),
          way(row.mat_b) - way(row.mat_a), way(row.mat_c) - way(row.mat_b)};
}

double BendArray::energy_of(const Row& row, const LinearLaw& law, double part,
                            const ForceColumns& columns) noexcept {
  const auto bend_in = [&](const double* from) {
    return law.shape(column(from, row.mat_a), column(from, row.mat_b), column(from, row.mat_c));
  };
  const Vec3 bend = bend_in(columns.position);
  const Vec3 moved = bend - bend_in(columns.delayed);
  return 0.5 * law.stiffness * dot(bend, bend) - part * law.stiffness * dot(bend, moved);
}

double BendArray::energy_of_law(const LawsOfBend& laws, const Row& row, const BendShape& shape,
                                double part, const ForceColumns& columns,
                                const double* variables) const noexcept {
  if (laws.elasticity == nullptr) return 0.0;
  const auto bend_in = [&](const double* from) {
    return shape(column(from, row.mat_a), column(from, row.mat_b), column(from, row.mat_c));
  };
  const Vec3 bend = bend_in(columns.position);
  const Vec3 moved = bend - bend_in(columns.delayed);
  const BendOfLaw seen = bend_of_law(bend, moved, dimension_);
  const double moment = moment_of_laws({laws.elasticity, nullptr}, seen, variables).elastic;
  return engine::energy_of_law(laws, seen, variables) - part * moment * dot(seen.direction, moved);
}

/// In the middle of the last period, as StateTable::parameter_energy has it.
double BendArray::follow(const StateTable& table, const ForceColumns& columns) noexcept {
  constexpr double kMiddle = 0.5;
  double energy = 0.0;
  for (Following& each : following_) {
    Row& row = rows_[each.bend];
    each.last = {row.stiffness, row.shape};
    put_state(table, row);
    energy += energy_of(row, {row.stiffness, row.shape}, kMiddle, columns) -
              energy_of(row, each.last, kMiddle, columns);
    if (!row.has_law || !table.asks_for_variable(states_.state_index(row.state_row))) continue;
    const LawsOfBend laws = laws_of_bend(table.state(states_.state_index(row.state_row)));
    energy += energy_of_law(laws, row, row.shape, kMiddle, columns, table.variables().data()) -
              energy_of_law(laws, row, each.last.shape, kMiddle, columns,
                            table.variables_before().data());
  }
  return energy;
}

const BendArray::LinearLaw* BendArray::last_law_of(const Row& row) const noexcept {
  if (row.state_row == kNoRow) return nullptr;
  if (following_of_row_[row.state_row] != kNoChange)
    return &following_[following_of_row_[row.state_row]].last;
  const Change* const change = change_of(row);
  return change == nullptr ? nullptr : &change->law;
}

void BendArray::change_states(const StateKernel& kernel, const StateTable& table,
                              const ForceColumns& columns, std::uint64_t step) noexcept {
  for (std::uint32_t r = 0; r < bend_of_row_.size(); ++r) {
    const Row& row = rows_[bend_of_row_[r]];
    states_.set_angle(r, angle_of(with_states_[r], dimension_, sides_of(row, columns)));
  }
  states_.step(kernel, table, step, [&](const BendChange& change) {
    Row& row = rows_[bend_of_row_[change.row]];
    change_of_row_[change.row] = static_cast<std::uint32_t>(changes_.size());
    changes_.push_back({change, step, {row.stiffness, row.shape}});
    put_state(table, row);
  });
}

StepEnergy BendArray::add_forces(const StateKernel& kernel, const StateTable& table,
                                 const ForceColumns& columns, std::uint64_t step, EventLog& log,
                                 ThreadTeam& team) noexcept {
  if (bend_of_row_.empty()) return add_forces(table, columns, team);
  const double of_parameters = follow(table, columns);
  change_states(kernel, table, columns, step);
  StepEnergy work = add_forces(table, columns, team);
  work.switching += of_parameters;
  for (const Change& change : changes_) {
    work.switching += enter(table, change, columns, log);
    change_of_row_[change.of_states.row] = kNoChange;
  }
  changes_.clear();
  return work;
}

/// What the change adds to the stored energy, as the account keeps it: StateTable::change_energy.
double BendArray::enter(const StateTable& table, const Change& change, const ForceColumns& columns,
                        EventLog& log) noexcept {
  const Row& row = rows_[bend_of_row_[change.of_states.row]];
  const double part = table.part_of_work();
  double energy = energy_of(row, {row.stiffness, row.shape}, part, columns) -
                  energy_of(row, change.law, part, columns);
  if (!law_moment_.empty()) {
    const auto of_law = [&](StateIndex state, const BendShape& shape) {
      return energy_of_law(laws_of_bend(table.state(state)), row, shape, part, columns,
                           table.variables().data());
    };
    energy +=
        of_law(change.of_states.to, row.shape) - of_law(change.of_states.from, change.law.shape);
  }
  const std::uint32_t machine = states_.state_machine(change.of_states.row);
  const StateIndex first = table.first_state(machine);
  log.add({change.step, kNoLink, row.mat_a, row.mat_c, machine, change.of_states.from - first,
           change.of_states.to - first, change.of_states.quantity, change.of_states.value, energy});
  return energy;
}

/// The change of a bend in this step; nullptr: none.
const BendArray::Change* BendArray::change_of(const Row& row) const noexcept {
  if (row.state_row == kNoRow) return nullptr;
  const std::uint32_t change = change_of_row_[row.state_row];
  return change == kNoChange ? nullptr : &changes_[change];
}

/// In the step that enters a state, laws see no speed.
BendArray::PartOfLaws BendArray::add_laws(const StateTable& table, const Row& row, const Vec3& bend,
                                          const Vec3& moved, const Vec3& moved_then) noexcept {
  PartOfLaws part{Vec3::Zero(), Vec3::Zero(), 0.0};
  double* const last = law_moment_.data() + 3 * std::size_t{row.state_row};
  if (row.has_law) {
    BendOfLaw seen = bend_of_law(bend, moved / dt_, dimension_);
    if (change_of(row) != nullptr) seen.speed = 0.0;
    const LawsOfBend laws = laws_of_bend(table.state(states_.state_index(row.state_row)));
    const MomentOfLaws moment = moment_of_laws(laws, seen, table.variables().data());
    part.elastic = moment.elastic * seen.direction;
    part.viscous = moment.viscous * seen.direction;
  }
  part.work = 0.5 * (dot(part.elastic, moved) + dot(last_law_moment(row), moved_then));
  std::copy_n(part.elastic.data(), 3, last);
  return part;
}

StepEnergy BendArray::add_bend(const StateTable& table, std::size_t bend_index,
                               const ForceColumns& columns) noexcept {
  const Row& row = rows_[bend_index];
  const auto bend_in = [&](const BendShape& shape, const double* from) {
    return shape(column(from, row.mat_a), column(from, row.mat_b), column(from, row.mat_c));
  };
  const Vec3 bend = bend_in(row.shape, columns.position);
  const Vec3 before = bend_in(row.shape, columns.delayed);
  const Vec3 moved = bend - before;
  const bool has_states = row.state_row != kNoRow;
  Vec3 moment = row.stiffness * bend;
  const bool may_have_law = has_states && !law_moment_.empty();
  PartOfLaws of_laws{Vec3::Zero(), Vec3::Zero(), 0.0};
  StepEnergy work;
  if (const LinearLaw* const last = last_law_of(row)) {
    // The force of the last step, of the law then, has done the first half of the way.
    const Vec3 was = bend_in(last->shape, columns.delayed);
    const Vec3 moved_then = bend_in(last->shape, columns.position) - was;
    work.elastic = 0.5 * (dot(moment, moved) + last->stiffness * dot(was, moved_then));
    if (may_have_law) of_laws = add_laws(table, row, bend, moved, moved_then);
    work.dissipated = 0.5 * dot(last_viscous_moment(bend_index), moved_then);
    const bool enters_state = change_of(row) != nullptr;
    Vec3 viscous = enters_state ? Vec3(Vec3::Zero()) : viscous_moment(row, bend, moved);
    if (may_have_law) viscous += of_laws.viscous;
    std::copy_n(viscous.data(), 3, viscous_moment_.data() + 3 * bend_index);
    if (!enters_state) {
      work.dissipated += 0.5 * dot(viscous, moved);
      moment += viscous;
    }
  } else {
    work.elastic = 0.5 * row.stiffness * dot(bend + before, moved);
    if (may_have_law) of_laws = add_laws(table, row, bend, moved, moved);
    if (row.viscosity_over_dt > 0.0 || has_states) {
      Vec3 viscous = viscous_moment(row, bend, moved);
      if (may_have_law) viscous += of_laws.viscous;
      work.dissipated = 0.5 * dot(viscous + last_viscous_moment(bend_index), moved);
      std::copy_n(viscous.data(), 3, viscous_moment_.data() + 3 * bend_index);
      moment += viscous;
    }
  }
  if (may_have_law) {
    moment += of_laws.elastic;
    work.elastic += of_laws.work;
  }
  if (has_states) {
    states_.set_moment(row.state_row, moment_about_middle(with_states_[row.state_row], dimension_,
                                                          sides_of(row, columns), moment));
  }
  add_moment(row, moment, columns.force);
  return work;
}

StepEnergy BendArray::add_forces(const StateTable& table, const ForceColumns& columns,
                                 ThreadTeam& team) noexcept {
  if (rows_.empty()) return {};
  CORDIS_ASSERT(columns.axis_stride == 1);
  groups_.run(team, [&](std::size_t group) noexcept {
    StepEnergy work;
    for (std::size_t place = order_.first[group]; place < order_.first[group + 1]; ++place)
      work += add_bend(table, order_.links[place], columns);
    works_[group] = work;
  });
  StepEnergy sum;
  for (const StepEnergy& work : works_) sum += work;
  return sum;
}

StepEnergy BendArray::work_since_last_call(const MatArray& mats) const noexcept {
  CORDIS_ASSERT(rows_.empty() || !mats.layout().is_by_axis());
  StepEnergy work;
  for (std::size_t l = 0; l < rows_.size(); ++l) {
    const Row& row = rows_[l];
    const Vec3 before = row.shape(mats.delayed_at_rest(row.mat_a), mats.delayed_at_rest(row.mat_b),
                                  mats.delayed_at_rest(row.mat_c));
    const Vec3 moved =
        row.shape(mats.position(row.mat_a), mats.position(row.mat_b), mats.position(row.mat_c)) -
        before;
    work.elastic += 0.5 * row.stiffness * dot(before, moved);
    if (row.has_law) work.elastic += 0.5 * dot(last_law_moment(row), moved);
    work.dissipated += 0.5 * dot(last_viscous_moment(l), moved);
  }
  return work;
}

void BendArray::add_viscous_forces(AlignedVector<double>& force) const noexcept {
  for (std::size_t l = 0; l < rows_.size(); ++l)
    add_moment(rows_[l], last_viscous_moment(l), force.data());
}

double BendArray::potential_energy(const StateTable& table, const MatArray& mats) const noexcept {
  CORDIS_ASSERT(rows_.empty() || !mats.layout().is_by_axis());
  double sum = 0.0;
  double of_laws = 0.0;
  for (const Row& row : rows_) {
    const Vec3 bend =
        row.shape(mats.position_of_forces(row.mat_a), mats.position_of_forces(row.mat_b),
                  mats.position_of_forces(row.mat_c));
    sum += row.stiffness * dot(bend, bend);
    if (!row.has_law) continue;
    of_laws += engine::energy_of_law(laws_of_bend(table.state(states_.state_index(row.state_row))),
                                     bend_of_law(bend, Vec3::Zero(), dimension_),
                                     table.variables().data());
  }
  return 0.5 * sum + of_laws;
}

void BendArray::forget_viscous_forces() noexcept {
  std::fill(viscous_moment_.begin(), viscous_moment_.end(), 0.0);
}

void BendArray::forget_moments() noexcept {
  for (std::uint32_t r = 0; r < bend_of_row_.size(); ++r) states_.set_moment(r, 0.0);
}

void BendArray::force_state(const StateTable& table, std::uint32_t bend,
                            std::uint32_t state) noexcept {
  CORDIS_ASSERT(bend < rows_.size() && rows_[bend].state_row != kNoRow);
  states_.force_state(table, rows_[bend].state_row, state);
}

void BendArray::serialize(Archive& archive, const StateTable& table) {
  archive.reals(viscous_moment_);
  archive.reals(law_moment_);
  if (!bend_of_row_.empty()) states_.serialize(archive, table);
  if (!archive.restores()) return;
  for (std::size_t l = 0; l < rows_.size(); ++l) {  // the viscosity may have been taken away
    const Row& row = rows_[l];
    if (row.viscosity_over_dt == 0.0 && row.state_row == kNoRow)
      std::fill_n(viscous_moment_.data() + 3 * l, 3, 0.0);
  }
  // The variables are not restored yet.
  for (const std::uint32_t bend : bend_of_row_) put_state_at_rest_angle(table, rows_[bend]);
}

}  // namespace cordis::engine
