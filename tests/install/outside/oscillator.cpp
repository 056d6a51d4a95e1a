// tests/install/outside/oscillator.cpp -- a mass on a spring, stepped by the installed engine
// against the exact solution of the recurrence.
#include <cmath>
#include <cstdio>
#include <memory>

#include <cordis/world.h>

int main() {
  using namespace cordis::engine;
  constexpr double kStep = 1e-3;
  constexpr double kStiffness = 100.0;
  constexpr double kMass = 0.1;
  constexpr int kSteps = 1000;

  NetworkDescription description;
  description.dimension = 1;
  description.step = kStep;
  description.mats.push_back({MatKind::kFixed});
  description.mats.push_back({MatKind::kMass, kMass, Vec3(1.0, 0.0, 0.0)});
  description.links.push_back({0, 1, kStiffness, 0.0, 0.0});
  World world(std::make_shared<const Network>(description));
  for (int n = 0; n < kSteps; ++n) {
    if (world.step().non_finite_mats != 0) return 1;
  }

  // x(n) = cos(n w), cos w = 1 - K dt^2 / (2 m): the half-step velocity of the start makes x(-1) =
  // x(1).
  const double exact =
      std::cos(kSteps * std::acos(1.0 - kStiffness * kStep * kStep / (2.0 * kMass)));
  const double found = world.position(1).x();
  std::printf("x = %.12f, exact %.12f\n", found, exact);
  return std::abs(found - exact) < 1e-10 ? 0 : 1;
}
