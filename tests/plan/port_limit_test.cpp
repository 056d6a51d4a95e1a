// tests/plan/port_limit_test.cpp
#include "sim_node/plan/stability/port_limit.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/plan/networks.h"
#include "tests/support/haptic_boundaries.h"

namespace cordis::test {
namespace {

using plan::largest_port_stiffness;
using plan::PortLoop;

TEST(PortLimit, OfPassivityIsThatOfTheReferenceTable) {
  // With m = 1 and T = 1: device viscosity beta, port viscosity z, delay d.
  const std::vector<HapticBoundary> rows = haptic_boundaries();
  ASSERT_EQ(rows.size(), 252u);
  for (const HapticBoundary& row : rows) {
    const double limit = largest_port_stiffness(row.beta, row.z, PortLoop{1.0, row.delay});
    // The least is found on a grid: to second order in its width, pi / 4000.
    EXPECT_NEAR(limit, row.passive, 1e-5 * row.beta + 1e-4 * row.passive)
        << row.beta << " " << row.z << " " << row.delay;
    const double least = plan::min_device_viscosity({limit, row.z}, PortLoop{1.0, row.delay});
    if (limit > 0.0) {
      EXPECT_NEAR(least, row.beta, 1e-9) << "the same limit, asked the other way";
    }
  }
}

TEST(PortLimit, OfADeviceAloneIsThatOfTheReferenceTable) {
  const double mass = 0.05;
  const double period = 0.001;
  for (const HapticBoundary& row : haptic_boundaries()) {
    const plan::PortDevice device{mass, row.beta * mass / period};
    const double stiffness =
        plan::stable_port_stiffness(device, row.z * mass / period, PortLoop{period, row.delay});
    // The table has ten digits of a bisection.
    EXPECT_NEAR(stiffness * period * period / mass, row.stable, 1e-6 * row.stable + 1e-8)
        << row.beta << " " << row.z << " " << row.delay;
    const double viscosity = plan::stable_port_viscosity(device, PortLoop{period, row.delay});
    EXPECT_EQ(row.z * mass / period<viscosity, row.stable> 0.0) << "of the port alone";
  }
}

TEST(PortLimit, OfADeviceWithoutFrictionHasAClosedForm) {
  // The root of z^2 (z - 1) + c (z + 1), c = B T / 2 m, on the unit circle: c = sqrt(2) - 1.
  EXPECT_NEAR(plan::stable_port_viscosity({1.0, 1e-9}, PortLoop{1.0, 1}),
              2.0 * (std::sqrt(2.0) - 1.0), 1e-6);
}

TEST(PortLimit, FallsWithEveryPeriodOfDelay) {
  for (const auto& [delay, limit] :
       {std::pair(0, 3000.0), std::pair(1, 1000.0), std::pair(2, 600.0)}) {
    EXPECT_NEAR(largest_port_stiffness(1.5, 0.0, PortLoop{1e-3, delay}), limit, 1e-3 * limit);
  }
}

TEST(PortLimit, AsksADeviceForTheViscosityThatTheStiffnessCosts) {
  EXPECT_NEAR(plan::min_device_viscosity({1000.0, 0.0}, PortLoop{1e-3, 1}), 1.5, 1e-9);
  // without delay: K T / 2 + |B|
  EXPECT_NEAR(plan::min_device_viscosity({1000.0, 0.2}, PortLoop{1e-3, 0}), 0.7, 1e-9);
}

TEST(PortLimit, OfAHandIsTheViscosityItMeetsOverTheDelay) {
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-3, 1}), 500.0, 1e-9);
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-3, 2}), 250.0, 1e-9);
  EXPECT_EQ(plan::largest_hand_stiffness({80.0, 0.0}, 0.1, PortLoop{1e-3, 1}), 0.0);
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-3, 1, 10}), 0.5 / 1.45e-3,
              1e-9);
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

TEST(PortLoad, OfASetIsOnePartnerAtLeastAndAllForWhichThereIsRoomAtMost) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats.resize(10);
  scene.mats[0].kind = engine::MatKind::kPort;
  for (std::size_t i = 1; i < 10; ++i) scene.mats[i].mass = 0.1;
  scene.radius.assign(10, 0.01);
  engine::StateMachine contact;
  contact.states.resize(1);
  contact.states[0].stiffness = 300.0;
  contact.states[0].viscosity = 0.5;
  scene.state_machines.push_back(contact);
  engine::SetLiaison set;
  set.set_p = {0};
  set.set_q = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  set.rest_length = 0.02;
  scene.sets.push_back(set);
  const plan::LiaisonGraph graph = plan::liaison_graph(scene);

  EXPECT_DOUBLE_EQ(plan::min_port_load(graph, 0).stiffness, 300.0);
  EXPECT_DOUBLE_EQ(plan::min_port_load(graph, 0).viscosity, 0.5);
  EXPECT_DOUBLE_EQ(plan::port_load(graph, 0).stiffness, 6 * 300.0) << "equal balls around a ball";
  EXPECT_DOUBLE_EQ(plan::port_load(graph, 5).stiffness, 300.0) << "there is one port";
}

}  // namespace
}  // namespace cordis::test
