// sim_node/plan/oscillator_error.h -- what the scheme makes of one damped oscillation.
#pragma once

namespace cordis::plan {

/// Errors of the centred difference x(n+1) = (2 - K' - Z') x(n) - (1 - Z') x(n-1), from its exact
/// roots; K' = w^2 dt^2, Z' = Z dt / m.
struct OscillatorError {
  bool oscillates = false;  ///< whether the true motion and that of the scheme do; else both are 0
  double pitch = 0.0;       ///< relative error of the frequency: + is sharp
  double decay = 0.0;       ///< relative error of the rate of decay; 0 without viscosity
};

/// @param angular_frequency  sqrt(K / m) [1/s], > 0
/// @param viscosity          Z / m [1/s], >= 0
OscillatorError oscillator_error(double angular_frequency, double viscosity, double step);

/// An interval of pitch in cents, hundredths of a semitone.
double cents(double relative_pitch_error);

}  // namespace cordis::plan
