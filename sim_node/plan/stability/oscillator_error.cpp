// sim_node/plan/stability/oscillator_error.cpp
#include "sim_node/plan/stability/oscillator_error.h"

#include <algorithm>
#include <cmath>

#include "node/assert.h"
#include "sim_node/engine/integrators/integrator_limits.h"

namespace cordis::plan {
namespace {

using engine::IntegratorKind;

/// A pair of roots of z^2 - trace z + product: what one period does to an oscillation.
struct Roots {
  double trace = 0.0;
  double product = 0.0;
};

/// z^3 - (2 - K' - 1.5 Z') z^2 + (1 - 2 Z') z + 0.5 Z': the pair beside its real root.
Roots of_extrapolated_damping(double stiffness, double viscosity) {
  const double a = -(2.0 - stiffness - 1.5 * viscosity);
  const double b = 1.0 - 2.0 * viscosity;
  const double c = 0.5 * viscosity;
  double real = -c;  // near 0, as -0.5 Z' / (1 - 2 Z')
  for (int n = 0; n < 60; ++n) {
    const double slope = (3.0 * real + 2.0 * a) * real + b;
    real -= (((real + a) * real + b) * real + c) / slope;
  }
  return {-a - real, b + real * (a + real)};
}

/// ImplicitDamping of one mass: dt v+ = left dt v + now a + change (a - a before).
Roots of_implicit_damping(double stiffness, double viscosity) {
  constexpr double kG = engine::kImplicitDampingShare;
  const double solved = 1.0 / (1.0 + kG * viscosity);
  const double left = (1.0 - (1.0 - 2.0 * kG) * viscosity) * solved * solved;
  const double now = (1.0 - kG) * solved * solved + kG * solved;
  const double change = (1.0 - kG) * (kG - 0.5) * solved * solved + 0.5 * kG * solved;
  return {1.0 + left - stiffness * (now + change), left - stiffness * change};
}

/// The relative error of the slower of two real modes, from the root nearest to 1 on its left.
void evaluate_creep(double angular_frequency, double viscosity, double step, const Roots& roots,
                    OscillatorError& error) {
  const double rate = 0.5 * viscosity;
  const double apart = std::sqrt(rate * rate - angular_frequency * angular_frequency);
  const double square = 0.25 * roots.trace * roots.trace - roots.product;
  if (!(square >= 0.0)) return;
  const double slow = 0.5 * roots.trace + std::sqrt(square);
  const double fast = roots.trace - slow;
  if (!(slow > 0.0 && slow < 1.0 && fast > -1.0)) return;
  const double exact = angular_frequency * angular_frequency / (rate + apart);
  // 1 - slow, without the difference of two numbers near 1
  const double left = (1.0 - roots.trace + roots.product) / (1.0 - fast);
  error.creeps = true;
  error.creep = -std::log1p(-left) / (exact * step) - 1.0;
}

Roots roots_of(IntegratorKind integrator, double stiffness, double viscosity) {
  switch (integrator) {
    case IntegratorKind::kCordis:
      break;
    case IntegratorKind::kLeapfrog: {
      if (viscosity <= engine::kMaxExtrapolatedViscosity) {
        return of_extrapolated_damping(stiffness, viscosity);
      }
      return of_implicit_damping(stiffness, viscosity);
    }
    case IntegratorKind::kSymplectic4:
      return {engine::symplectic4_trace(stiffness), 1.0};
    case IntegratorKind::kModal:
      break;
    case IntegratorKind::kImplicit: {
      const double whole = 1.0 + viscosity + stiffness;
      return {(2.0 + viscosity) / whole, 1.0 / whole};
    }
  }
  return {2.0 - stiffness - viscosity, 1.0 - viscosity};
}

}  // namespace

OscillatorError oscillator_error(double angular_frequency, double viscosity, double step,
                                 IntegratorKind integrator) {
  CORDIS_ASSERT(angular_frequency > 0.0 && viscosity >= 0.0);
  const double rate = 0.5 * viscosity;  // of decay
  const double square = angular_frequency * angular_frequency - rate * rate;
  const Roots roots =
      roots_of(integrator, angular_frequency * angular_frequency * step * step, viscosity * step);
  OscillatorError error;
  if (integrator == IntegratorKind::kModal) {  // exact
    error.oscillates = square > 0.0;
    error.creeps = !error.oscillates;
    return error;
  }
  if (square <= 0.0) {
    evaluate_creep(angular_frequency, viscosity, step, roots, error);
    return error;
  }
  error.oscillates =
      square > 0.0 && roots.product > 0.0 && roots.trace * roots.trace < 4.0 * roots.product;
  if (!error.oscillates) return error;
  const double frequency = std::sqrt(square);
  const double half = 0.5 * roots.trace;
  const double reached = std::atan2(std::sqrt(roots.product - half * half), half) / step;
  error.pitch = reached / frequency - 1.0;
  const double decay = -0.5 * std::log1p(roots.product - 1.0) / step;
  error.decay = rate > 0.0 ? decay / rate - 1.0 : decay / frequency;
  return error;
}

/// `cordis` puts the pitch off by its share of the stiffness, and by its own viscosity. To first order the errors of
/// both add up.
OscillatorError oscillator_error(double angular_frequency, double viscosity, double step,
                                 IntegratorKind integrator, const MovedAsByCordis& part) {
  CORDIS_ASSERT(part.stiffness >= 0.0 && part.viscosity >= 0.0);
  OscillatorError error = oscillator_error(angular_frequency, viscosity, step, integrator);
  if (integrator == IntegratorKind::kCordis) return error;
  if (part.stiffness == 0.0 && part.viscosity == 0.0) return error;
  const double square = angular_frequency * angular_frequency;
  const double share = std::min(part.stiffness / square, 1.0);
  const double damped = std::min(part.viscosity, viscosity);
  const OscillatorError undamped_one = oscillator_error(angular_frequency, 0.0, step);
  const OscillatorError damped_one = oscillator_error(angular_frequency, damped, step);
  if (error.creeps) {
    if (damped_one.creeps) error.creep += damped_one.creep;
    return error;
  }
  error.oscillates = error.oscillates && undamped_one.oscillates && damped_one.oscillates;
  if (!error.oscillates) return {};
  error.pitch += damped_one.pitch - undamped_one.pitch;
  error.decay += damped_one.decay;
  if (integrator != IntegratorKind::kModal) return error;
  // Forces that are held for a step, which others have in their own error.
  const double of_dampers = viscosity > 0.0 ? damped / viscosity : 0.0;
  error.pitch += share * undamped_one.pitch;
  error.decay += (share + of_dampers) * square * step * step / 12.0;
  return error;
}

double cents(double relative_pitch_error) {
  return 1200.0 * std::log2(1.0 + relative_pitch_error);
}

}  // namespace cordis::plan
