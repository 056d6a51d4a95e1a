// sim_node/engine/energy.h -- where the energy of a world is, and where it came from and went.
#pragma once

#include <cstddef>
#include <vector>

#include "sim_node/engine/mat_array.h"
#include "sim_node/engine/network.h"

namespace cordis::engine {

/// Energies of the present state and the account since step 0 [J].
///
///     kinetic + elastic + gravity = initial + port_work - dissipated + residual
///
/// All of them belong to the middle of the last period, between x(n-1) and x(n), where this scheme
/// keeps its account: a force f(n) changes the kinetic energy of the half-step velocities by
/// exactly f(n) . (x(n+1) - x(n-1)) / 2, and dissipated and port_work are these exact works.
/// Against them elastic changes
/// - in 1 dimension by exactly the work of the springs: the residual is rounding alone, for every
/// step that is stable;
/// - in 2 and 3 dimensions by that work up to third order in dt a step, from the turning of the
/// links: the residual
///   is of order dt^2.
/// A port that has moved counts up to its present position, and rests there until the next step.
struct Energy {
  double kinetic =
      0.0;  ///< of the half-step velocity (x(n) - x(n-1)) / dt before the present position
  double elastic =
      0.0;  ///< in the springs, sum of K e(n) e(n-1) / 2, e the elongation: the product that the
            ///< scheme keeps; below 0 for a moment where a link passes its rest length
  double gravity = 0.0;     ///< potential in the uniform gravity, 0 at the origin
  double dissipated = 0.0;  ///< taken by link and medium viscosity since step 0
  double port_work = 0.0;   ///< brought in by imposed positions and external forces since step 0
  double initial = 0.0;     ///< kinetic + elastic + gravity at step 0
  double largest = 0.0;  ///< largest magnitude among the fields above, and that port_work ever had:
                         ///< the scale for a relative residual

  double total() const noexcept { return kinetic + elastic + gravity; }
  double residual() const noexcept { return total() - initial - port_work + dissipated; }
};

/// Gathers the work of every step.
class EnergyAccount {
 public:
  /// Opens the account with the energies of step 0.
  void start(const NetworkDescription& network, const MatArray& mats) noexcept;

  /// Enters the work [J] of one step.
  void add(double dissipated, double port_work) noexcept;

  /// @param dissipated_since  taken by viscous forces since the last entry, up to the present
  /// positions [J] Real time: O(MATs + links), no allocation.
  Energy energy(const NetworkDescription& network, const MatArray& mats,
                double dissipated_since) const noexcept;

  static constexpr std::size_t kStateSize = 4;
  /// The state as a row of values.
  void append_state(std::vector<double>& state) const;
  /// Takes it back. @return one past the last value taken.
  const double* take_state(const double* state) noexcept;

 private:
  double initial_ = 0.0;
  double dissipated_ = 0.0;
  double port_work_ = 0.0;
  double largest_port_work_ = 0.0;
};

}  // namespace cordis::engine
