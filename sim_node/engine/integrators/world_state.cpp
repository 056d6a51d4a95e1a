// sim_node/engine/integrators/world_state.cpp
#include "sim_node/engine/integrators/world_state.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "node/assert.h"
#include "sim_node/engine/links/link_runs.h"

namespace cordis::engine {
namespace {

constexpr std::size_t kMinEventRoom = 1024;
constexpr const char* kNotOfThisState =
    "the snapshot is cut short, too long, or holds a count that does not fit";

std::shared_ptr<const Network> require(std::shared_ptr<const Network> network) {
  if (!network) throw std::invalid_argument("a world needs a network");
  return network;
}

VectorWidth require(VectorWidth width) {
  const std::vector<VectorWidth> supported = supported_vector_widths();
  if (std::find(supported.begin(), supported.end(), width) == supported.end()) {
    throw std::invalid_argument(std::string("this processor does not run ") + to_string(width));
  }
  return width;
}

/// Linear links, less the ones that `modal` takes as modes.
SpringDamperArray stepped_links(const NetworkDescription& network, const MatLayout& layout,
                                const MatBlocks& blocks) {
  constexpr auto kAlong = SpringDamperArray::Kind::kAlong;
  if (network.integrator != IntegratorKind::kModal) return {network, kAlong, layout, blocks};
  NetworkDescription stepped = network;
  std::erase_if(stepped.links, [&network](const Link& link) {
    return network.mats[link.mat_a].kind != MatKind::kPort &&
           network.mats[link.mat_b].kind != MatKind::kPort;
  });
  return {stepped, kAlong, layout, blocks};
}

/// The state machines of a snapshot: those of the network unless one has been replaced.
const std::vector<StateMachine>& state_machines_of(const Snapshot& snapshot,
                                                   const NetworkDescription& network) {
  const std::vector<StateMachine>& own = network.state_machines;
  const std::vector<StateMachine>& saved = snapshot.state_machines;
  if (saved.empty()) return own;
  const auto fit = [](const StateMachine& first, const StateMachine& second) {
    return first.states.size() == second.states.size() && rubs(first) == rubs(second);
  };
  if (!std::equal(own.begin(), own.end(), saved.begin(), saved.end(), fit)) {
    throw std::invalid_argument("the snapshot has other state machines than the network");
  }
  for (std::size_t i = 0; i < saved.size(); ++i) {
    check_state_machine(saved[i], "state machine " + std::to_string(i) + " of the snapshot",
                        network.variables.size());
  }
  return saved;
}

}  // namespace

WorldState::WorldState(std::shared_ptr<const Network> network_of_world, VectorWidth width_of_step)
    : network(require(std::move(network_of_world))),
      width(require(width_of_step)),
      team(std::make_shared<ThreadTeam>(1)),
      kernel(step_kernel(width)),
      state_machines(state_kernel(width)),
      blocks(description()),
      mats(description(), layout_of(description()), blocks),
      positions(mats.position()),
      links(stepped_links(description(), mats.layout(), blocks)),
      vector_springs(description(), SpringDamperArray::Kind::kVectorSpring, mats.layout(), blocks),
      table(make_table(description().state_machines)),
      state_links(description(), table, blocks),
      maxwell_links(description(), table, blocks),
      bends(description(), table, blocks),
      sets(description(), table, pair_kernel(width)),
      log(table,
          std::max(kMinEventRoom, description().state_links.size() + description().bends.size())),
      port_inputs(description()),
      freezing(description().freeze_tolerance > 0.0 ? std::make_unique<Freezing>(description())
                                                    : nullptr),
      scheme(make_integrator(description())),
      laws_ask_for_variables(
          std::ranges::any_of(description().state_machines, laws_ask_for_variable)),
      drives_ask_for_variables(std::ranges::any_of(
          description().time_functions,
          [](const TimeFunction& function) { return asks_for_variable(function); })) {}

StateTable WorldState::make_table(std::vector<StateMachine> from) const {
  const IntegratorKind integrator = description().integrator;
  const bool whole_steps =
      integrator != IntegratorKind::kCordis && integrator != IntegratorKind::kModal;
  return StateTable(std::move(from), network->step(), whole_steps, description().variables.size());
}

StepReport WorldState::step() noexcept {
  StepReport report;
  report.refused_inputs = port_inputs.take_refused();
  if (laws_ask_for_variables) report.refused_parameters = table.failed_parameters();
  log.begin_step();
  find_driven_forces();
  sets.forget_partners();
  const Moved moved = scheme->step(*this);
  std::construct_at(&positions, mats.position());
  account.add(moved.energy);
  ++step_count;
  report.refused_drives = port_inputs.take_refused_drives();
  report.drive_jumps = port_inputs.take_drive_jumps();
  report.non_finite_mats = moved.non_finite_mats;
  report.has_energy = account.is_bounded();
  report.overflowed_sets = sets.overflowed_count();
  report.forgotten_pairs = sets.forgotten_count();
  report.wants_room = sets.want_room(mats.force_columns().position);
  report.lost_events = log.lost();
  return report;
}

void WorldState::find_driven_forces() noexcept {
  for (std::size_t i = 0; i < port_inputs.placed_count(); ++i) {
    const std::uint32_t mat = port_inputs.placed_mat(i);
    port_inputs.set_motion(i, mats.position(mat), scheme->velocity(*this, mat));
  }
  port_inputs.find_driven_forces(step_count, table.variables().data());
}

void WorldState::add_frozen_forces(const ForceColumns& columns) noexcept {
  links.add_forces(kernel, columns, *team);
  vector_springs.add_forces(kernel, columns, *team);
  state_links.add_forces_before_start(state_machines, table, columns);
  maxwell_links.add_held_forces(state_machines, columns);
  bends.add_forces(table, columns, *team);
  sets.add_forces(pair_step(true), columns, team.get());
}

void WorldState::start_one_period_ago() noexcept {
  ForceColumns one_period_ago = mats.force_columns();
  one_period_ago.position = one_period_ago.delayed;
  maxwell_links.go_back(mats);
  add_frozen_forces(one_period_ago);
  port_inputs.start(mats);
  mats.clear_forces(*team);
  links.start();
  vector_springs.start();
  bends.forget_viscous_forces();
  bends.forget_moments();
  state_links.forget_tensions();
}

double WorldState::stored_energy() noexcept {
  return links.stored_energy(mats) + state_links.stored_energy(table, mats) +
         maxwell_links.stored_energy() + bends.potential_energy(table, mats) +
         sets.stored_energy(table);
}

double WorldState::potential_energy() noexcept {
  return links.potential_energy(mats) + vector_springs.potential_energy(mats) +
         state_links.stored_energy(table, mats) + maxwell_links.stored_energy() +
         bends.potential_energy(table, mats) + sets.stored_energy(table);
}

StepEnergy WorldState::work_since_last_call() const noexcept {
  StepEnergy work = links.work_since_last_call(mats);
  work += vector_springs.work_since_last_call(mats);
  work += state_links.work_since_last_call(mats);
  work += maxwell_links.work_since_last_call(mats);
  work += bends.work_since_last_call(mats);
  work += sets.work_since_last_call(mats);
  return work;
}

void WorldState::find_viscous_forces(AlignedVector<double>& force) const noexcept {
  std::fill(force.begin(), force.end(), 0.0);
  state_links.add_viscous_forces(mats, force);
  bends.add_viscous_forces(force);
  sets.add_viscous_forces(force);
}

StepEnergy WorldState::begin_forces(const ForceColumns& columns) noexcept {
  if (!freezing) {
    mats.clear_forces(*team);
    return {};
  }
  const StepEnergy energy = sets.take_positions(columns);
  freezing->choose_liaisons(*this, sets.refresh());
  return energy;
}

StepEnergy WorldState::add_maxwell_forces(const ForceColumns& columns) noexcept {
  if (step_count == 0) return maxwell_links.add_first_forces(state_machines, columns);
  const double switching = maxwell_links.follow(table, columns);
  StepEnergy work = maxwell_links.add_forces(state_machines, columns, *team);
  work.switching += switching;
  return work;
}

void WorldState::take_parameters() noexcept {
  table.find_parameters();
  bends.take_parameters(table);
  maxwell_links.take_parameters(table);
}

StepEnergy WorldState::add_set_forces(const ForceColumns& columns) noexcept {
  if (sets.empty()) return {};
  return freezing ? sets.add_pair_forces(pair_step(false), columns)
                  : sets.add_forces(pair_step(false), columns, team.get());
}

void WorldState::add_forces_at_half_step(StepEnergy& energy) noexcept {
  const ForceColumns columns = mats.force_columns();
  energy += links.add_forces(kernel, columns, *team);
  energy += vector_springs.add_forces(kernel, columns, *team);
  energy += add_explicit_forces(columns);
  if (freezing) freezing->restore_forces(mats);
}

StepEnergy WorldState::add_explicit_forces(const ForceColumns& columns) noexcept {
  StepEnergy work;
  if (!state_links.empty()) {
    work += state_links.add_forces(state_machines, table, columns, step_count, log, *team);
  }
  work += add_maxwell_forces(columns);
  work += bends.add_forces(state_machines, table, columns, step_count, log, *team);
  work += add_set_forces(columns);
  return work;
}

double WorldState::add_forces_to_solve_on(StepEnergy& energy) noexcept {
  CORDIS_ASSERT(!freezing);
  const ForceColumns columns = mats.force_columns();
  mats.clear_forces(*team);
  StepEnergy of_solved = links.add_forces_at_full_step(kernel, columns, *team);
  of_solved += vector_springs.add_forces_at_full_step(kernel, columns, *team);
  if (step_count == 0) maxwell_links.go_back(mats);
  const StepEnergy of_others = add_explicit_forces(columns);
  energy.switching += of_others.switching;
  if (step_count > 0) energy.dissipated += of_others.dissipated;
  return 0.5 * of_solved.dissipated;
}

double WorldState::add_forces_at_full_step(const double* extrapolated_positions,
                                           StepEnergy& energy) noexcept {
  const ForceColumns as_it_moved = mats.force_columns();
  ForceColumns extrapolated = as_it_moved;
  extrapolated.delayed = extrapolated_positions;
  sets.start();
  const StepEnergy of_last_sets = begin_forces(extrapolated);

  StepEnergy of_links = links.add_forces_at_full_step(kernel, extrapolated, *team);
  of_links += vector_springs.add_forces_at_full_step(kernel, extrapolated, *team);
  of_links.dissipated *= 0.5;
  // Half the work of the viscous forces of this step is returned: those of the last are forgotten.
  if (!state_links.empty()) {
    state_links.forget_viscous_forces();
    of_links += state_links.add_forces(state_machines, table, extrapolated, step_count, log, *team);
  }
  if (step_count == 0) maxwell_links.go_back(mats);
  const StepEnergy of_maxwell = add_maxwell_forces(as_it_moved);
  energy.switching += of_maxwell.switching;
  // The account begins at the moment of step 0.
  if (step_count > 0) energy.dissipated += of_maxwell.dissipated;
  bends.forget_viscous_forces();
  of_links += bends.add_forces(state_machines, table, extrapolated, step_count, log, *team);
  of_links += of_last_sets;
  of_links += add_set_forces(extrapolated);
  if (freezing) freezing->restore_forces(mats);
  energy.switching += of_links.switching;
  return of_links.dissipated;
}

void WorldState::replace_state_machine(std::uint32_t index, const StateMachine& state_machine) {
  if (index >= table.state_machines().size()) {
    throw std::invalid_argument("state machine " + std::to_string(index) + " does not exist");
  }
  check_state_machine(state_machine, "state machine " + std::to_string(index),
                      description().variables.size());
  if (state_machine.states.size() != table.state_machines()[index].states.size()) {
    throw std::invalid_argument("a state machine is replaced by one of as many states");
  }
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    if (!std::isfinite(state_machine.states[s].viscosity / network->step()) ||
        !std::isfinite(friction_in(state_machine, s).viscosity / network->step())) {
      throw std::invalid_argument("a viscosity is too large for the step");
    }
  }
  const auto is_of_it = [index](const Bend& bend) { return bend.state_machine == index; };
  if (std::ranges::any_of(description().bends, is_of_it) &&
      refused_in_bends(state_machine) != nullptr) {
    throw std::invalid_argument(
        "a bend has laws of an angle without limits in each state, no more");
  }
  if (std::ranges::any_of(description().bends, is_of_it) &&
      has_laws_of_bends(state_machine) != has_laws_of_bends(table.state_machines()[index])) {
    throw std::invalid_argument("the laws of a bend neither come nor go");
  }
  const auto takes_from_it = [index](const MaxwellLink& link) {
    return link.state_machine == index;
  };
  if (std::ranges::any_of(description().maxwell_links, takes_from_it) &&
      !fits_maxwell_element(state_machine)) {
    throw std::invalid_argument("a Maxwell element has a stiffness and a viscosity, no more");
  }
  if (rubs(state_machine) != rubs(table.state_machines()[index])) {
    throw std::invalid_argument("friction neither comes nor goes");
  }
  const double before = stored_energy();
  table.replace(index, state_machine);
  state_links.adopt(table);
  bends.adopt(table);
  maxwell_links.take_parameters(table);
  sets.adopt(table);
  if (freezing) freezing->adopt(description(), table.state_machines());
  StepEnergy change;
  change.switching = stored_energy() - before;
  account.add(change);
  scheme->adopt(*this);
  sets.make_room(mats.force_columns().position);
  replaced = true;
}

