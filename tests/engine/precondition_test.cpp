// tests/engine/precondition_test.cpp -- a precondition that does not hold ends a checked build.
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/connected_components.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/idle_state.h"
#include "sim_node/engine/integrators/modal_block.h"
#include "sim_node/engine/laws/expression.h"
#include "sim_node/engine/links/state_table.h"
#include "sim_node/engine/pairs/cell_grid.h"
#include "sim_node/engine/pairs/pair_block.h"
#include "sim_node/engine/pairs/pair_friction.h"
#include "sim_node/engine/pairs/pair_states.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::engine {
namespace {

/// A fixed point, a mass, and a link with two states between them.
NetworkDescription small_network() {
  NetworkDescription network;
  network.dimension = 1;
  network.step = 1e-3;
  network.mats = {test::fixed({0.0, 0.0, 0.0}), test::mass(0.1, {0.1, 0.0, 0.0})};
  StateMachine machine;
  machine.states.resize(2);
  network.state_machines = {machine};
  network.state_links = {{0, 1, 0, 0.0}};
  return network;
}

struct Misuse {
  std::string condition;  // a part of what is printed
  std::function<void()> act;
};

TEST(PreconditionDeathTest, EachMisuseIsNamedAndEndsTheProgram) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  World world = test::make_world(small_network());
  std::vector<StateMachine> machines = small_network().state_machines;
  StateTable table(machines, 1e-3);
  StateMachine of_three_states;
  of_three_states.states.resize(3);
  StateMachine machine_without_end;  // an exit to a state that it lacks
  machine_without_end.states.resize(2);
  machine_without_end.exits.resize(1);
  machine_without_end.exits[0].target = 2;
  CellGrid grid(4, 3);
  PairStates pairs(2, 4, 1);
  NetworkDescription plane = small_network();
  plane.dimension = 2;
  plane.integrator = IntegratorKind::kModal;
  ConnectedComponents components(world.network().description(), std::vector<std::uint32_t>{0, 1});
  const std::vector<std::uint32_t> no_such_link = {7};
  SetLiaison smooth;
  NetworkDescription with_set = small_network();
  PairFriction friction(with_set, smooth, 4, 4);
  PairBlock no_pairs(2);
  double real = 0.0;
  std::uint32_t whole = 0;
  const auto is_below_two = [](std::uint32_t value) { return value < 2; };
  const std::vector<double> half = {0.5};
  const std::vector<double> two = {2.0};
  const double nowhere[4] = {test::kNan, 0.0, 0.0, 0.0};

  const std::vector<Misuse> misuses = {
      {"slot_", [&] { world.impose_position(1, Vec3::Zero()); }},  // a mass is no port
      {"slot_", [&] { world.impose_position(9, Vec3::Zero()); }},
      {"is_mass", [&] { world.set_external_force(0, Vec3::Zero()); }},
      {"row_of_link", [&] { world.force_state(3, 0); }},
      {"states.size", [&] { world.force_state(0, 2); }},
      {"state_links", [&] { world.state_of(1); }},
      {"state_links", [&] { world.rest_length_of(1); }},
      {"state_links", [&] { world.tension_of(1); }},
      {"mat_count", [&] { world.position(2); }},
      {"mat_count", [&] { world.velocity(2); }},
      {"mat_count", [&] { world.link_force(2); }},
      {"sets", [&] { world.bound_pairs(0); }},
      {"sets", [&] { world.largest_partners(0); }},
      {"sets", [&] { world.partners_of(0, 0); }},
      {"acts", [&] { friction.recall(no_pairs); }},
      {"state_links", [&] { is_idle(world, 1); }},
      {"links", [&] { components.find_joined(world, {}, no_such_link); }},
      {"states.size", [&] { table.replace(0, of_three_states); }},
      {"state_machines", [&] { table.replace(1, of_three_states); }},
      {"isfinite", [&] { grid.around(nowhere, 0); }},
      {"slot_count_", [&] { pairs.old_memory(0, 1); }},
      {"all_pass", [&] { table.replace(0, machine_without_end); }},
      {"all_pass", [&] { const StateTable bad({machine_without_end}, 1e-3); }},
      {"dt > 0", [&] { const StateTable bad({}, 0.0); }},
      {"has_content", [] { elastic_tension(Table(), {}); }},
      {"distance > 0", [&] { components.find_near(world.positions(), 0.0); }},
      {"value_count", [&] { Archive::restoring({}).real(real); }},
      {"is_exact", [&] { Archive::restoring(half).whole(whole, is_below_two); }},
      {"fits", [&] { Archive::restoring(two).whole(whole, is_below_two); }},
      {"refusal_of", [&] { const ModalBlock block(plane); }},
  };
  for (const Misuse& misuse : misuses) {
    EXPECT_DEATH(misuse.act(), "this does not hold: .*" + misuse.condition) << misuse.condition;
  }
}

TEST(Precondition, NoneIsHurtByProperUse) {
  World world = test::make_world(small_network());
  world.set_external_force(1, Vec3(0.1, 0.0, 0.0));
  world.force_state(0, 1);
  test::run(world, 3);
  EXPECT_EQ(world.state_of(0), 1U);
}

}  // namespace
}  // namespace cordis::engine
