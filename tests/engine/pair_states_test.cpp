// tests/engine/pair_states_test.cpp
#include "sim_node/engine/pairs/pair_states.h"

#include <cstdint>
#include <set>

#include <gtest/gtest.h>

namespace cordis::test {
namespace {

using engine::PairState;
using engine::PairStates;

std::uint64_t hash_of(const PairState& pair, double memory = 0.5) {
  PairStates states(1, 4, 1);
  states.begin_step();
  EXPECT_TRUE(states.add(pair, &memory, 1));
  states.end_row(0);
  engine::StateHash hash;
  engine::Archive archive = engine::Archive::hashing(hash);
  states.serialize(archive, 0, 4, engine::StateTable({}, 0.001), 0);
  return hash.value();
}

TEST(PairStates, HashesAllThatAPairRemembers) {
  const PairState pair{
      .column = 8, .state = 1, .rest_length = 0.1, .tension = 2.0, .impulse = 0.03, .entered = 7.0};
  std::set<std::uint64_t> hashes{hash_of(pair)};
  EXPECT_TRUE(hashes.contains(hash_of(pair)));

  PairState other = pair;
  other.column = 12;
  EXPECT_TRUE(hashes.insert(hash_of(other)).second) << "the partner";
  other = pair;
  other.state = 2;
  EXPECT_TRUE(hashes.insert(hash_of(other)).second) << "the state";
  for (double PairState::*value :
       {&PairState::rest_length, &PairState::tension, &PairState::impulse, &PairState::entered}) {
    other = pair;
    other.*value += 1.0;
    EXPECT_TRUE(hashes.insert(hash_of(other)).second);
  }
}

}  // namespace
}  // namespace cordis::test
