// tests/plan/rate_sweep_test.cpp -- the rates of a lab run and when they are sampled
#include "sim_node/plan/rate_sweep.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace cordis::plan {
namespace {

TEST(RateSweep, SamplesEveryRateAtStepsOfItsOwn) {
  std::mt19937 random(20261124);
  std::uniform_real_distribution<double> decade(0.0, 5.0);
  for (int round = 0; round < 2000; ++round) {
    const double limit_hz = round % 5 == 0 ? 0.0 : std::pow(10.0, decade(random));
    const RateSweepOptions options{.duration = std::pow(10.0, decade(random) - 4.0),
                                   .own_hz = std::round(std::pow(10.0, 1.0 + decade(random)))};
    const RateSweep sweep = make_rate_sweep(limit_hz, options);
    ASSERT_FALSE(sweep.rates_hz.empty()) << limit_hz << " Hz, " << options.duration << " s";
    EXPECT_TRUE(std::ranges::is_sorted(sweep.rates_hz));
    EXPECT_GE(sweep.sampling.duration(), options.duration * (1.0 - 1e-9));
    EXPECT_TRUE(std::ranges::is_sorted(sweep.sampling.moments));
    if (sweep.sampling.groups_hz.empty()) continue;  // too few
    for (const double rate : sweep.rates_hz) {
      const double group = sweep.sampling.group_of(rate);
      EXPECT_GT(group, 0.0) << rate;
      for (int sample = 0; sample < sweep.sampling.count(); ++sample) {
        if (!sweep.sampling.is_for(sample, rate, group)) continue;
        EXPECT_TRUE(is_step(sweep.sampling.time(sample), rate)) << rate << " Hz of " << group;
      }
      const auto samples = std::ranges::count_if(
          sweep.sampling.moments, [rate](double moment) { return is_step(moment, rate); });
      EXPECT_GE(samples, kFewestSamples) << rate << " Hz, " << options.duration;
    }
    if (limit_hz > 0.0) {
      EXPECT_LE(sweep.rates_hz.front(), 1.01 * limit_hz) << "begins above what diverges";
    }
  }
}

TEST(RateSweep, BeginsHigherWhereARunWouldHaveTooFewSamples) {
  // 0.25 s of a scene that diverges below 133 Hz: 20 Hz, a third of that, gives 5 samples.
  for (const double own_hz : {600.0, 1403.0}) {
    const RateSweep sweep = make_rate_sweep(133.0, {.duration = 0.25, .own_hz = own_hz});
    EXPECT_GE(sweep.sampling.count(), kFewestSamples) << own_hz;
    EXPECT_LE(sweep.rates_hz.front(), 133.0) << own_hz;
  }

  // No rate below the limit gives enough of them in a hundredth of a second.
  EXPECT_LT(make_rate_sweep(133.0, {.duration = 0.01, .own_hz = 600.0}).sampling.count(),
            kFewestSamples);
}

}  // namespace
}  // namespace cordis::plan
