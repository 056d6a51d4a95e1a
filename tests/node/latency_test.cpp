// tests/node/latency_test.cpp
#include "node/latency.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

TEST(LatencyHistogram, GivesNothingBeforeTheFirstSample) {
  const LatencyHistogram histogram;

  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.quantile_nsec(0.5), 0.0);
  EXPECT_EQ(histogram.largest_nsec(), 0);
}

TEST(LatencyHistogram, AgreesWithSortedSamplesWithinTheWidthOfABin) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> delays(std::log(60e3), 1.5);
  LatencyHistogram histogram;
  std::vector<std::int64_t> sorted;
  for (int i = 0; i < 20000; ++i) {
    sorted.push_back(static_cast<std::int64_t>(delays(random)));
    histogram.record(sorted.back());
  }
  std::sort(sorted.begin(), sorted.end());

  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto exact = static_cast<double>(sorted[static_cast<std::size_t>(share * 20000.0) - 1]);
    EXPECT_NEAR(histogram.quantile_nsec(share), exact, 0.032 * exact)
        << share;  // bins are 1/32 octave wide
  }
  EXPECT_EQ(histogram.largest_nsec(), sorted.back());
}

TEST(LatencyHistogram, IsExactForDelaysBelow32Nanoseconds) {
  for (std::int64_t delay = 0; delay < 32; ++delay) {
    LatencyHistogram histogram;
    histogram.record(delay);
    EXPECT_EQ(histogram.quantile_nsec(0.5), static_cast<double>(delay));
  }
}

TEST(LatencyHistogram, TakesDelaysOfAnySize) {
  LatencyHistogram histogram;
  histogram.record(-5);
  histogram.record(INT64_MAX);

  EXPECT_EQ(histogram.count(), 2u);
  EXPECT_EQ(histogram.quantile_nsec(0.5), 0.0);
  EXPECT_EQ(histogram.largest_nsec(), INT64_MAX);
  EXPECT_GT(histogram.quantile_nsec(1.0), 60e9);
}

TEST(LatencyHistogram, ForgetsWhenCleared) {
  LatencyHistogram histogram;
  histogram.record(100);
  histogram.clear();
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.largest_nsec(), 0);
}

}  // namespace
}  // namespace cordis::node
