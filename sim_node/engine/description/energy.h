// sim_node/engine/description/energy.h -- the energies of a world, and what changed them.
#pragma once

namespace cordis::engine {

/// Energies of the present state and the account since step 0 [J].
///
///     kinetic + elastic + gravity = initial + port_work + switching - dissipated + residual
///
/// All of them belong to the middle of the last period, between x(n-1) and x(n), where this scheme
/// keeps its account. A force f(n) changes the kinetic energy of the half-step velocities by
/// exactly f(n) . (x(n+1) - x(n-1)) / 2, and dissipated and port_work are these exact works.
///
/// For linear links in 1 dimension, elastic is the product that the scheme keeps, K e(n) e(n-1) /
/// 2, which changes by exactly the work of the springs. Of all other links, elastic is what they
/// stored at first, and the exact works of their elastic forces and the energies of their changes
/// of state since. So no residual is left but rounding, for every law and every step that is
/// stable. By the closed forms of their laws the links should store another energy. The difference
/// is elastic_error, which shows what finite steps have done to them. A port that has moved counts
/// up to its present position, and rests there until the next step.
///
/// The products with which this scheme keeps its account stay constant even where a motion diverges;
/// kinetic_excess distinguishes the kinetic energy at x(n) from them.
///
/// All of this is so for IntegratorKind::kCordis. The others keep the account at the moment of the
/// last forces, with all energies in closed form and the works of viscosity at that moment. Then
/// the residual is what finite steps have done, and elastic_error and kinetic_excess are 0.
struct Energy {
  double kinetic = 0.0;  ///< from the half-step velocity (x(n) - x(n-1)) / dt before the present
                         ///< position
  double elastic = 0.0;  ///< in the links; below 0 for a moment where a link passes its rest length
  double gravity = 0.0;  ///< potential in the uniform gravity, 0 at the origin
  double dissipated = 0.0;  ///< taken since step 0 by the viscosity of links and medium, and by all
                            ///< else of the tension of a link that is not the slope of a potential,
                            ///< as that of a function of the speed
  double port_work = 0.0;   ///< brought in by imposed positions and external forces since step 0
  double switching = 0.0;   ///< brought in by changes of state and of parameters since step 0: the
                            ///< sum of LinkEvent::energy
  double initial = 0.0;     ///< kinetic + elastic + gravity at step 0, in the gravity of now
  double initial_gravity = 0.0;  ///< the part of gravity in it
  double elastic_error = 0.0;  ///< part of elastic that a finite step has put there, above what the
                               ///< laws of the links store: of order dt^2; 0 for linear links and
                               ///< states in 1 dimension, and at changes of state
  double kinetic_excess = 0.0;  ///< m (v(n-1/2) + v(n+1/2))^2 / 8 over m v(n-1/2) v(n+1/2) / 2 at
                                ///< the moment of the last forces, less that at step 0
  double brought_by_takers = 0.0;  ///< -dissipated where that is below 0 though no law of the scene
                                   ///< may drive: a step that is too long has brought it in
  double largest = 0.0;            ///< largest magnitude of an entry above,
                                   ///< and that port_work ever had:
                                   ///< the scale for a relative residual
  double made_there = 0.0;         ///< part of integration_error() that viscosity has not
                                   ///< dissipated since: only an EnergyWatch fills it

  double total() const noexcept { return kinetic + elastic + gravity; }
  /// What the integration has put in (> 0) or taken (< 0) and no account explains [J]:
  /// (kinetic + true potential + dissipated) - (initial + port_work + switching). Where no law may
  /// drive, dissipated counts as at least 0: what only takes has brought in nothing. The true potential
  /// and the kinetic energy are those of the moment of the last forces, whatever works the steps have
  /// done. 0 but for terms of order dt^2 while a step is short enough; it grows where a motion
  /// diverges though the account closes.
  double integration_error() const noexcept {
    return residual() - elastic_error + kinetic_excess + brought_by_takers;
  }
  double residual() const noexcept {
    return total() - initial - port_work - switching + dissipated;
  }
  /// The residual over the largest entry; 0 where all were 0. NaN where one was no finite number.
  double drift() const noexcept { return largest == 0.0 ? 0.0 : residual() / largest; }
};

}  // namespace cordis::engine
