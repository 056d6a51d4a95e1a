// sim_node/engine/matter/energy.h -- where the energy of a world is, and where it came from and
// went.
#pragma once

#include <cstddef>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

/// Energies of the present state and the account since step 0 [J].
///
///     kinetic + elastic + gravity = initial + port_work + switching - dissipated + residual
///
/// All of them belong to the middle of the last period, between x(n-1) and x(n), where this scheme
/// keeps its account: a force f(n) changes the kinetic energy of the half-step velocities by
/// exactly f(n) . (x(n+1) - x(n-1)) / 2, and dissipated and port_work are these exact works.
///
/// For linear links in 1 dimension, elastic is the product that the scheme keeps,
/// K e(n) e(n-1) / 2, which changes by exactly the work of the springs. Of all other links, elastic
/// is what they stored at first, and the exact works of their elastic forces and the energies of
/// their changes of state since. So no residual is left but rounding, for every law and every step
/// that is stable; and what the links should store by the closed forms of their laws differs from
/// elastic by elastic_error, which shows what finite steps have done to them.
/// A port that has moved counts up to its present position, and rests there until the next step.
///
/// All of this is so for Integrator::kCordis. The others keep the account at the moment of the last
/// forces, with all energies in closed form and the works of viscosity at that moment: then the
/// residual is what finite steps have done, and elastic_error is 0.
struct Energy {
  double kinetic =
      0.0;  ///< of the half-step velocity (x(n) - x(n-1)) / dt before the present position
  double elastic = 0.0;  ///< in the links; below 0 for a moment where a link passes its rest length
  double gravity = 0.0;  ///< potential in the uniform gravity, 0 at the origin
  double dissipated = 0.0;  ///< taken since step 0 by the viscosity of links and medium, and by all
                            ///< else of the pull of a link that is not the slope of a potential:
                            ///< a force limit, the cutting off of a clamped one, a function
  double port_work = 0.0;   ///< brought in by imposed positions and external forces since step 0
  double switching = 0.0;   ///< brought in by changes of state and of parameters since step 0: the
                            ///< sum of LinkEvent::energy
  double initial = 0.0;     ///< kinetic + elastic + gravity at step 0
  double elastic_error = 0.0;  ///< part of elastic that a finite step has put there, above what the
                               ///< laws of the links store: of order dt^2; 0 for linear links and
                               ///< states in 1 dimension, and at changes of state
  double largest = 0.0;  ///< largest magnitude among the fields above, and that port_work ever had:
                         ///< the scale for a relative residual

  double total() const noexcept { return kinetic + elastic + gravity; }
  double residual() const noexcept {
    return total() - initial - port_work - switching + dissipated;
  }
};

/// What one step does to the account [J].
struct StepEnergy {
  double elastic = 0.0;     ///< work that went into the links, but for linear ones in 1 dimension
  double dissipated = 0.0;  ///< work that viscosity took
  double switching = 0.0;   ///< brought into links by changes of state
  double port_work = 0.0;

  StepEnergy& operator+=(const StepEnergy& other) noexcept {
    elastic += other.elastic;
    dissipated += other.dissipated;
    switching += other.switching;
    port_work += other.port_work;
    return *this;
  }
};

/// The works that loops over links return, as the account takes them: half of each.
StepEnergy half_of(const LinkWork& work) noexcept;

/// Gathers the work of every step.
class EnergyAccount {
 public:
  /// Opens the account with the energies of step 0.
  /// @param stored  by the links, but for linear ones in 1 dimension, at the delayed positions [J]
  /// @param since   work of their forces from there to the present positions [J]
  void start(const NetworkDescription& network, const MatArray& mats, double stored,
             double since) noexcept;

  /// Opens the account of an integrator that keeps it at the moments x(n): with their sum [J].
  /// @param stored  as of the other start
  void open(double initial, double stored = 0.0) noexcept;

  /// Enters one step, or a change between two.
  void add(const StepEnergy& step) noexcept;

  double dissipated() const noexcept { return dissipated_; }  ///< as entered [J]

  /// @param since   works of the forces of the last step up to the present positions
  /// @param stored  what links, but for linear ones in 1 dimension, should store by the closed
  ///                forms of their laws, where the forces of the last step were computed [J]
  /// Real time: O(MATs + links), no allocation.
  Energy energy(const NetworkDescription& network, const MatArray& mats, const StepEnergy& since,
                double stored) const noexcept;

  /// The account with the energies at a full step x(n), all of them in closed form [J].
  Energy at_moment(double kinetic, double elastic, double gravity) const noexcept;

  /// Energies of masses and linear links, from which energy() makes the account [J].
  struct OfMatter {
    double kinetic;
    double elastic;
    double gravity;
  };
  Energy at_half_step(const OfMatter& matter, const StepEnergy& since,
                      double stored) const noexcept;

  static constexpr std::size_t kStateSize = 6;
  /// The state as a row of values.
  void append_state(std::vector<double>& state) const;
  /// Takes it back. @return one past the last value taken.
  const double* take_state(const double* state) noexcept;

 private:
  void enter_account(Energy& energy) const noexcept;

  double initial_ = 0.0;
  double dissipated_ = 0.0;
  double port_work_ = 0.0;
  double largest_port_work_ = 0.0;
  double stored_ = 0.0;  // in the links, when the last forces were computed
  double switching_ = 0.0;
};

}  // namespace cordis::engine
