// tests/plan/reference_problems.h -- the problems of tests/reference that are motions, as networks.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/plan/networks.h"

namespace cordis::test::convergence {

/// What decides the order of a method.
enum class MotionKind { kConservative, kDamped, kSwitching };

struct ReferenceProblem {
  std::string name;
  MotionKind kind;
  NetworkDescription network;
  double duration;  // [s]
  double rate_hz;   // the fixed rate at which errors are shown; order from it and 2, 4 times it
  /// What the reference says: {time, MAT, position along x}, ascending in time.
  std::vector<std::array<double, 3>> expected;
  double within = 1e-8;  // of the reference: more where it is of a limit that the scene comes near
                         // [m]
};

/// One for each of tests/reference but: R02, which is the recurrence of `cordis` itself and not of
/// an equation (recurrence_test); R08, a number that was not given; R20 and R21, which are limits
/// and not motions (port_limit_test, integrator_limit_test).
std::vector<ReferenceProblem> reference_problems();

ReferenceProblem bounce();     ///< R12, which reference_problems() has too
ReferenceProblem collision();  ///< R19, likewise

}  // namespace cordis::test::convergence