Archive WorldState::serialize(Archive archive, bool with_variables) {
  archive.hash(step_count);
  mats.serialize(archive);
  links.serialize(archive);
  vector_springs.serialize(archive);
  state_links.serialize(archive, table);
  maxwell_links.serialize(archive);
  bends.serialize(archive, table);
  log.serialize(archive);
  if (with_variables) archive.reals(table.variables());
  account.serialize(archive);
  if (archive.hashes()) sets.serialize(archive, table);  // a hash takes the sets first, a row last
  scheme->serialize(archive);
  if (freezing) freezing->serialize(archive);
  if (!archive.hashes()) sets.serialize(archive, table);
  port_inputs.serialize(archive);
  return archive;
}

void WorldState::take(std::span<const double> row, bool with_variables) {
  CORDIS_ASSERT(matches(row, with_variables));
  serialize(Archive::restoring(row), with_variables);
  if (laws_ask_for_variables) take_parameters();
  scheme->restored(*this);
  if (freezing) freezing->restored(port_inputs);
  sets.make_room(mats.force_columns().position);
}

void WorldState::swap_table(StateTable& other, StateLinkArray& links_of_other,
                            BendArray& bends_of_other) {
  std::swap(table, other);
  std::swap(state_links, links_of_other);
  std::swap(bends, bends_of_other);
  sets.adopt(table);
}

