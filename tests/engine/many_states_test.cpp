// tests/engine/many_states_test.cpp -- the same bits on every width, and after a snapshot.
#include "tests/engine/many_states.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

class ManyStates : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Dimensions, ManyStates, testing::Values(1, 2, 3));

void expect_same_states(const World& first, const World& second) {
  EXPECT_EQ(first.state_hash(), second.state_hash());
  const engine::Energy one = first.energy();
  const engine::Energy other = second.energy();
  EXPECT_EQ(one.elastic, other.elastic);
  EXPECT_EQ(one.dissipated, other.dissipated);
  EXPECT_EQ(one.switching, other.switching);
  EXPECT_EQ(one.elastic_error, other.elastic_error);
  EXPECT_EQ(one.port_work, other.port_work);
  for (std::uint32_t source = 0; source < 6; ++source) {
    for (std::uint32_t target = 0; target < 6; ++target) {
      EXPECT_EQ(first.change_count(0, source, target), second.change_count(0, source, target));
    }
  }
  for (std::uint32_t l = 0; l < 76; ++l) {
    EXPECT_EQ(first.state_of(l), second.state_of(l)) << "link " << l;
    EXPECT_EQ(first.rest_length_of(l), second.rest_length_of(l)) << "link " << l;
    EXPECT_EQ(first.tension_of(l), second.tension_of(l)) << "link " << l;
  }
}

TEST_P(ManyStates, AreAllVisited) {
  World world = make_world(network_of_many_states(GetParam()));
  stir(world, 1000);

  for (std::uint32_t target = 0; target < 6; ++target) {
    std::uint64_t entries = 0;
    for (std::uint32_t source = 0; source < 6; ++source)
      entries += world.change_count(0, source, target);
    EXPECT_GT(entries, 0U) << "state " << target;
  }
}

TEST_P(ManyStates, StepToTheSameBitsOnEveryWidth) {
  World narrow = make_world(network_of_many_states(GetParam()), VectorWidth::kSse2);
  stir(narrow, 1000);

  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(network_of_many_states(GetParam()), width);
    stir(world, 1000);
    SCOPED_TRACE(engine::to_string(width));
    expect_same_states(world, narrow);
  }
}

TEST_P(ManyStates, GoOnFromASnapshotBitForBit) {
  World first = make_world(network_of_many_states(GetParam()));
  stir(first, 300);
  first.force_state(8, 2);  // still to come
  const engine::Snapshot snapshot = first.snapshot();
  World second = make_world(network_of_many_states(GetParam()));
  stir(second, 50);
  second.force_state(9, 1);  // to be forgotten

  second.restore(snapshot);

  expect_same_states(first, second);
  EXPECT_TRUE(second.events().empty());
  stir(first, 300);
  stir(second, 300);
  expect_same_states(first, second);
}

TEST_P(ManyStates, GoOnFromASnapshotOfOtherParameters) {
  World first = make_world(network_of_many_states(GetParam()));
  stir(first, 100);
  StateMachine stiffer = state_machine_of_many_states();
  stiffer.states[0].stiffness *= 2.0;
  stiffer.exits[0].when.code[0].quantity = Quantity::kImpulse;
  first.replace_state_machine(0, stiffer);
  stir(first, 100);
  const engine::Snapshot snapshot = first.snapshot();
  World second = make_world(network_of_many_states(GetParam()));

  second.restore(snapshot);
  stir(first, 100);
  stir(second, 100);

  expect_same_states(first, second);
  World plain = make_world(network_of_many_states(GetParam()));
  const engine::Snapshot of_plain = plain.snapshot();
  second.restore(of_plain);
  stir(plain, 100);
  stir(second, 100);
  expect_same_states(plain, second);
}

TEST_P(ManyStates, RefuseASnapshotThatIsCutShort) {
  World world = make_world(network_of_many_states(GetParam()));
  stir(world, 5);
  engine::Snapshot snapshot = world.snapshot();
  const std::uint64_t hash = world.state_hash();
  while (!snapshot.state.empty()) {
    snapshot.state.pop_back();
    ASSERT_THROW(world.restore(snapshot), std::invalid_argument) << snapshot.state.size();
  }
  EXPECT_EQ(world.state_hash(), hash);
}

TEST_P(ManyStates, AreSeenByTheHash) {
  const NetworkDescription scene = network_of_many_states(GetParam());
  NetworkDescription other = scene;
  other.state_links[3].rest_length += 1e-15;
  EXPECT_NE(make_world(scene).state_hash(), make_world(other).state_hash());
  other = scene;
  other.state_machines[0].start = 1;
  EXPECT_NE(make_world(scene).state_hash(), make_world(other).state_hash());
}

TEST_P(ManyStates, KeepTheirAccount) {
  World world = make_world(network_of_many_states(GetParam()));
  double largest = 0.0;

  for (int n = 0; n < 1000; ++n) {
    stir(world, 10);
    const engine::Energy energy = world.energy();
    largest = std::max(largest, std::abs(energy.residual()) / energy.largest);
  }

  EXPECT_LT(largest, 1e-11) << "over 10,000 steps";
  EXPECT_NE(world.energy().switching, 0.0);
}

}  // namespace
}  // namespace cordis::test
