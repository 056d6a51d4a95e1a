// sim_node/engine/integrators/modal_block.h -- a linear network in 1 dimension as a row of
// oscillators.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/simd/modal_kernel.h"

namespace cordis::engine {

/// Linear links between masses and fixed points, and the medium, as modes that do not know of each
/// other. Each follows the recurrence of `cordis` with the stiffness and viscosity that make it
/// exact,
///
///     Z' = 1 - e^(-2 s dt),   K' = 1 + e^(-2 s dt) - 2 e^(-s dt) cos(w_d dt)
///
/// whatever its frequency, and a steady force moves it as far as it should: gain K' / w^2.
class ModalBlock {
 public:
  /// O(masses^3). Precondition: refusal_of has nothing against the network.
  explicit ModalBlock(const NetworkDescription& network);

  /// Shapes of all modes at a MAT, padded to a multiple of 8 [1/sqrt(kg)]; 0 unless a mass.
  const double* shape(std::uint32_t mat) const noexcept {
    return shape_.data() + mat * place_.size();
  }

  /// Begins from rest at the start positions with the velocities of the network.
  /// @param forces  on MATs at step 0 besides those of the block, 4 x N [N]
  void start(const NetworkDescription& network, const double* forces) noexcept;
  /// @param first_step  of the block: the one that takes the start velocities of fast decaying modes
  ModeRows rows(bool first_step) noexcept;
  /// Half of what the first step adds to the modes, as the account of a recurrence sees it, with the
  /// present displacements [J]. Before the first step, and again after it.
  double start_work() const noexcept;
  const AlignedVector<double>& place() const noexcept { return place_; }
  const AlignedVector<double>& moved() const noexcept { return moved_; }
  AlignedVector<double>& place() noexcept { return place_; }
  AlignedVector<double>& moved() noexcept { return moved_; }

  /// Energies as the recurrence keeps them in the middle of the last period [J].
  double kinetic_energy() const noexcept;
  double elastic_energy() const noexcept;
  double gravity_energy() const noexcept;

  /// What 1 N on MAT a, alternating from step to step, moves MAT b by [m/N]. A stiffness K between
  /// two MATs makes the scheme diverge when K times that of the two against each other is above 1.
  /// Infinite when a mode diverges by itself.
  double alternating_compliance(std::uint32_t a, std::uint32_t b) const noexcept;
  /// How much of a stiffness between the MAT and the rest of the world keeps every step stable, at
  /// most [N/m]: that with which an eigenvalue of the scheme reaches -1.
  double max_stiffness(std::uint32_t mat) const noexcept;

 private:
  void find_modes(const NetworkDescription& network);
  void set_mode(std::size_t mode, double dt) noexcept;

  AlignedVector<double> shape_;               // of MAT i: as many values as place_ has
  AlignedVector<double> place_;               // q(n) [m sqrt(kg)]
  AlignedVector<double> moved_;               // q(n) - q(n-1)
  AlignedVector<double> velocity_retention_;  // 1 - Z'
  AlignedVector<double> stiffness_;           // K'
  AlignedVector<double> gain_;                // [s^2]
  AlignedVector<double> constant_;            // gain * force that is always there
  AlignedVector<double> constant_at_start_;   // and of the first step
  AlignedVector<double> dissipation_;         // Z' / 2 gain
  std::vector<double> square_;                // w^2 [1/s^2]
  std::vector<double> viscosity_;             // 2 s [1/s]
  std::vector<double> of_speed_;              // what the first step makes of 1 m sqrt(kg) / s [s]
  std::vector<double> of_force_;              // and of a force that begins then [s^2]
  std::vector<double> link_force_;            // at the start
  std::vector<double> weight_;                // gravity
  double elastic_at_start_ = 0.0;             // [J]
  double gravity_at_start_ = 0.0;             // [J]
};

}  // namespace cordis::engine
