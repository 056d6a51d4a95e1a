// tests/campaigns/bursts_test.cpp
#include "tests/campaigns/bursts.h"

#include <gtest/gtest.h>

namespace cordis::campaigns {
namespace {

TEST(Bursts, TakeTheShareOfTheTimeInBurstsWithinTheLimit) {
  for (const double share : {0.1, 0.3, 0.5}) {
    Bursts bursts(share, 0.25, 7);
    double taken_s = 0.0;
    double all_s = 0.0;
    double longest_s = 0.0;
    for (int i = 0; i < 100'000; ++i) {
      const Bursts::Burst burst = bursts.next();
      taken_s += burst.taken_s;
      all_s += burst.taken_s + burst.pause_s;
      longest_s = std::max(longest_s, burst.taken_s);
    }
    EXPECT_NEAR(taken_s / all_s, share, 0.01);  // 1 / sqrt(100,000) times the spread of about 1
    EXPECT_LE(longest_s, 0.25);
    EXPECT_GT(longest_s, 0.2) << "a long one comes now and then";
  }
}

}  // namespace
}  // namespace cordis::campaigns
