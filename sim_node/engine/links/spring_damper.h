// sim_node/engine/links/spring_damper.h -- the linear links of a world.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/energy_account.h"
#include "sim_node/engine/matter/mat_array.h"
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
  SpringDamperArray(const NetworkDescription& description, Kind kind);

  /// Adds the force of every link to its two MATs, in link order.
  /// @return the work [J] that went into the links with the forces of the last call, from then to
  ///         now, and with these, from the last call to now; half of each, as a force f(n) does in
  ///         this scheme the work f(n) . (x(n+1) - x(n-1)) / 2. In line without that of the
  ///         springs, which is the change of K e(n) e(n-1) / 2.
  /// Real time: O(links), no allocation.
  StepEnergy add_forces(const StepKernel& kernel, const ForceColumns& columns) noexcept;

  /// Adds the forces for an account at full steps: only the energy [J] that the viscous forces
  /// take in a period at the velocity (x - delayed) / dt is returned, and nothing remembered.
  StepEnergy add_forces_at_full_step(const StepKernel& kernel,
                                     const ForceColumns& columns) noexcept;

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
  LinkRows rows(const ActiveLinks::Run& run) noexcept;
  StepEnergy add(AddLinkForces add_link_forces, const ForceColumns& columns) noexcept;

  bool is_1d_;                             // 1 dimension, or vector springs
  bool viscous_ = false;                   // a link has viscosity
  AlignedVector<std::uint32_t> column_a_;  // 4 * MAT index, + axis of a vector spring
  AlignedVector<std::uint32_t>
      column_b_;                     // all arrays: one per link, padded to a multiple of kLinkBatch
  AlignedVector<double> stiffness_;  // K [N/m]
  AlignedVector<double> viscosity_over_dt_;  // Z / dt [N/m]
  AlignedVector<double> rest_length_;        // [m]
  AlignedVector<double> viscous_factor_;     // [N/m]; in line the viscous tension itself [N]
  AlignedVector<double> elastic_factor_;     // [N/m]; none in line
  ActiveLinks active_;
};

}  // namespace cordis::engine
