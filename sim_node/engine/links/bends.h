// sim_node/engine/links/bends.h -- the liaisons of a world that resist bending.
#pragma once

#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/bend_moment.h"
#include "sim_node/engine/links/bend_shape.h"
#include "sim_node/engine/links/bend_states.h"
#include "sim_node/engine/links/event_log.h"
#include "sim_node/engine/links/link_groups.h"
#include "sim_node/engine/matter/energy_account.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// Three positions in, three forces out: see Bend. Computed one by one, with the same bits on every vector
/// width. Precondition of all calls: where there are bends, the MATs are stored by MAT.
class BendArray {
 public:
  BendArray(const NetworkDescription& description, const StateTable& table,
            const MatBlocks& blocks);

  /// Adds the forces of every bend to its three MATs in their present states, in the order of
  /// SpringDamperArray::add_forces, shared likewise.
  /// @return works [J] as SpringDamperArray::add_forces counts them in 3 dimensions
  /// Real time: O(bends), no allocation.
  StepEnergy add_forces(const StateTable& table, const ForceColumns& columns,
                        ThreadTeam& team) noexcept;
  /// Changes the states of a step first, and enters that in the log.
  StepEnergy add_forces(const StateKernel& kernel, const StateTable& table,
                        const ForceColumns& columns, std::uint64_t step, EventLog& log,
                        ThreadTeam& team) noexcept;
  /// Work of the forces of the last call up to the present positions [J]. Real time: O(bends), no allocation.
  StepEnergy work_since_last_call(const MatArray& mats) const noexcept;
  /// Adds the part of the forces of the last call that stores no energy to `force`, 4 x N [N]. Real time:
  /// O(bends), no allocation.
  void add_viscous_forces(AlignedVector<double>& force) const noexcept;
  /// Energy where the forces of the last call were computed [J]. Real time: O(bends), no allocation.
  double potential_energy(const StateTable& table, const MatArray& mats) const noexcept;
  /// Forgets the viscous forces of the last call: those before step 0 take no work.
  void forget_viscous_forces() noexcept;

  /// Forgets the moments of the last call of bends with states.
  void forget_moments() noexcept;

  /// Puts a bend with states into a state in the next step. Precondition: it has states, and that one.
  void force_state(const StateTable& table, std::uint32_t bend, std::uint32_t state) noexcept;
  /// Fits the bends to a table that has been changed. Allocates.
  void adopt(const StateTable& table);
  /// Fits them to the present parameters of the table: what these were before counts no longer. Real time:
  /// O(bends with states), no allocation.
  void take_parameters(const StateTable& table) noexcept;

  /// Precondition of these: the bend has states.
  std::uint32_t state_of(const StateTable& table, std::uint32_t bend) const noexcept {
    return states_.state_of(table, rows_[bend].state_row);
  }
  double age(std::uint32_t bend, std::uint64_t step) const noexcept {
    return states_.age(rows_[bend].state_row, step);
  }
  double last_moment(std::uint32_t bend) const noexcept {
    return states_.moment(rows_[bend].state_row);
  }
  double rest_angle(std::uint32_t bend) const noexcept {  ///< [rad]
    return states_.rest_angle(rows_[bend].state_row);
  }

  void serialize(Archive& archive, const StateTable& table);

 private:
  static constexpr std::uint32_t kNoRow = 0xffffffffU;
  struct Row {
    std::uint32_t mat_a;
    std::uint32_t mat_b;
    std::uint32_t mat_c;
    std::uint32_t state_row;   // of states_, or kNoRow
    double stiffness;          // [N m/rad]
    double viscosity_over_dt;  // [N m/rad]
    BendShape shape;
    bool has_law = false;  // beside these, in its state
  };
  static constexpr std::uint32_t kNoChange = 0xffffffffU;
  /// The linear law of a bend.
  struct LinearLaw {
    double stiffness;  // [N m/rad]
    BendShape shape;
  };
  /// A change of state of this step, and the law before it.
  struct Change {
    BendChange of_states;
    std::uint64_t step;
    LinearLaw law;
  };
  /// A bend whose parameters follow variables in some state, and its law in the last call.
  struct Following {
    std::uint32_t bend;
    LinearLaw last;
  };
  void change_states(const StateKernel& kernel, const StateTable& table,
                     const ForceColumns& columns, std::uint64_t step) noexcept;
  /// Enters a change in the log. @return energy that it brought into the bend [J]
  double enter(const StateTable& table, const Change& change, const ForceColumns& columns,
               EventLog& log) noexcept;
  StepEnergy add_bend(const StateTable& table, std::size_t bend,
                      const ForceColumns& columns) noexcept;
  /// What laws bring to a bend: moments along the bend vector, and their elastic work in the last period [J].
  struct PartOfLaws {
    Vec3 elastic;
    Vec3 viscous;
    double work;
  };
  /// @param moved_then  how far the bend vector has moved in the shape of the last call
  PartOfLaws add_laws(const StateTable& table, const Row& row, const Vec3& bend, const Vec3& moved,
                      const Vec3& moved_then) noexcept;
  /// Energy of the law of a state, less a part of the elastic work in the last period [J].
  double energy_of_law(const LawsOfBend& laws, const Row& row, const BendShape& shape, double part,
                       const ForceColumns& columns, const double* variables) const noexcept;
  const Change* change_of(const Row& row) const noexcept;
  /// The law of the last call where it is not that of this one, else null.
  const LinearLaw* last_law_of(const Row& row) const noexcept;
  /// Takes the bends that follow variables to the parameters of this step.
  /// @return energy that these have brought into them [J]
  double follow(const StateTable& table, const ForceColumns& columns) noexcept;
  /// Energy in a bend of a law, less a part of what it has taken in the last period [J].
  static double energy_of(const Row& row, const LinearLaw& law, double part,
                          const ForceColumns& columns) noexcept;
  static BendSides sides_of(const Row& row, const ForceColumns& columns) noexcept;
  void put_state(const StateTable& table, Row& row) noexcept;
  void put_state_at_rest_angle(const StateTable& table, Row& row) noexcept;
  static void add_moment(const Row& row, const Vec3& moment, double* force) noexcept;
  Vec3 viscous_moment(const Row& row, const Vec3& bend, const Vec3& moved) const noexcept;
  Vec3 last_viscous_moment(std::size_t row) const noexcept;
  Vec3 last_law_moment(const Row& row) const noexcept;

  int dimension_;
  double dt_;  // [s]
  std::vector<Row> rows_;
  std::vector<Bend> with_states_;           // by row of states_
  std::vector<std::uint32_t> bend_of_row_;  // likewise
  BendStates states_;
  std::vector<Change> changes_;               // of this step, in the order of the rows of states_
  std::vector<std::uint32_t> change_of_row_;  // of states_: place in changes_, or kNoChange
  std::vector<Following> following_;
  std::vector<std::uint32_t> following_of_row_;  // of states_: place in following_, or kNoChange
  LinkGroups groups_;
  GroupedOrder order_;                    // of the bends
  std::vector<StepEnergy> works_;         // of each group in this step
  AlignedVector<double> viscous_moment_;  // of the last call, 3 per row [N m]
  AlignedVector<double>
      law_moment_;  // of elastic laws, 3 per row of states_; empty: there are none
};

}  // namespace cordis::engine
