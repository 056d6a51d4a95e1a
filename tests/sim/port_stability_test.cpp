// tests/sim/port_stability_test.cpp -- the force loop through the engine: where it begins to swing.
#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>
#include <limits>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "tests/support/haptic_boundaries.h"
#include "tests/support/rounds.h"

namespace cordis::sim {
namespace {

using engine::Vec3;

constexpr double kPeriod = 1e-3;  // T [s]
constexpr double kMass = 0.05;    // of the key, or of the simulated mass [kg]
constexpr double kSide = 0.02;    // so near to the boundary on either side

using Row = test::HapticBoundary;

/// A motion grows if its largest excursion in the last quarter exceeds that of the quarter before.
class Growth {
 public:
  explicit Growth(int steps) : steps_(steps) {}

  /// @return whether it is clear already
  bool add(int n, double x) {
    if (n >= steps_ / 2) {
      double& largest = n < steps_ * 3 / 4 ? before_ : after_;
      largest = std::max(largest, std::abs(x));
    }
    if (std::abs(x) < 1e100) return false;
    before_ = 0.0;
    after_ = 1.0;
    return true;
  }
  /// What has faded to the smallest numbers of a double, which a world takes as 0, does not.
  bool grows() const { return after_ > before_ && after_ > 1e-250; }

 private:
  int steps_;
  double before_ = 0.0;
  double after_ = 0.0;
};

engine::World world_with(engine::Mat mat, double stiffness, double viscosity) {
  engine::NetworkDescription network;
  network.dimension = 1;
  network.step = kPeriod;
  engine::Mat ground;
  ground.kind = engine::MatKind::kFixed;
  engine::Mat bob;  // a world needs a mass
  bob.mass = 1.0;
  network.mats = {mat, ground, bob};
  network.links.push_back({0, 1, stiffness, viscosity, 0.0});
  return engine::World(std::make_shared<const engine::Network>(network));
}

/// Role mass: a key under held forces, exact, before a wall of the engine that answers to its
/// position of `delay` periods ago.
bool key_swings_up(const Row& row, double kappa) {
  engine::Mat port;
  port.kind = engine::MatKind::kPort;
  engine::World world =
      world_with(port, kappa * kMass / (kPeriod * kPeriod), row.z * kMass / kPeriod);
  const double b = row.beta * kMass / kPeriod;
  const double lost = -std::expm1(-row.beta);  // share of the speed lost in a period
  const double tau = kMass / b;
  const int steps = std::max(4000, static_cast<int>(30.0 / row.beta));
  std::deque<double> past(static_cast<std::size_t>(row.delay) + 1, 0.0);
  double position = 1e-6;
  double speed = 0.0;
  Growth growth(steps);
  for (int n = 0; n < steps; ++n) {
    past.push_back(position);
    past.pop_front();
    world.impose_position(0, Vec3(past.front(), 0.0, 0.0));
    world.step();
    const double force = world.link_force(0).x();
    position += force / b * kPeriod + (speed - force / b) * tau * lost;
    speed += (force / b - speed) * lost;
    if (growth.add(n, position)) break;
  }
  return growth.grows();
}

TEST(PortStability, RoleMassSwingsJustWhereTheTableSays) {
  const int every = 100 / test::rounds(100);
  int count = 0;
  for (const Row& row : test::haptic_boundaries()) {
    if (row.delay > 3 || row.stable == 0.0 || count++ % every != 0) continue;
    EXPECT_FALSE(key_swings_up(row, row.stable * (1.0 - kSide)))
        << row.beta << " " << row.z << " " << row.delay;
    EXPECT_TRUE(key_swings_up(row, row.stable * (1.0 + kSide)))
        << row.beta << " " << row.z << " " << row.delay;
  }
  EXPECT_GT(count, 150);
}

/// Stiffness of the hand k T^2 / m at which x(n+1) = (2-Z') x(n) - (1-Z') x(n-1) - k x(n-d) begins
/// to swing: the least real positive -z^d (z - 2 + Z' + (1-Z')/z) on the unit circle.
double liaison_boundary(double z, int delay) {
  using Complex = std::complex<double>;
  const auto curve = [&](double theta) {
    const Complex w = std::polar(1.0, theta);
    return -std::pow(w, delay) * (w - 2.0 + z + (1.0 - z) / w);
  };
  double least = curve(std::numbers::pi).real() > 0.0 ? curve(std::numbers::pi).real()
                                                      : std::numeric_limits<double>::infinity();
  constexpr int kSteps = 20000;
  for (int n = 2; n < kSteps; ++n) {
    const Complex before = curve(std::numbers::pi * (n - 1) / kSteps);
    const Complex now = curve(std::numbers::pi * n / kSteps);
    if (before.imag() * now.imag() >= 0.0 || now.real() <= 0.0) continue;
    const double share = before.imag() / (before.imag() - now.imag());
    least = std::min(least, before.real() + share * (now.real() - before.real()));
  }
  return least;
}

/// Role liaison: a hand as a spring holds a mass of the engine, whose position it knew `delay`
/// periods ago.
bool mass_swings_up(double kappa, double z, int delay) {
  engine::Mat mass;
  mass.mass = kMass;
  mass.position = Vec3(1e-6, 0.0, 0.0);
  engine::World world = world_with(mass, 0.0, z * kMass / kPeriod);
  const double hand = kappa * kMass / (kPeriod * kPeriod);
  std::deque<double> past(static_cast<std::size_t>(delay) + 1, 0.0);
  constexpr int kSteps = 10000;
  Growth growth(kSteps);
  for (int n = 0; n < kSteps; ++n) {
    past.push_back(world.position(0).x());
    past.pop_front();
    world.set_external_force(0, Vec3(-hand * past.front(), 0.0, 0.0));
    world.step();
    if (growth.add(n, world.position(0).x())) break;
  }
  return growth.grows();
}

TEST(PortStability, RoleLiaisonSwingsJustWhereItsRecurrenceSays) {
  for (const double z : {0.01, 0.05, 0.1, 0.2, 0.5}) {
    EXPECT_NEAR(liaison_boundary(z, 0), 4.0 - 2.0 * z, 1e-6);
    for (int delay = 0; delay <= 3; ++delay) {
      const double kappa = liaison_boundary(z, delay);
      EXPECT_FALSE(mass_swings_up(kappa * (1.0 - kSide), z, delay)) << z << " " << delay;
      EXPECT_TRUE(mass_swings_up(kappa * (1.0 + kSide), z, delay)) << z << " " << delay;
    }
  }
}

}  // namespace
}  // namespace cordis::sim
