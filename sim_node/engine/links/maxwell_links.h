// sim_node/engine/links/maxwell_links.h -- the Maxwell elements of a world.
#pragma once

#include <cstdint>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/link_groups.h"
#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/links/state_table.h"
#include "sim_node/engine/matter/energy_account.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/mat_roles.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// 1 - e^(-x) for x >= 0, by + - * / alone: the same bits everywhere. Error below 4 units in the
/// last place.
double share_of_decay(double x) noexcept;

/// Maxwell elements: see MaxwellLink.
class MaxwellArray {
 public:
  MaxwellArray(const NetworkDescription& description, const StateTable& table,
               const MatBlocks& blocks);

  /// Fits the elements that follow variables to the present parameters of the table: what they were before
  /// counts no longer. Real time: O(such elements), no allocation.
  void take_parameters(const StateTable& table) noexcept;
  /// Before the first step, once the parameters are known.
  void begin() noexcept;
  /// Takes them to the parameters of this step, before its forces. Real time: O(such elements), no allocation.
  /// @return energy that these have brought into the springs [J]
  [[nodiscard]] double follow(const StateTable& table, const ForceColumns& columns) noexcept;

  /// Adds the force of every element to its two MATs, in the order of SpringDamperArray::add_forces, shared
  /// likewise. Real time: O(elements), no allocation.
  /// @return stored and dissipated energy, as EnergyAccount counts them.
  StepEnergy add_forces(const StateKernel& kernel, const ForceColumns& columns,
                        ThreadTeam& team) noexcept;

  /// Adds the stored forces unchanged, however far the MATs have moved.
  StepEnergy add_held_forces(const StateKernel& kernel, const ForceColumns& columns) noexcept;
  /// Makes of the start forces those of one period before: less the growth that the masses, which
  /// have not moved yet, would have made of their delayed positions.
  void go_back(const MatArray& mats) noexcept;
  /// Adds the forces of step 0, without a decay: after go_back() they are the start forces and the
  /// change by moved ports.
  StepEnergy add_first_forces(const StateKernel& kernel, const ForceColumns& columns) noexcept;

  /// As that of SpringDamperArray. All are computed in every step, since their forces fade while
  /// nothing moves: of their ends the whole force is needed.
  void mark_neighbours(const WakePropagation& pass, MatRoles& roles) const noexcept;

  /// Work of the forces of the last call up to the present positions. Real time: O(elements), no
  /// allocation.
  StepEnergy work_since_last_call(const MatArray& mats) const noexcept;
  /// Tension of an element at the last call, before the first one that of its start [N]; above 0 it pulls.
  double tension(std::uint32_t element) const noexcept {
    CORDIS_ASSERT(element < rows_.row_of_link.size());
    return tension_[rows_.row_of_link[element]];
  }
  /// Energy in the springs of the elements at the last call [J].
  double stored_energy() const noexcept;

  void serialize(Archive& archive);

 private:
  /// An element whose parameters follow variables.
  struct Following {
    std::uint32_t row = 0;
    std::uint32_t state_machine = 0;
    double stiffness = 0.0;  // of the last call [N/m]
    double rate = 0.0;       // K / Z of the last call [1/s]
  };
  static double stiffness_in(const Following& element, const StateTable& table) noexcept;
  static double rate_in(const Following& element, const StateTable& table) noexcept;
  double elongation_increment(std::uint32_t row, const ForceColumns& columns) const noexcept;
  /// @param rate  K / Z [1/s]
  void put(std::uint32_t row, double stiffness, double rate) noexcept;
  MaxwellRows rows(std::size_t first, std::size_t count) noexcept;
  StepEnergy add_undecayed(const StateKernel& kernel, const ForceColumns& columns,
                           bool grows) noexcept;

  bool is_1d_;                             // 1 dimension
  double dt_;                              // [s]
  AlignedVector<std::uint32_t> column_a_;  // 4 * MAT index
  AlignedVector<std::uint32_t> column_b_;  // all arrays: one value per row
  GroupedRows rows_;
  LinkGroups groups_;
  AlignedVector<double> velocity_retention_;  // e^(-K dt / Z)
  AlignedVector<double> gain_;                // Z (1 - e^(-K dt / Z)) / dt [N/m]
  AlignedVector<double> compliance_;          // 1 / K [m/N]
  AlignedVector<double> tension_;             // F(n) [N]
  AlignedVector<double> factor_;      // force of the last call = factor * vector from a to b
  std::vector<Following> following_;  // in the order of the elements
};

}  // namespace cordis::engine
