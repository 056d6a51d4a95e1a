// tests/sim/shadow_world_test.cpp
#include "sim_node/run/shadow_world.h"

#include <cmath>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/eventually.h"

namespace cordis::sim {
namespace {

using namespace std::chrono_literals;

/// A lattice that falls, whose near masses bind each other: a set, states, gravity and viscosity.
std::string lattice_text() {
  return R"(
cordis: 1
name: lattice
space: 3
step: {rate_hz: 4000, gesture_rate_hz: 1000}
matter:
  grains: {kind: lattice, structure: cubic, counts: [3, 3, 3], corner_m: [0, 0, 0], spacing_m: 0.01, mass_kg: 0.001}
liaisons:
  bond:
    start: free
    states:
      free: {exits: [{to: held, when: age_s > 0.2}]}
      held: {stiffness_n_per_m: 1, viscosity_n_s_per_m: 0.001, exits: [{to: free, when: elongation_m > 1}]}
links:
  - {liaison: bond, within: grains, rest_m: 0.011, range_m: 0.03, name: bonds}
)";
}

void expect_same(const WorldFigures& figures, const WorldFigures& own) {
  EXPECT_EQ(figures.step, own.step);
  EXPECT_EQ(figures.state_hash, own.state_hash);
  EXPECT_EQ(figures.energy.total(), own.energy.total());
  EXPECT_EQ(figures.energy.dissipated, own.energy.dissipated);
  EXPECT_EQ(figures.energy.residual(), own.energy.residual());
  EXPECT_EQ(figures.energy.largest, own.energy.largest);
}

/// A loop and a thread that reads, a turn of the one after the other; `text` in motion.
void expect_to_see_what_the_world_is(const std::string& text) {
  Simulation simulation(scene_of(text), kEpochOfSim);
  EventRoom events(64);
  ShadowWorld shadow(simulation.world().shared_network());
  EXPECT_FALSE(shadow.read(0ms)) << "nothing was handed over";
  EnergyWatch watch;
  for (int n = 0; n < 5; ++n) {
    for (int tick = 0; tick < 100; ++tick) simulation.advance(simulation.steps_of_tick(), events);
    const WorldFigures own = figures_of(simulation.world(), watch);
    const test::AllocationGuard guard;
    shadow.hand_over(simulation.world());
    EXPECT_EQ(guard.count(), 0u);
    simulation.advance(simulation.steps_of_tick(), events);
    shadow.hand_over(simulation.world());  // not asked again

    const std::optional<WorldFigures> figures = shadow.read(0ms);
    ASSERT_TRUE(figures);
    expect_same(*figures, own);
    EXPECT_FALSE(shadow.read(0ms));
  }
}

/// A mass that a port leads by a spring and a damper.
engine::NetworkDescription led_by_a_damper() {
  engine::NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.integrator = engine::IntegratorKind::kLeapfrog;
  engine::Mat hand;
  hand.kind = engine::MatKind::kPort;
  engine::Mat mass;
  mass.mass = 0.1;
  scene.mats = {hand, mass};
  scene.links = {{0, 1, 1000.0, 3.0, 0.0}};
  return scene;
}

/// The steps make a little at each turn of the hand, which the damper takes: it adds up to more than all the energy that
/// ever was there.
TEST(EnergyWatch, ForgetsWhatTheStepsHaveMadeAndViscosityHasTaken) {
  engine::World world(std::make_shared<const engine::Network>(led_by_a_damper()));
  EnergyWatch watch;
  engine::Energy energy;
  for (int n = 0; n < 60'000; ++n) {
    const int phase = n % 200;
    world.impose_position(0, engine::Vec3(2e-4 * (phase < 100 ? phase : 200 - phase), 0, 0));
    world.step();
    if (n % 40 != 39) continue;
    energy = watch.update(world);
    EXPECT_FALSE(makes_energy(energy)) << n;
  }
  EXPECT_GT(std::abs(energy.integration_error()), 0.2 * energy.largest);
  EXPECT_TRUE(is_error_large(energy));
}

/// A ball between two walls, whose contacts gain.
TEST(EnergyWatch, KeepsWhatIsMadeWhereNothingTakesIt) {
  engine::NetworkDescription scene = led_by_a_damper();
  scene.integrator = engine::IntegratorKind::kCordis;
  scene.mats[0].kind = engine::MatKind::kFixed;
  scene.links = {{0, 1, 0.0, 0.0, 0.0}};
  engine::StateMachine contact;  // K' = 3, met at other phases each time
  contact.states.resize(1);
  contact.states[0].stiffness = 3e5;
  contact.states[0].pulls = false;
  scene.state_machines = {contact};
  engine::Mat wall = scene.mats[0];
  wall.position.x() = 0.0137;
  scene.mats.push_back(wall);
  scene.state_links = {{0, 1, 0, 0.001}, {1, 2, 0, 0.001}};
  scene.mats[1].position.x() = 0.005;
  scene.mats[1].velocity.x() = 0.31;
  engine::World world(std::make_shared<const engine::Network>(scene));
  EnergyWatch watch;
  bool is_told = false;
  for (int n = 0; n < 20'000 && !is_told; ++n) {
    world.step();
    const engine::Energy energy = watch.update(world);
    EXPECT_NEAR(energy.made_there, energy.integration_error(), 1e-9 * energy.largest);
    is_told = makes_energy(energy);
  }
  EXPECT_TRUE(is_told);
}

TEST(ShadowWorld, SeesWhatTheWorldIs) {
  expect_to_see_what_the_world_is(swing_text());
}

TEST(ShadowWorld, SeesSetsAndStates) {
  expect_to_see_what_the_world_is(lattice_text());
}

TEST(ShadowWorld, KnowsTheKineticEnergyThatWasSeenBetweenItsCopies) {
  const Simulation simulation(scene_of(swing_text()), kEpochOfSim);
  ShadowWorld shadow(simulation.world().shared_network());
  for (const double seen : {50.0, 20.0}) {
    EXPECT_FALSE(shadow.read(0ms));
    shadow.hand_over(simulation.world(), seen);
    const std::optional<WorldFigures> figures = shadow.read(0ms);
    ASSERT_TRUE(figures);
    EXPECT_EQ(figures->energy.largest, 50.0);
  }
}

TEST(ShadowWorld, WaitsForTheLoop) {
  Simulation simulation(scene_of(swing_text()), kEpochOfSim);
  ShadowWorld shadow(simulation.world().shared_network());
  std::atomic<bool> ends = false;
  std::thread loop([&] {
    while (!ends) shadow.hand_over(simulation.world());
  });
  const std::optional<WorldFigures> figures = shadow.read(60'000ms);
  ends = true;
  loop.join();
  ASSERT_TRUE(figures);
  EnergyWatch watch;
  expect_same(*figures, figures_of(simulation.world(), watch));
}

}  // namespace
}  // namespace cordis::sim
