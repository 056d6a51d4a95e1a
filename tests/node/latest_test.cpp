// tests/node/latest_test.cpp
#include "node/latest.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

TEST(Latest, HasNothingBeforeAValueAndEachValueOnce) {
  Latest<int> latest;
  int value = 0;
  EXPECT_FALSE(latest.take(value));
  latest.put(1);
  latest.put(2);
  EXPECT_TRUE(latest.take(value));
  EXPECT_EQ(value, 2);
  EXPECT_FALSE(latest.take(value));
  latest.put(3);
  EXPECT_TRUE(latest.take(value));
  EXPECT_EQ(value, 3);
}

TEST(Latest, NeverHandsOverAMixtureAndNeverAnOlderValue) {
  constexpr std::uint64_t kCount = 200'000;
  using Row = std::array<std::uint64_t, 32>;
  Latest<Row> latest;
  std::thread writer([&latest] {
    Row row;
    for (std::uint64_t n = 1; n <= kCount; ++n) {
      row.fill(n);
      latest.put(row);
    }
  });
  std::uint64_t last = 0;
  Row row{};
  while (last < kCount) {
    if (!latest.take(row)) continue;
    for (const std::uint64_t entry : row) ASSERT_EQ(entry, row[0]);
    ASSERT_GT(row[0], last);
    last = row[0];
  }
  writer.join();
}

}  // namespace
}  // namespace cordis::node
