#include "sim_node/plan/port_limit.h"

#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::largest_port_stiffness;
using plan::PortLoop;

TEST(PortLimit, IsThatOfTheReferenceTable) {
  // With m = 1 and T = 1: device viscosity beta, port viscosity z, delay d.
  std::ifstream table(std::string(CORDIS_REFERENCE_DIR) + "/R20_haptic_boundaries.csv");
  std::string line;
  std::getline(table, line);
  int rows = 0;
  while (std::getline(table, line)) {
    double beta = 0.0;
    double z = 0.0;
    int delay = 0;
    double stability = 0.0;
    double passivity = 0.0;
    ASSERT_EQ(
        std::sscanf(line.c_str(), "%lf,%lf,%d,%lf,%lf", &beta, &z, &delay, &stability, &passivity),
        5);
    const double limit = largest_port_stiffness(beta, z, PortLoop{1.0, delay});
    EXPECT_NEAR(limit, passivity, 1e-5 * beta + 1e-4 * passivity) << line;
    ++rows;
  }
  EXPECT_GT(rows, 100);
}

TEST(PortLimit, FallsWithEveryPeriodOfDelay) {
  for (const auto& [delay, limit] :
       {std::pair(0, 3000.0), std::pair(1, 1000.0), std::pair(2, 600.0)}) {
    EXPECT_NEAR(largest_port_stiffness(1.5, 0.0, PortLoop{1e-3, delay}), limit, 1e-3 * limit);
  }
}

TEST(PortLimit, AsksADeviceForTheViscosityThatTheStiffnessCosts) {
  EXPECT_NEAR(plan::least_device_viscosity({1000.0, 0.0}, PortLoop{1e-3, 1}), 1.5, 1e-9);
  // without delay: K T / 2 + |B|
  EXPECT_NEAR(plan::least_device_viscosity({1000.0, 0.2}, PortLoop{1e-3, 0}), 0.7, 1e-9);
}

TEST(PortLimit, OfAHandIsTheViscosityItMeetsOverTheDelay) {
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-3, 1}), 500.0, 1e-9);
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-3, 2}), 250.0, 1e-9);
  EXPECT_EQ(plan::largest_hand_stiffness({80.0, 0.0}, 0.1, PortLoop{1e-3, 1}), 0.0);
  // (k + K) T^2 / m + 2 Z T / m < 4
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-2, 0}), 3900.0 - 80.0,
              1e-6);
}

TEST(PortLoad, SumsWhatHangsOnThePort) {
  NetworkDescription scene = string_in_space(5, 0.01, 1e-4);
  scene.medium_viscosity = 0.2;

  const plan::PortLoad load = plan::port_load(plan::liaison_graph(scene), 3);

  EXPECT_DOUBLE_EQ(load.stiffness, 800.0);
  EXPECT_DOUBLE_EQ(load.viscosity, 0.02 + 0.2);
}

}  // namespace
}  // namespace cordis::test
