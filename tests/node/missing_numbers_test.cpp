// tests/node/missing_numbers_test.cpp -- what is missing, and what DDS has kept back.
#include "node/dds/missing_numbers.h"

#include <gtest/gtest.h>

namespace cordis::dds {
namespace {

constexpr WriterId kStrong{1};
constexpr WriterId kWeak{2};
constexpr std::uint32_t kKey = 7;

class Exclusive : public ::testing::Test {
 protected:
  std::uint64_t strong(std::uint64_t sequence, std::uint32_t key = kKey) {
    return numbers_.note(kStrong, 10, key, sequence).missing;
  }
  std::uint64_t weak(std::uint64_t sequence, std::uint32_t key = kKey) {
    return numbers_.note(kWeak, 0, key, sequence).missing;
  }
  MissingNumbers numbers_{true};
};

TEST(MissingNumbers, OfAllWritersCountWhereNoneIsExclusive) {
  MissingNumbers numbers(false);
  EXPECT_EQ(numbers.note(kStrong, 10, kKey, 4).missing, 3u);
  EXPECT_EQ(numbers.note(kWeak, 0, kKey, 1).missing, 0u);
  EXPECT_EQ(numbers.note(kStrong, 10, kKey, 5).missing, 0u);
  EXPECT_EQ(numbers.note(kWeak, 0, kKey, 9).missing, 7u);
  EXPECT_EQ(numbers.note(kWeak, 0, kKey, 3).missing, 0u) << "an old one";
}

TEST_F(Exclusive, TheFirstOfAWriterIsMarked) {
  EXPECT_TRUE(numbers_.note(kStrong, 10, kKey, 5).is_first);
  EXPECT_FALSE(numbers_.note(kStrong, 10, kKey, 6).is_first);
  EXPECT_TRUE(numbers_.note(kWeak, 0, kKey, 5).is_first);
}

TEST_F(Exclusive, WhatTheOwnerSentIsMissing) {
  EXPECT_EQ(strong(3), 2u) << "before the first";
  EXPECT_EQ(strong(4), 0u);
  EXPECT_EQ(strong(1000), 995u);
}

TEST_F(Exclusive, WhatAWeakerOneSentWhileTheOwnerSpokeIsKeptBack) {
  EXPECT_EQ(strong(1), 0u);
  EXPECT_EQ(weak(500), 0u) << "its first, when the owner has been silent";
  EXPECT_EQ(weak(510), 9u) << "it has been the owner since";
  EXPECT_EQ(strong(2), 0u);
  EXPECT_EQ(weak(900), 0u);
}

TEST_F(Exclusive, OfTheStrongestNothingIsKeptBack) {
  EXPECT_EQ(strong(1), 0u);
  EXPECT_EQ(weak(1), 0u);
  EXPECT_EQ(strong(1000), 998u);
}

TEST_F(Exclusive, ThoseOfOtherKeysDoNotCount) {
  EXPECT_EQ(weak(1, 8), 0u);
  EXPECT_EQ(strong(1), 0u);
  EXPECT_EQ(weak(5, 8), 3u);
}

}  // namespace
}  // namespace cordis::dds
