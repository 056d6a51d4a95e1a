// sim_node/engine/integrators/damping_sweeps.h -- dampers taken apart from the rest, each pair
// exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

/// What the viscosities of linear links and of the medium do to the velocities in half a period
/// while nothing else acts: one link after the other, each as if it were alone,
///
///     J = mu (1 - e^(-Z dt / 2 mu)) (speed along the link),   mu the reduced mass,
///
/// forward and then backward, which makes a period symmetric in time and so of second order. No
/// viscosity is too large for it; momentum and, but for ties, angular momentum are kept to
/// rounding.
class DampingSweeps {
 public:
  explicit DampingSweeps(const NetworkDescription& description);

  /// Half a period at the present positions.
  /// @param velocity  4 x N; of MATs that are no masses their given velocity, which stays [m/s]
  /// @return kinetic energy that the masses have lost, and ports have brought in [J]
  /// Real time: O(links + MATs), no allocation.
  struct Loss {
    double dissipated = 0.0;
    double port_work = 0.0;
  };
  Loss sweep(const MatArray& mats, bool forward, AlignedVector<double>& velocity) noexcept;

  /// Sum of the forces of the dampers on each MAT over the last two sweeps [N], 4 x N.
  const AlignedVector<double>& force() const noexcept { return force_; }
  void clear_force() noexcept;

 private:
  struct Damper {
    std::uint32_t a;
    std::uint32_t b;
    double mass;            // mu (1 - e^(-Z dt / 2 mu)) [kg]
    double inverse_mass_a;  // [1/kg]
    double inverse_mass_b;
    bool isotropic;
  };

  void damp(const Damper& damper, const MatArray& mats, AlignedVector<double>& velocity,
            Loss& loss) noexcept;
  void damp_in_medium(AlignedVector<double>& velocity, Loss& loss) noexcept;

  bool in_line_;
  double rate_;  // 1 / dt [1/s]
  std::vector<Damper> dampers_;
  std::vector<double> mass_;          // [kg], 0 unless a mass
  std::vector<double> medium_share_;  // 1 - e^(-Z dt / 2 m); empty without a medium
  AlignedVector<double> force_;
};

}  // namespace cordis::engine
