// tests/plan/chaos_test.cpp -- how far a motion can be predicted at all.
#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/plan/reference/reference.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

plan::Reference reference_of(const NetworkDescription& scene, double period, int count) {
  return plan::make_reference(scene, {},
                              {plan::even_sampling(period, count), 1e-10, 60.0, 1000.0, {}});
}

/// Two masses in a row on springs of 0.3 m from a nail.
NetworkDescription double_pendulum(const Vec3& first, const Vec3& second) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, first), mass(0.1, first + second)};
  scene.links = {{0, 1, 500.0, 0.0, 0.3}, {1, 2, 500.0, 0.0, 0.3}};
  return scene;
}

TEST(Reference, TellsThatADoublePendulumIsChaoticAndUntilWhenItIsComparable) {
  const plan::Reference wild =
      reference_of(double_pendulum(Vec3(0.1, 0.28, 0), Vec3(0.28, 0.1, 0)), 0.05, 160);
  EXPECT_TRUE(wild.chaotic);
  EXPECT_TRUE(wild.diverged);
  EXPECT_GT(wild.compared, 10);   // 0.5 s
  EXPECT_LT(wild.compared, 150);  // 7.5 s
  EXPECT_LT(wild.uncertainty, 1e-4);

  const plan::Reference calm =
      reference_of(double_pendulum(Vec3(0.01, -0.3, 0), Vec3(0.01, -0.3, 0)), 0.05, 160);
  EXPECT_FALSE(calm.chaotic);
  EXPECT_EQ(calm.compared, 160);
}

TEST(Reference, DoesNotTakeAPitchThatDependsOnTheAmplitudeForChaos) {
  // e^3: the pitch is in proportion to the amplitude, so that phases part with the time
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 0.1, 0.0, 1e-3);
  scene.links.clear();
  scene.state_machines = {state_machine(0.0, engine::Power{4e4, 3.0})};
  scene.state_links = {{0, 1, 0, 0.0}};
  const plan::Reference reference = reference_of(scene, 0.05, 400);

  EXPECT_FALSE(reference.chaotic);
  EXPECT_EQ(reference.compared, 400);
}

TEST(Reference, SaysThatTheSamplesAreTooFewAndHowManyAreNeeded) {
  const NetworkDescription scene = oscillator(0.1, 40.0, 0.0, 0.1, 0.0, 1e-3);
  EXPECT_EQ(reference_of(scene, 0.05, plan::kFewestSamples).compared, plan::kFewestSamples);
  try {
    reference_of(scene, 0.05, 1);
    FAIL() << "one sample shows no motion";
  } catch (const plan::NothingMoves&) {
    FAIL() << "it moves";
  } catch (const std::runtime_error& refusal) {
    EXPECT_EQ(refusal.what(),
              std::string("too few samples: the duration has 1 sample, and 8 are "
                          "needed to distinguish a motion from rest: ask for 0.4 s"));
  }
}

}  // namespace
}  // namespace cordis::test
