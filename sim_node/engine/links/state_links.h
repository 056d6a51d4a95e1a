// sim_node/engine/links/state_links.h -- the links with states of a world.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/event_log.h"
#include "sim_node/engine/links/link_groups.h"
#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/links/state_table.h"
#include "sim_node/engine/matter/energy_account.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/mat_roles.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// State links: positions in; exits tested, states changed, opposite forces out.
/// [Luc90 III.2.3 b formalism to modify the liaison]
class StateLinkArray {
 public:
  StateLinkArray(const NetworkDescription& description, const StateTable& table,
                 const MatBlocks& blocks);

  bool empty() const noexcept { return rows_.count() == 0; }

  /// Adds the forces of all links in their present states, without testing an exit: before step 0.
  void add_forces_before_start(const StateKernel& kernel, const StateTable& table,
                               const ForceColumns& columns) noexcept;
  /// Forgets tensions and viscous forces: those before step 0 take no work.
  void start() noexcept;
  /// Forgets the tensions of the last call.
  void forget_tensions() noexcept;
  /// Forgets the viscous forces of the last call.
  void forget_viscous_forces() noexcept;

  /// One step: exits, changes of state, then the force of every link on its two MATs, group by group of the
  /// MatBlocks, which the members of the team share, and within a group in link order. Enters the
  /// changes in the log, in link order. Real time: O(links), no allocation.
  /// @return elastic, dissipated and switched energy, as EnergyAccount counts them.
  StepEnergy add_forces(const StateKernel& kernel, const StateTable& table,
                        const ForceColumns& columns, std::uint64_t step, EventLog& log,
                        ThreadTeam& team) noexcept;

  /// As those of SpringDamperArray. Links of a state machine whose conditions may come true while
  /// both ends rest are always computed: their masses get kWholeForce.
  /// @param never_rests  by state machine
  void mark_neighbours(const WakePropagation& pass, const std::vector<bool>& never_rests,
                       MatRoles& roles) const noexcept;
  void choose_active(MatRoles& roles) noexcept;

  /// Works of the forces of the last call up to the present positions. Real time: O(links), no
  /// allocation.
  StepEnergy work_since_last_call(const MatArray& mats) const noexcept;
  /// Adds the part of the forces of the last call that stores no energy to `force`, 4 x N [N].
  /// Precondition: the MATs have not moved since. Real time: O(links), no allocation.
  void add_viscous_forces(const MatArray& mats, AlignedVector<double>& force) const noexcept;
  /// Potential energy [J] of the links at the positions of the last call, in closed form.
  double stored_energy(const StateTable& table, const MatArray& mats) const noexcept;

  void force_state(const StateTable& table, std::uint32_t link, std::uint32_t state) noexcept;
  /// Fits what the links remember to a table that has been changed. Allocates.
  void adopt(const StateTable& table);

  std::uint32_t state_of(const StateTable& table, std::uint32_t link) const noexcept;
  double rest_length(std::uint32_t link) const noexcept { return rest_length_[row_of(link)]; }
  double tension(std::uint32_t link) const noexcept { return tension_[row_of(link)]; }
  /// Since the state was entered, before a step [s].
  double age(std::uint32_t link, std::uint64_t step) const noexcept {
    return (static_cast<double>(step) - entered_[row_of(link)]) * dt_;
  }
  StateIndex state_index(std::uint32_t link) const noexcept { return state_[row_of(link)]; }
  /// True if a change of state has happened in this step, which is not the first.
  bool is_new(std::uint32_t link, std::uint64_t step) const noexcept {
    return step > 0 && entered_[row_of(link)] == static_cast<double>(step);
  }
  /// The tension of this step is another one; its force has been put on the MATs.
  void set_tension(std::uint32_t link, double tension) noexcept {
    const std::uint32_t row = row_of(link);
    impulse_[row] += (tension - tension_[row]) * dt_;
    tension_[row] = tension;
  }
  /// The part of the tension of this step that stores no energy is another one. @param length  of the link [m]
  void set_viscous_tension(std::uint32_t link, double tension, double length) noexcept {
    viscous_factor_[row_of(link)] = is_1d_ ? tension : tension / length;
  }

  void serialize(Archive& archive, const StateTable& table);

 private:
  std::uint32_t row_of(std::uint32_t link) const noexcept { return rows_.row_of_link[link]; }
  std::size_t step_rows(const StateKernel& kernel, const StateTable& table,
                        const ForceColumns& columns, std::uint64_t step,
                        const ActiveLinks::Run& run, LinkEvent* changes, LinkWork& work) noexcept;
  double enter_changes(EventLog& log, double energy) noexcept;
  StateLinkRows rows(const StateTable& table, const ActiveLinks::Run& run) noexcept;
  /// What the change of variables that laws ask for has brought into the links [J]. Real time: O(links that ask).
  double parameter_energy(const StateTable& table, const ForceColumns& columns) const noexcept;
  double distance_at_last_call(const MatArray& mats, std::size_t row) const noexcept;

  bool is_1d_;                             // 1 dimension
  bool freezes_;                           // only some links are computed
  double dt_;                              // [s]
  double rate_;                            // 1 / dt [1/s]
  AlignedVector<std::uint32_t> column_a_;  // 4 * MAT index
  AlignedVector<std::uint32_t> column_b_;  // all arrays: one value per row
  GroupedRows rows_;
  LinkGroups groups_;
  std::vector<std::size_t> change_counts_;  // of each group in this step
  AlignedVector<double> mass_a_;            // [kg], 0 unless a mass
  AlignedVector<double> mass_b_;
  AlignedVector<std::uint32_t> state_machine_;
  AlignedVector<StateIndex> state_;
  AlignedVector<double> rest_length_;  // [m]
  AlignedVector<double> tension_;      // [N]
  AlignedVector<double> impulse_;      // [N s]
  AlignedVector<double> entered_;      // step count
  AlignedVector<std::uint32_t> forced_;
  AlignedVector<double> elastic_factor_;  // [N/m]; in 1 dimension the elastic tension itself [N]
  AlignedVector<double> viscous_factor_;  // the rest, likewise
  AlignedVector<double> memory_;          // slot_count_ x 8 values for each batch
  std::size_t slot_count_ = 0;
  bool any_forced_ = false;
  bool needs_impulse_ = false;  // some program of the table does
  bool needs_age_ = false;
  bool needs_velocity_ = false;
  std::vector<std::uint32_t>
      asking_;  // rows of links of a law that asks for variables, in some state
  ActiveLinks active_;
};

}  // namespace cordis::engine
