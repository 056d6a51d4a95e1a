// sim_node/engine/links/spring_damper.h -- the linear links of a world.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/link_groups.h"
#include "sim_node/engine/links/link_runs.h"
#include "sim_node/engine/matter/energy_account.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/mat_blocks.h"
#include "sim_node/engine/matter/mat_roles.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// Linear springs, dampers and spring-dampers: two positions in, two opposite forces out.
///
/// tension = K (d - rest) + Z (elongation increment along its axis in the last period) / dt; see
/// Link for d. Vector springs are taken apart into one such link along each axis, as in 1 dimension.
/// Source: [Luc90 III.2.2 Modelisation of the material in its continuous behaviour].
class SpringDamperArray {
 public:
  enum class Kind : std::uint8_t {
    kAlong,        ///< all links in 1 dimension, those that are not isotropic in 2 and 3
    kVectorSpring  ///< the others
  };
  SpringDamperArray(const NetworkDescription& description, Kind kind, const MatLayout& layout,
                    const MatBlocks& blocks);

  /// Adds the force of every link to its two MATs: group by group of the MatBlocks, which the members of the
  /// team share, and within a group in link order. Where the MATs are stored by axis, the
  /// links of a run are added without looking up their ends, with the same bits.
  /// @return the work [J] that went into the links with the forces of the last call, from then to
  ///         now, and with these, from the last call to now; half of each, as a force f(n) does in
  ///         this scheme the work f(n) . (x(n+1) - x(n-1)) / 2. In line without that of the
  ///         springs, which is the change of K e(n) e(n-1) / 2.
  /// Real time: O(links), no allocation.
  StepEnergy add_forces(const StepKernel& kernel, const ForceColumns& columns,
                        ThreadTeam& team) noexcept;

  /// Adds the forces for an account at full steps: only the energy [J] that the viscous forces
  /// take in a period at the velocity (x - delayed) / dt is returned, and nothing remembered.
  StepEnergy add_forces_at_full_step(const StepKernel& kernel, const ForceColumns& columns,
                                     ThreadTeam& team) noexcept;

  /// Passes on along each link.
  void mark_neighbours(const WakePropagation& pass, MatRoles& roles) const noexcept;
  /// From now on only links at MATs with kWholeForce, and some beside them, are computed; of the
  /// others neither end has moved. Real time: O(links), no allocation.
  void choose_active(MatRoles& roles) noexcept;

  /// The first half alone, for the forces of the last call up to the present positions.
  /// Real time: O(links), no allocation.
  StepEnergy work_since_last_call(const MatArray& mats) const noexcept;
  /// Energy of the springs where the forces of the last call were computed [J].
  /// Real time: O(links), no allocation.
  double potential_energy(const MatArray& mats) const noexcept;
  /// potential_energy(), but 0 in 1-D, where the account keeps K e(n) e(n-1) / 2.
  double stored_energy(const MatArray& mats) const noexcept {
    return is_1d_ ? 0.0 : potential_energy(mats);
  }

  /// Forgets the viscous forces of the last call: those before step 0 take no work.
  void start() noexcept;
  /// From now on these links are springs alone.
  void drop_viscosity() noexcept;

  /// What the account remembers of the last call.
  void serialize(Archive& archive);

 private:
  static constexpr std::size_t kNoneEqual = ~std::size_t{0};

  /// Where the rows and runs of a group begin.
  struct Group {
    std::size_t first_row = 0;
    std::size_t first_run = 0;
  };

  void arrange(const std::vector<Link>& links, const std::vector<std::size_t>& first,
               bool with_runs, std::size_t axes, double step);
  void fill_row(std::size_t row, const Link& link, std::uint32_t axis, double step) noexcept;
  void pad_row(std::size_t row, const MatBlocks::Mats& mats) noexcept;
  void find_equal_parameters(const LinkArrangement& arrangement);
  LinkRows rows(const ActiveLinks::Run& run) noexcept;
  RunRows rows(std::size_t run) noexcept;
  StepEnergy add(AddLinkForces add_link_forces, const ForceColumns& columns,
                 ThreadTeam& team) noexcept;
  StepEnergy add_by_axis(AddLinkForces gathered, const RunLoops& loops, const ForceColumns& rows,
                         ThreadTeam& team) noexcept;

  MatLayout layout_;
  LinkGroups link_groups_;
  std::vector<Group> groups_;  // and one more, which ends the last
  int dimension_;
  bool is_1d_;                               // 1 dimension, or vector springs
  bool viscous_ = false;                     // a link has viscosity
  bool freezes_;                             // only some links are computed
  std::vector<LinkRun> runs_;                // by axis: all rows; else none
  std::vector<std::uint8_t> used_rows_;      // by axis: as of LinkArrangement
  std::vector<std::size_t> equal_;           // by run: where its parameters begin, or kNoneEqual
  AlignedVector<double> equal_parameters_;   // of runs: 8 times K, 8 times Z / dt, 8 times rest
  AlignedVector<std::uint32_t> column_a_;    // offset by the MatLayout, of the axis of a vector
                                             // spring
  AlignedVector<std::uint32_t> column_b_;    // all arrays: one per row, a multiple of kLinkBatch
  AlignedVector<double> stiffness_;          // K [N/m]
  AlignedVector<double> viscosity_over_dt_;  // Z / dt [N/m]
  AlignedVector<double> rest_length_;        // [m]
  AlignedVector<double> viscous_factor_;     // [N/m]; in line the viscous tension itself [N]
  AlignedVector<double> elastic_factor_;     // [N/m]; none in line
  ActiveLinks active_;
};

}  // namespace cordis::engine
