// tests/plan/band_edge_test.cpp -- the errors of pitch and decay that a plan says hold in a run.
#include <cmath>
#include <complex>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/rate.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/rounds.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;
using Complex = std::complex<double>;

/// A mass of 1 kg on what is linear about its rest.
struct Held {
  NetworkDescription scene;
  double stiffness = 0.0;  // of all springs [N/m]
  double viscosity = 0.0;  // of all dampers [N s/m]

  explicit Held(IntegratorKind integrator) {
    scene.dimension = 1;
    scene.step = 1e-3;
    scene.integrator = integrator;
    scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.001, 0, 0))};
  }
  void add_link(double k, double z) {
    scene.links.push_back({0, 1, k, z, 0.0});
    stiffness += k;
    viscosity += z;
  }
  void add_state_link(StateMachine machine, double k, double z) {
    scene.state_links.push_back(
        {0, 1, static_cast<std::uint32_t>(scene.state_machines.size()), 0.0});
    scene.state_machines.push_back(std::move(machine));
    stiffness += k;
    viscosity += z;
  }
  void add_maxwell(double k, double z) { scene.maxwell_links.push_back({0, 1, k, z}); }

  /// The complex rate s of x = e^(s t) that swings [1/s].
  Complex exact_rate() const {
    const auto sum = [&](Complex s) {
      Complex value = s * s + viscosity * s + stiffness;
      for (const engine::MaxwellLink& link : scene.maxwell_links)
        value += link.stiffness * s / (s + link.stiffness / link.viscosity);
      return value;
    };
    Complex s(0.0, std::sqrt(stiffness));
    for (int n = 0; n < 200; ++n) {
      const Complex slope = (sum(s * 1.000001) - sum(s)) / (s * 1e-6);
      const Complex change = sum(s) / slope;
      s -= change * std::min(1.0, 0.3 * std::abs(s) / std::abs(change));
    }
    return s;
  }
};

/// The complex rate of a run. Each value is a sum of the two values before it, by least squares; of three beside a
/// Maxwell element, which adds what creeps.
Complex rate_of_run(const NetworkDescription& scene, double frequency_hz) {
  World world = make_world(scene);
  const int stride = std::max(1, static_cast<int>(0.25 / (frequency_hz * scene.step)));
  const double time = scene.step * stride;
  std::vector<double> x;
  for (int n = 0; n < static_cast<int>(8.0 / (frequency_hz * time)) + 8; ++n) {
    x.push_back(world.position(1).x());
    run(world, stride);
  }
  const Eigen::Index order = scene.maxwell_links.empty() ? 2 : 3;
  const Eigen::Index rows = static_cast<Eigen::Index>(x.size()) - order;
  Eigen::MatrixXd before(rows, order);
  Eigen::VectorXd now(rows);
  for (Eigen::Index n = 0; n < rows; ++n) {
    for (Eigen::Index k = 0; k < order; ++k)
      before(n, k) = x[static_cast<std::size_t>(n + order - 1 - k)];
    now[n] = x[static_cast<std::size_t>(n + order)];
  }
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(order, order);
  companion.row(0) = before.colPivHouseholderQr().solve(now).transpose();
  for (Eigen::Index k = 1; k < order; ++k) companion(k, k - 1) = 1.0;
  const Eigen::VectorXcd roots = companion.eigenvalues();
  Complex swinging = roots[0];
  for (const Complex& root : roots) {
    if (root.imag() > swinging.imag()) swinging = root;
  }
  return std::log(swinging) / time;
}

/// Holds the errors of a run against those of the plan at the frequency of the vibration.
void expect_within_plan(const Held& held, const std::string& what) {
  const Complex exact = held.exact_rate();
  // K / m of the vibration, whose dampers shift its frequency.
  const double band_hz = std::abs(exact) / (2.0 * M_PI);
  const plan::BandEdge edge = plan::plan_of(held.scene, band_hz).band_edge;
  const Complex reached = rate_of_run(held.scene, exact.imag() / (2.0 * M_PI));
  const double pitch = reached.imag() / exact.imag() - 1.0;
  const double decay = reached.real() / exact.real() - 1.0;
  ASSERT_TRUE(edge.error.oscillates) << what;
  constexpr double kSpare = 1.2;  // the plan counts to first order
  EXPECT_LE(std::abs(pitch), kSpare * std::abs(edge.error.pitch) + 2e-4)
      << what << ": pitch " << pitch << " in a run, " << edge.error.pitch << " in the plan";
  EXPECT_LE(std::abs(decay), kSpare * std::abs(edge.error.decay) + 2e-3)
      << what << ": decay " << decay << " in a run, " << edge.error.decay << " in the plan";
}

