// tests/node/random_token_test.cpp
#include "node/random_token.h"

#include <array>
#include <cstddef>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

TEST(RandomToken, HasThirtyTwoHexadecimalDigitsAndNoneComesTwice) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string token = random_token();
    ASSERT_EQ(token.size(), 32u);
    ASSERT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    ASSERT_TRUE(seen.insert(token).second) << token;
  }
}

TEST(RandomToken, EveryDigitTakesEveryValue) {
  std::array<std::set<char>, 32> values;
  for (int i = 0; i < 1000; ++i) {  // a value is missing in one of 1e25 such tests
    const std::string token = random_token();
    for (std::size_t digit = 0; digit < values.size(); ++digit) values[digit].insert(token[digit]);
  }
  for (const std::set<char>& digits : values) EXPECT_EQ(digits.size(), 16u);
}

}  // namespace
}  // namespace cordis::node
