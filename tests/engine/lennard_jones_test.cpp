// tests/engine/lennard_jones_test.cpp -- agglomerates of Lennard-Jones balls against R11 and R22.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/balls.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

using nlohmann::json;

constexpr double kEverywhere = 100.0;

NetworkDescription agglomerate(const std::vector<Mat>& balls, double step) {
  NetworkDescription scene;
  scene.step = step;
  scene.mats = balls;
  add_set(scene, lennard_jones(1.0, 1.0, 0.0), kEverywhere, 0.0, 1'000'000);
  return scene;
}

Vec3 vector(const json& row, std::size_t first) {
  return {number(row[first]), number(row[first + 1]), number(row[first + 2])};
}

double potential(const World& world) {
  double sum = 0.0;
  const auto count = static_cast<std::uint32_t>(world.network().mat_count());
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      const double sixth = std::pow((world.position(b) - world.position(a)).norm(), -6.0);
      sum += 4.0 * (sixth * sixth - sixth);
    }
  }
  return sum;
}

/// Time from outer to outer turning point, from the speed that passes 0 between two half-steps.
double period_of_dimer(double distance, double step) {
  World world =
      make_world(agglomerate({mass(1.0, Vec3::Zero()), mass(1.0, Vec3(distance, 0, 0))}, step));
  double speed = 0.0;
  for (int n = 0;; ++n) {
    world.step();
    const double before = speed;
    speed = (world.velocity(1) - world.velocity(0)).x();
    if (before > 0.0 && speed <= 0.0) return (n - 0.5 + before / (before - speed)) * step;
  }
}

TEST(LennardJones, DimerSwingsWithItsExactPeriod) {
  const json problem = reference("R11_lennard_jones");
  for (const json& row : problem["dimer"]["period_vs_energy"]) {
    const double exact = number(row[1]);
    const double coarse = period_of_dimer(number(row[3]), 2e-3) - exact;
    const double fine = period_of_dimer(number(row[3]), 1e-3) - exact;

    EXPECT_LT(std::abs(fine), 2e-4 * exact) << "energy " << row[0];
    EXPECT_NEAR(coarse / fine, 4.0, 0.4) << "energy " << row[0];  // second order
  }
}

TEST(LennardJones, IcosahedronOfThirteenIsAtRestAndStoresItsEnergy) {
  const json data = reference("R11_lennard_jones")["LJ13"];
  std::vector<Mat> balls;
  for (const json& row : data["positions"]) balls.push_back(mass(1.0, vector(row, 0)));
  World world = make_world(agglomerate(balls, 1e-3));

  EXPECT_NEAR(world.energy().initial, number(data["energy"]), 1e-11);
  run(world, 1000);

  for (std::uint32_t i = 0; i < 13; ++i) {
    EXPECT_LT((world.position(i) - balls[i].position).norm(), 1e-11) << i;
    EXPECT_LT(world.link_force(i).norm(), 1e-9) << i;
  }
}

TEST(LennardJones, IcosahedronIsStableUpToTheStepOfItsFastestMode) {
  const json data = reference("R11_lennard_jones")["LJ13"];
  const double limit = number(data["h_max_leapfrog"]);
  for (const double part : {0.99, 1.01}) {
    std::vector<Mat> balls;
    for (const json& row : data["positions"]) {
      const Vec3 position = vector(row, 0);
      // a push of the breathing of its 12 corners, and a little of everything else
      balls.push_back(mass(1.0, position, 1e-6 * position + 1e-7 * Vec3(position.y(), 0.3, 0.1)));
    }
    World world = make_world(agglomerate(balls, part * limit));
    double farthest = 0.0;
    for (int n = 0; n < 400; ++n) {
      world.step();
      // against its own centre, which drifts
      Vec3 centre = Vec3::Zero();
      for (std::uint32_t i = 0; i < 13; ++i) centre += world.position(i) / 13.0;
      for (std::uint32_t i = 0; i < 13; ++i) {
        const double moved =
            std::abs((world.position(i) - centre).norm() - balls[i].position.norm());
        farthest = std::max(farthest, std::isfinite(moved) ? moved : 1e9);
      }
    }
    if (part < 1.0) {
      EXPECT_LT(farthest, 1e-4);
    } else {
      EXPECT_GT(farthest, 1e-2);
    }
  }
}

TEST(LennardJones, ClusterMovesAsInLammps) {
  const json data = reference("R22_lammps_cluster");
  std::vector<Mat> balls;
  for (const json& row : data["step_0"]) balls.push_back(mass(1.0, vector(row, 0), vector(row, 3)));
  World world = make_world(agglomerate(balls, 0.005));

  std::size_t next = 0;
  for (int n = 0; n <= 200; ++n) {
    const json& thermo = data["thermo"][next];
    const bool listed = thermo[0].get<std::string>() == std::to_string(n);
    const double potential_now = listed ? potential(world) : 0.0;
    std::vector<Vec3> before;
    for (std::uint32_t i = 0; i < balls.size(); ++i) {
      before.push_back(world.velocity(i));
      if (n != 100 && n != 200) continue;
      const Vec3 expected = vector(data[n == 100 ? "step_100" : "step_200"][i], 0);
      EXPECT_LT((world.position(i) - expected).norm(), 1e-9) << "ball " << i;
    }
    world.step();
    if (!listed) continue;

    double kinetic = 0.0;  // of the mean of the half-step speeds around the step
    for (std::uint32_t i = 0; i < balls.size(); ++i) {
      kinetic += 0.5 * (0.5 * (before[i] + world.velocity(i))).squaredNorm();
    }
    const double scale = std::abs(number(thermo[3]));
    EXPECT_NEAR(potential_now, number(thermo[1]), 1e-10 * scale) << "step " << n;
    EXPECT_NEAR(kinetic, number(thermo[2]), 1e-10 * scale) << "step " << n;
    EXPECT_NEAR(potential_now + kinetic, number(thermo[3]), 1e-10 * scale) << "step " << n;
    ++next;
  }
  EXPECT_EQ(next, 11U);
}

}  // namespace
}  // namespace cordis::test
