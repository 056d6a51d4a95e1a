// tests/cli/respawn_policy_test.cpp
#include "cli/run/respawn_policy.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/test_seed.h"

namespace cordis::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Time = RespawnPolicy::Time;

constexpr Time kStart{std::chrono::hours(1)};

TEST(RespawnPolicy, WaitsLongerEachTimeAndGivesUpAtTheSixthDeathOfAMinute) {
  RespawnPolicy policy;
  Time now = kStart;
  for (const int delay : {200, 1000, 5000, 5000, 5000}) {
    const std::optional<Time> restart = policy.died(now);
    ASSERT_TRUE(restart);
    EXPECT_EQ(*restart - now, milliseconds(delay));
    now = *restart;
  }
  EXPECT_FALSE(policy.died(now));
}

TEST(RespawnPolicy, BeginsAgainWithTheShortestDelayAfterAMinuteWithoutRestarts) {
  RespawnPolicy policy;
  for (Time now = kStart; const auto restart = policy.died(now);) now = *restart;
  const Time later = kStart + seconds(17) + RespawnPolicy::kWindow;

  EXPECT_EQ(policy.died(later), later + milliseconds(200));
}

TEST(RespawnPolicy, NeverGivesUpOnANodeThatRunsLongEnough) {
  RespawnPolicy policy;
  Time now = kStart;
  for (int death = 0; death < 1000; ++death) {
    const std::optional<Time> restart = policy.died(now);
    ASSERT_TRUE(restart) << "death " << death;
    now = *restart + seconds(12);
  }
}

/// Deaths at random moments: whatever they are, no minute has more than five restarts, every delay
/// is one of the three, and a node is given up only when five restarts lie in the last minute.
TEST(RespawnPolicy, NeverRestartsMoreThanFiveTimesInAnyMinuteWhateverHappens) {
  const std::uint32_t seed = test::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (int round = 0; round < 500; ++round) {
    RespawnPolicy policy;
    std::vector<Time> restarts;
    std::exponential_distribution<double> life_s(1.0 / (0.1 + round % 30));
    Time now = kStart;
    for (int death = 0; death < 100; ++death) {
      now +=
          std::chrono::duration_cast<milliseconds>(std::chrono::duration<double>(life_s(random)));
      const auto in_last_minute =
          std::count_if(restarts.begin(), restarts.end(),
                        [&](Time restart) { return restart + RespawnPolicy::kWindow > now; });
      const std::optional<Time> restart = policy.died(now);
      ASSERT_EQ(restart.has_value(), in_last_minute < 5);
      if (!restart) continue;
      ASSERT_NE(
          std::find(RespawnPolicy::kDelays.begin(), RespawnPolicy::kDelays.end(), *restart - now),
          RespawnPolicy::kDelays.end());
      restarts.push_back(*restart);
      now = *restart;
    }
    for (std::size_t i = 5; i < restarts.size(); ++i)
      ASSERT_GE(restarts[i] - restarts[i - 5], seconds(60)) << "restarts " << i - 5 << " to " << i;
  }
}

}  // namespace
}  // namespace cordis::cli
