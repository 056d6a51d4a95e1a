// tests/sim/input_kind_test.cpp -- commands as kinds of inputs.
#include "sim_node/run/input_kind.h"

#include <set>

#include <gtest/gtest.h>

namespace cordis::sim {
namespace {

TEST(InputKind, OfEachCommandLeadsBackToIt) {
  std::set<msg::InputKind> kinds;
  for (const msg::ControlVerb verb : {msg::VERB_PAUSE, msg::VERB_RESUME, msg::VERB_STEP,
                                      msg::VERB_RESET, msg::VERB_SET, msg::VERB_STATE}) {
    EXPECT_EQ(verb_of(input_kind_of(verb)), verb);
    kinds.insert(input_kind_of(verb));
  }
  EXPECT_EQ(kinds.size(), 6U);
  for (const msg::InputKind other : {msg::INPUT_HOLD, msg::INPUT_REPEAT, msg::INPUT_LET_GO})
    EXPECT_FALSE(verb_of(other).has_value());
  EXPECT_FALSE(verb_of(static_cast<msg::InputKind>(77)).has_value()) << "of a damaged take";
}

}  // namespace
}  // namespace cordis::sim
