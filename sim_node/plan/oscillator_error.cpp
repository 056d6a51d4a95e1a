// sim_node/plan/oscillator_error.cpp
#include "sim_node/plan/oscillator_error.h"

#include <cmath>

namespace cordis::plan {

OscillatorError oscillator_error(double angular_frequency, double viscosity, double step) {
  const double rate = 0.5 * viscosity;  // of decay
  const double square = angular_frequency * angular_frequency - rate * rate;
  const double trace = 2.0 - angular_frequency * angular_frequency * step * step - viscosity * step;
  const double product = 1.0 - viscosity * step;  // of the two roots
  OscillatorError error;
  error.oscillates = square > 0.0 && product > 0.0 && trace * trace < 4.0 * product;
  if (!error.oscillates) return error;
  const double frequency = std::sqrt(square);
  const double reached = std::atan2(std::sqrt(product - 0.25 * trace * trace), 0.5 * trace) / step;
  error.pitch = reached / frequency - 1.0;
  if (rate > 0.0) error.decay = -0.5 * std::log1p(-viscosity * step) / (rate * step) - 1.0;
  return error;
}

double cents(double relative_pitch_error) {
  return 1200.0 * std::log2(1.0 + relative_pitch_error);
}

}  // namespace cordis::plan
