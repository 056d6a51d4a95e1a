// tests/plan/switching_test.cpp -- what changes of state bring in, in random runs.
#include "sim_node/plan/stability/switching.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/stability/reach.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

class RandomMachine {
 public:
  explicit RandomMachine(unsigned seed) : random_(seed) {}

  /// 10 g at 0.1 m from a fixed point on a spring of 20 N/m, and on one or two links with the states.
  NetworkDescription scene() {
    NetworkDescription scene;
    scene.dimension = 1 + number(2);
    scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.1, 0, 0))};
    scene.mats[1].velocity = Vec3(real(-1.0, 1.0), 0, 0);
    if (scene.dimension > 1) scene.mats[1].velocity.y() = real(-1.0, 1.0);
    scene.links = {{0, 1, 20.0, number(2) * 0.02, 0.1}};
    scene.state_machines = {machine()};
    for (int l = 0; l <= number(2); ++l)
      scene.state_links.push_back({0, 1, 0, number(2) > 0 ? 0.1 : 0.1 + real(-0.05, 0.05)});
    constexpr double kStiffest = 500.0;
    scene.step = 0.02 * std::sqrt(0.01 / kStiffest);
    return scene;
  }

 private:
  int number(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  double real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  engine::LinkState law() {
    constexpr double kSoftest[] = {0.0, 0.0, 5.0, 20.0, 50.0, 150.0};
    engine::LinkState state;
    state.stiffness = kSoftest[number(6)];
    state.viscosity = number(3) == 0 ? 0.05 : 0.0;
    state.pushes = number(4) > 0;
    state.pulls = number(4) > 0 || !state.pushes;
    if (number(6) == 0) state.elasticity = engine::Table({0.0}, {real(-0.5, 0.5)});
    if (number(6) == 0) state.elasticity = engine::Power{2000.0, 3.0};
    if (number(6) == 0) state.force_limit = 0.5;
    return state;
  }

  Term condition() {
    const Term e = q(Quantity::kElongation);
    const double where = number(3) == 0 ? 0.0 : real(-0.06, 0.06);
    switch (number(9)) {
      case 0:
      case 1:
        return e > where;
      case 2:
      case 3:
        return e < where;
      case 4:
        return q(Quantity::kDistance) > 0.1 + where;
      case 5:
        return size(e) > std::abs(where);
      case 6:
        return two(Operation::kAnd, q(Quantity::kAge) > real(0.0, 0.1), e > where);
      case 7:
        return q(Quantity::kForce) > real(0.0, 2.0);
      default:
        return number(2) == 0 ? q(Quantity::kSpeed) < 0.0 : q(Quantity::kAge) > real(0.0, 0.2);
    }
  }

  StateMachine machine() {
    Behaving machine;
    const int count = 2 + number(3);
    for (int s = 0; s < count; ++s) {
      machine.state(law());
      for (int exits = number(3); exits > 0; --exits) {
        const auto target = static_cast<std::uint32_t>(number(count));
        switch (number(6)) {
          case 0:
            machine.exit(condition(), target, RestRule::kHere);
            break;
          case 1:
            machine.exit_to_rest(condition(), target,
                                 number(2) == 0 ? q(Quantity::kRestLength) + Term(real(-0.02, 0.02))
                                                : q(Quantity::kDistance) - Term(real(-0.02, 0.02)));
            break;
          default:
            machine.exit(condition(), target);
        }
      }
    }
    return machine.state_machine;
  }

  std::mt19937 random_;
};

/// A mass is never faster than with the energy of the start and what changes of state bring in.
TEST(Switching, BringsInNoMoreThanItsBoundInRunsOfRandomStateMachines) {
  constexpr unsigned kScenes = 1000;
  constexpr int kSteps = 5000;
  constexpr double kStep = 1.05;  // a change makes more by the order of the step
  constexpr double kNear = 0.02;  // a link in a plane turns about there [m]
  int bounded = 0;
  int some = 0;
  for (unsigned seed = 1; seed <= kScenes; ++seed) {
    const NetworkDescription scene = RandomMachine(seed).scene();
    const plan::Reach reach = plan::reach_of(scene);
    if (reach.switched || reach.endless) continue;
    ++bounded;
    if (plan::switching_of(scene, reach).all > 0.0) ++some;
    engine::World world(std::make_shared<const engine::Network>(scene));
    double most = 0.0;
    for (int n = 0; n < kSteps; ++n) {
      world.step();
      if (scene.dimension > 1 && world.position(1).norm() < kNear) break;
      most = std::max(most, world.kinetic_energy());
    }
    EXPECT_LE(most, kStep * reach.brought) << "seed " << seed;
  }
  EXPECT_GT(bounded, 600) << "of " << kScenes;
  EXPECT_GT(some, 50) << "bring in something";
}

}  // namespace
}  // namespace cordis::test