/// A number whose logarithm is as likely anywhere.
double decades(std::mt19937& random, double low, double high) {
  return low * std::pow(high / low, std::uniform_real_distribution<double>()(random));
}

class BandEdge : public testing::TestWithParam<IntegratorKind> {};

INSTANTIATE_TEST_SUITE_P(Integrators, BandEdge,
                         testing::Values(IntegratorKind::kCordis, IntegratorKind::kLeapfrog,
                                         IntegratorKind::kModal, IntegratorKind::kImplicit),
                         [](const auto& tested) { return engine::to_string(tested.param); });

TEST_P(BandEdge, HoldsBesideMaxwellElements) {
  std::mt19937 random(test_seed());
  for (int n = 0; n < rounds(40); ++n) {
    Held held(GetParam());
    const double w = decades(random, 60.0, 500.0);
    held.add_link(w * w, decades(random, 0.5, 5.0));
    const double k = decades(random, 0.01, 3.0) * w * w;
    // from a damper to a spring; not so viscous that nothing swings
    held.add_maxwell(k, std::min(k / w * decades(random, 0.01, 100.0), 0.3 * w));
    expect_within_plan(held, std::to_string(n));
  }
}

TEST_P(BandEdge, HoldsBesideLinksWithStates) {
  std::mt19937 random(test_seed());
  for (int n = 0; n < rounds(40); ++n) {
    Held held(GetParam());
    const double w = decades(random, 60.0, 500.0);
    const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random);
    const double k = n % 3 == 2 ? 0.0 : share * w * w;
    held.add_link(w * w - k + 1.0, decades(random, 0.1, 2.0));
    const double z = decades(random, 1.0, 0.2 * w);
    Behaving machine;
    if (n % 3 == 0) {  // the other state is much stiffer, and never entered
      machine.state(share * w * w, z)
          .exit(q(Quantity::kElongation) > 1.0, 1)
          .state(30.0 * w * w, z);
      machine.exit(q(Quantity::kElongation) < 1.0, 0);
    } else if (n % 3 == 1) {  // a law
      LinkState state;
      state.elasticity = engine::Power{k, 1.0};
      state.viscosity = z;
      machine.state(state);
    } else {  // a damper alone
      machine.state(0.0, z).exit(q(Quantity::kElongation) > 1.0, 1).state(1.0, z);
    }
    held.add_state_link(machine.state_machine, k, z);
    expect_within_plan(held, std::to_string(n));
  }
}

/// The rates at which masses creep in a run, that are each held by a spring and a damper [1/s].
std::vector<double> creep_rates(const NetworkDescription& scene, const std::vector<double>& exact) {
  std::vector<double> rates;
  for (std::uint32_t i = 0; i < exact.size(); ++i) {
    World world = make_world(scene);
    const auto steps = [&](double of_rate) {
      return static_cast<int>(std::lround(of_rate / (exact[i] * scene.step)));
    };
    run(world, steps(4.0));  // the faster mode is gone
    const double before = world.position(i + 1).x();
    run(world, steps(2.0));
    rates.push_back(std::log(before / world.position(i + 1).x()) / (steps(2.0) * scene.step));
  }
  return rates;
}

