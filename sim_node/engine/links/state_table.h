// sim_node/engine/links/state_table.h -- the state machines of a network, made ready for stepping.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/engine/links/state_kernel.h"

namespace cordis::engine {

/// Masses of the ends of a link [kg]; 0 unless a mass.
struct EndMasses {
  double a = 0.0;
  double b = 0.0;
};

/// All states of all state machines in one row, in order: StateIndex of state s of state machine b
/// is first_state(b) + s. After the last stands a state of no force and no exit, for padding.
class StateTable {
 public:
  /// Precondition: check_state_machine has passed all of them.
  /// @param whole_steps  the account of the world belongs to the moments x(n), not to the middles
  ///                     between them
  /// @param variable_count  how many variables of the network conditions may ask for
  StateTable(std::vector<StateMachine> state_machines, double dt, bool whole_steps = false,
             std::size_t variable_count = 0);
  ~StateTable();
  StateTable(StateTable&&) noexcept;
  StateTable& operator=(StateTable&&) noexcept;

  const StateTerm* terms() const noexcept;
  /// The values of the variables that conditions and laws see, one for all links; 0 at first.
  std::span<double> variables() noexcept;
  std::span<const double> variables() const noexcept;
  /// What they were as they were kept.
  std::span<const double> variables_before() const noexcept;
  /// Keeps these values as those of before, for parameter_energy(), and the parameters that follow them.
  void keep_variables() noexcept;
  /// Finds the parameters that follow variables, once these have changed. Real time: O(such parameters), no
  /// allocation.
  void find_parameters() noexcept;
  /// How many parts of formulas of variables are no finite numbers. Real time: O(instructions of those that may be
  /// so), no allocation.
  std::uint32_t failed_parameters() const noexcept;
  /// True if the elasticity of a state, or its rest angle, follows a variable.
  bool asks_for_variable(StateIndex state) const noexcept;
  /// Present parameters of a state: the numbers that stand in it, and the factors that follow variables.
  double stiffness(StateIndex state) const noexcept;  ///< [N/m], of a bend [N m/rad]
  double viscosity(StateIndex state) const noexcept;  ///< [N s/m], of a bend [N m s/rad]
  /// What stiffness() was before the variables were kept.
  double stiffness_before(StateIndex state) const noexcept;
  double dt() const noexcept;  ///< [s]
  /// Rest angle that follows variables [rad]; nothing without one, or while it is not finite.
  std::optional<double> rest_angle(StateIndex state) const noexcept;
  /// The friction in a state.
  Friction friction(StateIndex state) const noexcept;
  /// True if a coefficient of it follows variables.
  bool friction_follows(StateIndex state) const noexcept;
  /// True if a state is a spring and a damper, whether K and Z follow variables or not.
  bool is_linear(StateIndex state) const noexcept;
  std::size_t state_count() const noexcept;  ///< without the padding
  StateIndex padding_state() const noexcept;
  StateIndex first_state(std::uint32_t state_machine) const noexcept;
  StateIndex start_state(std::uint32_t state_machine) const noexcept;
  std::uint32_t state_machine_of(StateIndex state) const noexcept;
  /// True if the state is one of the state machine.
  bool has_state(std::uint32_t state_machine, StateIndex state) const noexcept {
    return state < state_count() && state_machine_of(state) == state_machine;
  }
  const std::vector<StateMachine>& state_machines() const noexcept;
  const LinkState& state(StateIndex state) const noexcept;

  /// True if a program of any state machine asks for the quantity.
  bool needs(Quantity quantity) const noexcept;
  std::uint32_t slot_count() const noexcept;  ///< one more than the largest slot used

  /// Energy [J] that a row stores in a state: closed form of the linear part and of the law, by
  /// quadrature of an expression at rest. In a state with a force
  /// limit, or that does not pull (push), it is the integral of the limited elastic tension.
  /// Lennard-Jones: 0 at its cutoff.
  double stored_energy(StateIndex state, double distance, double rest_length,
                       const EndMasses& mass) const noexcept;
  /// What a change adds to the stored energy as the account keeps it: after minus before. In the
  /// middle of the last period that is stored energy less half of the elastic work of the period.
  double change_energy(const StateMachineRows& rows, std::size_t row) const noexcept;
  /// What variables that are no longer as they were kept add to the stored energy, likewise.
  /// @param elongation_increment  of the row in this period [m]
  double parameter_energy(StateIndex state, double distance, double rest_length,
                          const EndMasses& mass, double elongation_increment) const noexcept;
  /// The condition's quantity of an exit; kNone when it was forced.
  Quantity triggered(StateIndex from, std::uint32_t exit) const noexcept;
  /// True if an exit leaves the rest length as it is, or the change was forced.
  bool keeps_rest(StateIndex from, std::uint32_t exit) const noexcept;
  /// Part of the elastic work of a period that the account enters after the step.
  double part_of_work() const noexcept;

  /// Gives a state machine other parameters. Allocates.
  /// Precondition: as many states as before, well-formed.
  void replace(std::uint32_t index, const StateMachine& state_machine);

 private:
  struct Content;
  struct Elastic;

  std::unique_ptr<Content> content_;
};

}  // namespace cordis::engine
