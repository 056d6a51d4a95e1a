// tests/node/tick_cost_test.cpp
#include "node/tick_cost.h"

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

TEST(TickCost, CountsPollingApart) {
  EXPECT_EQ(TickCost::text_of(2'000'000'000, 10'000, 0.0), "processor time of a tick: 200.0 us");
  EXPECT_EQ(TickCost::text_of(2'000'000'000, 10'000, 1.2),
            "processor time of a tick: 80.0 us, and 120.0 us of polling");
  EXPECT_EQ(TickCost::text_of(2'000'000'000, 0, 0.0), "") << "a loop that has not played";
}

TEST(TickCost, CountsWhatThisProcessComputesAndNotHowLongItSleeps) {
  const TickCost cost;
  const std::int64_t begun = process_processor_nsec();
  while (process_processor_nsec() - begun < 20'000'000) {
  }
  const std::string text = cost.text(1);

  EXPECT_GE(std::stod(text.substr(text.find(": ") + 2)), 20'000.0) << text;
}

}  // namespace
}  // namespace cordis::node