TEST_P(BandEdge, HoldsForWhatCreepsBesideHeavierDampers) {
  if (GetParam() == IntegratorKind::kModal) return;  // exact
  std::mt19937 random(test_seed());
  double worst = 0.0;
  for (int n = 0; n < 20; ++n) {  // in few rounds none may come near to what is said
    NetworkDescription scene;
    scene.dimension = 1;
    scene.step = 2e-4;
    scene.integrator = GetParam();
    scene.mats = {fixed(Vec3::Zero())};
    std::vector<double> exact;
    for (std::uint32_t i = 1; i <= 3; ++i) {
      // the lightest creep of the band is among them in every other round
      const bool is_edge = n % 2 == 0 && i == 1;
      const double w = is_edge ? 120.0 : decades(random, 30.0, 120.0);
      const double rate = w * (is_edge ? 1.25 : decades(random, 1.25, 20.0));  // Z / 2 m
      scene.mats.push_back(mass(1.0, Vec3(0.001, 0, 0)));
      scene.links.push_back({0, i, w * w, 2.0 * rate, 0.0});
      exact.push_back(w * w / (rate + std::sqrt(rate * rate - w * w)));
    }
    const plan::OscillatorError edge = plan::plan_of(scene, 120.0 / (2.0 * M_PI)).band_edge.error;
    ASSERT_TRUE(edge.creeps) << n;
    const std::vector<double> rates = creep_rates(scene, exact);
    for (std::size_t i = 0; i < rates.size(); ++i) {
      const double error = std::abs(rates[i] / exact[i] - 1.0);
      EXPECT_LE(error, 1.05 * std::abs(edge.creep) + 1e-5) << n << ": mass " << i + 1;
      worst = std::max(worst, error / std::abs(edge.creep));
    }
  }
  EXPECT_GT(worst, 0.3);  // it says not much more than what is
}

TEST(BandEdge, ARateIsChosenForTheLightestCreep) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.001, 0, 0)), mass(1.0, Vec3(0.001, 0, 0))};
  scene.links = {{0, 1, 1e4, 250.0, 0.0}, {0, 2, 1e3, 3e3, 0.0}};
  const plan::FormulaRate chosen =
      plan::rate_by_formula(scene, {.tolerance = 0.001, .band_hz = 20.0}, 1000.0);

  scene.step = 1.0 / chosen.rate_hz;
  EXPECT_NEAR(creep_rates(scene, {50.0})[0] / 50.0, 1.0, 1.05e-3) << chosen.rate_hz;
}

// Its frequency and the rate of its slower mode are known to a root of their errors alone.
TEST(BandEdge, NearCriticalDampingNeedsNoRateWithoutEnd) {
  for (const double viscosity : {245.0, 251.0, 251.32741, 251.4, 260.0}) {
    NetworkDescription scene;
    scene.dimension = 1;
    scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.001, 0, 0))};
    scene.links = {{0, 1, 125.6637 * 125.6637, viscosity, 0.0}};
    const plan::AccuracyTarget target{.tolerance = 0.01, .band_hz = 20.0};
    EXPECT_LE(plan::rate_by_formula(scene, target, 1000.0).rate_hz, 2e4) << viscosity;
  }
}

TEST(BandEdge, OfAContactThatDoesNotTouchAtTheStartIsThatOfTheModes) {
  Held held(IntegratorKind::kModal);
  held.add_link(1e4, 1.0);
  LinkState state = LinkState{};
  state.stiffness = 5e3;
  state.pulls = false;
  Behaving machine;
  machine.state(state);
  held.add_state_link(machine.state_machine, 0.0, 0.0);
  EXPECT_EQ(plan::plan_of(held.scene, 16.0).band_edge.error.pitch, 0.0) << "it is drawn out";
  held.scene.mats[1].position.x() = -0.001;
  EXPECT_GT(plan::plan_of(held.scene, 16.0).band_edge.error.pitch, 1e-4);
}

TEST(BandEdge, ARateIsChosenForWhatTheModesDoNotHold) {
  Held held(IntegratorKind::kModal);
  held.add_link(88'826.0, 1.0);
  LinkState state;
  state.elasticity = engine::Power{799'438.0, 1.0};
  Behaving machine;
  machine.state(state);
  held.add_state_link(machine.state_machine, 799'438.0, 0.0);
  const double frequency_hz = held.exact_rate().imag() / (2.0 * M_PI);  // 150 Hz

  const plan::FormulaRate chosen =
      plan::rate_by_formula(held.scene, {.tolerance = 0.001, .band_hz = frequency_hz}, 1000.0);

  held.scene.step = 1.0 / chosen.rate_hz;
  const Complex reached = rate_of_run(held.scene, frequency_hz);
  EXPECT_NEAR(reached.imag() / held.exact_rate().imag(), 1.0, 1.1e-3) << chosen.rate_hz;
  EXPECT_LT(chosen.rate_hz, 20'000.0);
}

}  // namespace
}  // namespace cordis::test
