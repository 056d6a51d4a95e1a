// tests/engine/stability_test.cpp -- the largest step, from both sides.
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

// m = 1 and dt = 1: then K is K' and Z is Z'. The slowest divergence below is 1 % a step: 1e21
// times in 5000 steps.
NetworkDescription normalised(double stiffness, double viscosity) {
  return oscillator(1.0, stiffness, viscosity, 1.0, 0.0, 1.0);
}

TEST(Stability, EndsForOneMassWhereItsReferenceSays) {
  const nlohmann::json problem = reference("R21_stability_boundaries");
  for (const auto& sample : problem["cordis_samples"]) {
    const double largest =
        largest_excursion(normalised(sample[0].get<double>(), sample[1].get<double>()));

    if (sample[3].get<bool>()) {
      EXPECT_LT(largest, 100.0) << sample;
    } else {
      EXPECT_GT(largest, 1e20) << sample;
    }
  }
}

TEST(Stability, EndsForOneMassAtStiffnessPlusTwiceTheViscosityOfFour) {
  for (const double viscosity : {0.0, 0.1, 0.5, 1.0, 1.5, 1.9}) {
    const double limit = 4.0 - 2.0 * viscosity;

    EXPECT_LT(largest_excursion(normalised(0.98 * limit, viscosity)), 100.0) << viscosity;
    EXPECT_GT(largest_excursion(normalised(1.02 * limit, viscosity)), 1e3) << viscosity;
  }
}

/// M^-1/2 (dt^2 K + 2 dt Z) M^-1/2 of a network in 1 dimension: stable where its largest eigenvalue
/// is below 4.
double largest_eigenvalue(const NetworkDescription& scene) {
  const auto count = static_cast<Eigen::Index>(scene.mats.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  for (const Link& link : scene.links) {
    const double weight =
        scene.step * scene.step * link.stiffness + 2.0 * scene.step * link.viscosity;
    const Eigen::Index a = link.mat_a;
    const Eigen::Index b = link.mat_b;
    matrix(a, a) += weight;
    matrix(b, b) += weight;
    matrix(a, b) -= weight;
    matrix(b, a) -= weight;
  }
  for (Eigen::Index a = 0; a < count; ++a) {
    matrix(a, a) += 2.0 * scene.step * scene.medium_viscosity;
    for (Eigen::Index b = 0; b < count; ++b) {
      matrix(a, b) /= std::sqrt(scene.mats[static_cast<std::size_t>(a)].mass *
                                scene.mats[static_cast<std::size_t>(b)].mass);
    }
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().maxCoeff();
}

TEST(Stability, EndsForANetworkAtTheLargestEigenvalueOfFour) {
  NetworkDescription scene = free_cluster(12, 40, 0.0, 1);
  std::mt19937 random(3);
  for (Link& link : scene.links) {
    link.viscosity = 1e-4 * static_cast<double>(random() % 1000);
    link.rest_length = 0.0;
  }
  scene.medium_viscosity = 0.02;
  double low = 1e-4;
  double high = 1.0;
  while (high / low > 1.0 + 1e-9) {
    scene.step = std::sqrt(low * high);
    (largest_eigenvalue(scene) < 4.0 ? low : high) = scene.step;
  }

  scene.step = 0.98 * low;
  EXPECT_LT(largest_excursion(scene), 1e3);
  scene.step = 1.02 * low;
  EXPECT_GT(largest_excursion(scene), 1e20);
}

}  // namespace
}  // namespace cordis::test