void WorldState::restore(const Snapshot& snapshot) {
  if (snapshot.network != network->fingerprint()) {
    throw std::invalid_argument("the snapshot is of another network");
  }
  sets.make_room_of(snapshot.state.size());
  if (!snapshot.state_machines.empty() || replaced) {
    restore_with_table(snapshot);
  } else if (matches(snapshot.state)) {
    take(snapshot.state);
  } else {
    throw std::invalid_argument(kNotOfThisState);
  }
  step_count = snapshot.step;
  replaced = !snapshot.state_machines.empty();
}

void WorldState::restore_with_table(const Snapshot& snapshot) {
  StateTable table_of_snapshot = make_table(state_machines_of(snapshot, description()));
  StateLinkArray links_of_snapshot(description(), table_of_snapshot, blocks);
  BendArray bends_of_snapshot(description(), table_of_snapshot, blocks);
  std::vector<double> own_sets;
  Archive saving = Archive::saving(own_sets);
  sets.serialize(saving, table);
  swap_table(table_of_snapshot, links_of_snapshot, bends_of_snapshot);
  if (!matches(snapshot.state)) {
    swap_table(table_of_snapshot, links_of_snapshot, bends_of_snapshot);
    Archive restoring = Archive::restoring(own_sets);
    sets.serialize(restoring, table);
    if (freezing) freezing->restored(port_inputs);
    throw std::invalid_argument(kNotOfThisState);
  }
  if (freezing) freezing->adopt(description(), table.state_machines());
  take(snapshot.state);
}

}  // namespace cordis::engine
