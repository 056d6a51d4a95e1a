// sim_node/plan/stability/oscillator_error.h -- what the scheme makes of one damped oscillation.
#pragma once

#include "sim_node/engine/description/integrator_kind.h"

namespace cordis::plan {

/// Errors of one mass on a spring and a damper, from the exact roots of the recurrence of its
/// integrator; K' = w^2 dt^2, Z' = Z dt / m. Of `cordis`: x(n+1) = (2 - K' - Z') x(n) - (1 - Z')
/// x(n-1).
struct OscillatorError {
  bool oscillates = false;  ///< the true motion and that of the scheme do; else pitch and decay are
                            ///< 0
  bool creeps = false;      ///< both are overdamped and stable; else creep is 0
  double creep = 0.0;       ///< relative error of the rate of the slower of the two modes
  double pitch = 0.0;       ///< relative error of the frequency: + is sharp
  /// Relative error of the rate of decay; without viscosity the rate that the integrator makes up,
  /// as a part of w.
  double decay = 0.0;
};

/// @param angular_frequency  sqrt(K / m) [1/s], > 0
/// @param viscosity          Z / m [1/s], >= 0
OscillatorError oscillator_error(
    double angular_frequency, double viscosity, double step,
    engine::IntegratorKind integrator = engine::IntegratorKind::kCordis);

/// What of an oscillation an integrator moves as `cordis` does, beside what it moves by its own scheme.
struct MovedAsByCordis {
  double stiffness = 0.0;  ///< K / m of it [1/s^2], >= 0
  double viscosity = 0.0;  ///< Z / m of it [1/s], >= 0
};

/// The error of an integrator, and what `cordis` adds to it for a part of the oscillation.
/// @param angular_frequency, viscosity  of the whole oscillation
OscillatorError oscillator_error(double angular_frequency, double viscosity, double step,
                                 engine::IntegratorKind integrator, const MovedAsByCordis& part);

/// An interval of pitch in cents, hundredths of a semitone.
double cents(double relative_pitch_error);

}  // namespace cordis::plan
