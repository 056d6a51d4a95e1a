// sim_node/engine/integrators/world_state.h -- what a world is made of, as those that move it see
// it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/description/world_records.h"
#include "sim_node/engine/integrators/freezing.h"
#include "sim_node/engine/integrators/integrator.h"
#include "sim_node/engine/links/bends.h"
#include "sim_node/engine/links/event_log.h"
#include "sim_node/engine/links/maxwell_links.h"
#include "sim_node/engine/links/spring_damper.h"
#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/links/state_links.h"
#include "sim_node/engine/links/state_table.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/mat_blocks.h"
#include "sim_node/engine/matter/port_inputs.h"
#include "sim_node/engine/matter/step_kernel.h"
#include "sim_node/engine/pairs/set_liaisons.h"

namespace cordis::engine {

/// The parts of a World.
struct WorldState {
  /// @throws std::invalid_argument without a network, or when the processor lacks the vector
  /// instructions.
  WorldState(std::shared_ptr<const Network> network_of_world, VectorWidth width_of_step);

  const NetworkDescription& description() const noexcept { return network->description(); }
  StepReport step() noexcept;
  void restore(const Snapshot& snapshot);
  /// Restores a snapshot whose state machines, or the present ones, are not those of the network.
  void restore_with_table(const Snapshot& snapshot);
  void replace_state_machine(std::uint32_t index, const StateMachine& state_machine);

  /// Shows all parts but the network, the state machines and, except to a hash, the step count.
  /// Real time: O(MATs + links + pairs), no allocation, except when it saves. @return the archive
  /// @param with_variables  the variables of the network too
  Archive serialize(Archive archive, bool with_variables);
  /// Likewise with the variables where a law follows some.
  Archive serialize(Archive archive) { return serialize(archive, laws_ask_for_variables); }
  /// True if a row is of a state of this world.
  [[nodiscard]] bool matches(std::span<const double> row, bool with_variables) {
    return serialize(Archive::checking(row), with_variables).matches();
  }
  [[nodiscard]] bool matches(std::span<const double> row) {
    return matches(row, laws_ask_for_variables);
  }
  /// Restores it, with all that depends on it. Precondition: it matches.
  void take(std::span<const double> row, bool with_variables);
  void take(std::span<const double> row) { take(row, laws_ask_for_variables); }
  /// Fits all liaisons to the parameters that follow the variables of the table, between two steps.
  void take_parameters() noexcept;
  StateTable make_table(std::vector<StateMachine> state_machines) const;
  /// Exchanges the table and the links that belong to it with others; of the sets only what has
  /// states in both keeps them.
  void swap_table(StateTable& other, StateLinkArray& links_of_other, BendArray& bends_of_other);

  PairStep pair_step(bool frozen) noexcept {
    return {table, state_machines, log, step_count, frozen, !frozen};
  }
  /// Adds the forces of all liaisons as they are at the start, without testing an exit.
  void add_frozen_forces(const ForceColumns& columns) noexcept;
  /// Begins the account of ports and liaisons of `cordis` with the links as they were one period
  /// ago, when nothing is known to have moved.
  void start_one_period_ago() noexcept;
  /// Energy of all links where the last forces were computed, in closed form; no linear ones in 1
  /// dimension [J].
  double stored_energy() noexcept;
  /// Energy of all links, with the linear ones in every dimension [J].
  double potential_energy() noexcept;
  StepEnergy work_since_last_call() const noexcept;
  /// Finds the part of the last forces of links with states, bends and sets that stores no energy, 4 x N [N].
  /// Precondition: the MATs have not moved since.
  void find_viscous_forces(AlignedVector<double>& force) const noexcept;

  /// The forces of drives at the present step. Real time: O(drives), no allocation.
  void find_driven_forces() noexcept;
  /// Clears the forces. Of a world that freezes, ends the account of the last ones of the sets and
  /// chooses the liaisons that are computed. @return works [J]
  [[nodiscard]] StepEnergy begin_forces(const ForceColumns& columns) noexcept;
  /// Adds the forces of the Maxwell elements. @return works [J]
  StepEnergy add_maxwell_forces(const ForceColumns& columns) noexcept;
  /// Adds the forces of the sets after that.
  StepEnergy add_set_forces(const ForceColumns& columns) noexcept;
  /// Adds the forces of all liaisons as `cordis` does; enters what they take.
  void add_forces_at_half_step(StepEnergy& energy) noexcept;
  /// Clears the forces and adds those of all liaisons for an account that is kept at moments.
  /// Dampers and conditions see the velocity (position - extrapolated) / dt, Maxwell elements how
  /// the MATs have moved. Enters changes of state and what Maxwell elements have taken.
  /// @return half of what viscosity takes in a period at this moment [J]
  [[nodiscard]] double add_forces_at_full_step(const double* extrapolated,
                                               StepEnergy& energy) noexcept;
  /// Adds the forces of all that no matrix solves, as `cordis` does. @return works since the last call [J]
  StepEnergy add_explicit_forces(const ForceColumns& columns) noexcept;
  /// Clears the forces and adds those of all liaisons, where a matrix solves the linear ones on from here.
  /// Enters the works of the others since the last call, as `cordis` does. Precondition: it does not freeze.
  /// @return half of what linear links take in a period at this moment [J]
  [[nodiscard]] double add_forces_to_solve_on(StepEnergy& energy) noexcept;
  /// The account at the moment of the last forces. @param velocity_of  of a MAT at that moment
  template <class VelocityOf>
  Energy energy_at_full_step(VelocityOf velocity_of) noexcept {
    double kinetic = 0.0;
    for (std::uint32_t i = 0; i < mats.count(); ++i) {
      if (mats.is_mass(i))
        kinetic += 0.5 * description().mats[i].mass * velocity_of(i).squaredNorm();
    }
    return energy_at_full_step(kinetic);
  }
  /// The account at that moment, from the kinetic energy [J].
  Energy energy_at_full_step(double kinetic) noexcept {
    double gravity = 0.0;
    for (std::uint32_t i = 0; i < mats.count(); ++i) {
      if (!mats.is_mass(i)) continue;
      const Mat& mat = description().mats[i];
      gravity -= mat.mass * description().gravity_on(mat).dot(mats.position_of_forces(i));
    }
    return account.at_moment(kinetic, potential_energy(), gravity);
  }

  std::shared_ptr<const Network> network;
  VectorWidth width;
  std::shared_ptr<ThreadTeam> team;
  const StepKernel& kernel;
  const StateKernel& state_machines;
  MatBlocks blocks;
  MatArray mats;
  Columns positions;  // of mats, as of the last update_columns()
  SpringDamperArray links;
  SpringDamperArray vector_springs;
  StateTable table;
  StateLinkArray state_links;
  MaxwellArray maxwell_links;
  BendArray bends;
  SetLiaisons sets;
  EventLog log;
  PortInputs port_inputs;
  EnergyAccount account;
  std::unique_ptr<Freezing> freezing;  // none: every MAT is always awake
  std::unique_ptr<Integrator> scheme;
  std::uint64_t step_count = 0;
  bool replaced = false;                  // a state machine is no longer that of the network
  bool laws_ask_for_variables = false;    // a law of the network does
  bool drives_ask_for_variables = false;  // a drive does
};

}  // namespace cordis::engine
