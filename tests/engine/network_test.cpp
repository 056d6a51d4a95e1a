// tests/engine/network_test.cpp
#include "sim_node/engine/description/network.h"

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

using engine::Network;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

NetworkDescription sound() {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3(1, 0, 0))};
  scene.links = {{0, 1, 10.0, 0.1, 1.0}};
  return scene;
}

struct Fault {
  std::string said;  // part of the message
  std::function<void(NetworkDescription&)> make;
};

class NetworkFault : public testing::TestWithParam<Fault> {};

TEST_P(NetworkFault, IsRefusedByName) {
  NetworkDescription scene = sound();
  GetParam().make(scene);

  try {
    const Network network(scene);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().said), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, NetworkFault,
    testing::Values(Fault{"dimension", [](auto& s) { s.dimension = 0; }},
                    Fault{"dimension", [](auto& s) { s.dimension = 4; }},
                    Fault{"step", [](auto& s) { s.step = 0.0; }},
                    Fault{"step", [](auto& s) { s.step = -1e-3; }},
                    Fault{"step", [](auto& s) { s.step = kNan; }},
                    Fault{"step", [](auto& s) { s.step = kInfinity; }},
                    Fault{"gravity", [](auto& s) { s.gravity.y() = kNan; }},
                    Fault{"gravity", [](auto& s) { s.gravity.z() = -9.81; }},
                    Fault{"viscosity of the medium", [](auto& s) { s.medium_viscosity = -1.0; }},
                    Fault{"viscosity of the medium",
                          [](auto& s) { s.medium_viscosity = kInfinity; }},
                    Fault{"number of MATs", [](auto& s) { s.mats.clear(); }},
                    Fault{"MAT 1: mass", [](auto& s) { s.mats[1].mass = 0.0; }},
                    Fault{"MAT 1: mass", [](auto& s) { s.mats[1].mass = -1.0; }},
                    Fault{"MAT 1: mass", [](auto& s) { s.mats[1].mass = kNan; }},
                    Fault{"MAT 1: mass", [](auto& s) { s.mats[1].mass = kInfinity; }},
                    Fault{"MAT 1: mass", [](auto& s) { s.mats[1].mass = 1e-320; }},
                    Fault{"MAT 1: mass",
                          [](auto& s) {
                            s.mats[1].mass = 1e-300;
                            s.medium_viscosity = 1e20;
                          }},
                    Fault{"MAT 1: position", [](auto& s) { s.mats[1].position.x() = kNan; }},
                    Fault{"MAT 0: position", [](auto& s) { s.mats[0].position.y() = kInfinity; }},
                    Fault{"MAT 1: position", [](auto& s) { s.mats[1].position.z() = 0.1; }},
                    Fault{"MAT 1: velocity", [](auto& s) { s.mats[1].velocity.x() = kNan; }},
                    Fault{"MAT 1: velocity", [](auto& s) { s.mats[1].velocity.z() = 1.0; }},
                    Fault{"MAT 0: velocity", [](auto& s) { s.mats[0].velocity.x() = 1.0; }},
                    Fault{"MAT 0: velocity",
                          [](auto& s) {
                            s.mats[0].kind = MatKind::kPort;
                            s.mats[0].velocity.x() = 1.0;
                          }},
                    Fault{"link 0: both ends", [](auto& s) { s.links[0].mat_a = 2; }},
                    Fault{"link 0: both ends", [](auto& s) { s.links[0].mat_b = 2; }},
                    Fault{"link 0: its ends", [](auto& s) { s.links[0].mat_b = 0; }},
                    Fault{"link 1: stiffness",
                          [](auto& s) {
                            s.links.push_back({0, 1, -1.0, 0.0, 0.0});
                          }},
                    Fault{"link 0: stiffness", [](auto& s) { s.links[0].stiffness = kNan; }},
                    Fault{"link 0: viscosity", [](auto& s) { s.links[0].viscosity = -0.1; }},
                    Fault{"link 0: viscosity", [](auto& s) { s.links[0].viscosity = kInfinity; }},
                    Fault{"link 0: viscosity", [](auto& s) { s.links[0].viscosity = 1e307; }},
                    Fault{"link 0: rest length", [](auto& s) { s.links[0].rest_length = kNan; }},
                    Fault{"link 0: rest length", [](auto& s) { s.links[0].rest_length = -0.1; }},
                    Fault{"Maxwell link 0: start force", [](auto& s) {
                            s.maxwell_links.push_back({0, 1, 1.0, 1.0, kNan});
                          }}));

TEST(Network, TakesARestLengthBelowZeroInOneDimension) {
  NetworkDescription scene = sound();
  scene.dimension = 1;
  scene.links[0].rest_length = -0.1;

  EXPECT_NO_THROW(Network{scene});
}

TEST(Network, KeepsItsDescription) {
  const Network network(sound());

  EXPECT_EQ(network.dimension(), 2);
  EXPECT_EQ(network.step(), 1e-3);
  EXPECT_EQ(network.mat_count(), 2U);
  EXPECT_EQ(network.link_count(), 1U);
}

TEST(Network, HasTheFingerprintOfItsValues) {
  NetworkDescription other = sound();
  other.links[0].viscosity = 0.2;

  EXPECT_EQ(Network(sound()).fingerprint(), Network(sound()).fingerprint());
  EXPECT_NE(Network(sound()).fingerprint(), Network(other).fingerprint());

  NetworkDescription slack = sound();
  slack.maxwell_links.push_back({0, 1, 5.0, 1.0});
  NetworkDescription taut = slack;
  taut.maxwell_links[0].start_force = 0.1;
  EXPECT_NE(Network(slack).fingerprint(), Network(taut).fingerprint());
}

}  // namespace
}  // namespace cordis::test
