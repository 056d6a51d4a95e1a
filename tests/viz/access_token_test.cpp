// tests/viz/access_token_test.cpp
#include "viz_node/web/access_token.h"

#include <string>

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

TEST(AccessToken, IsTheFirstOneOfTheQuery) {
  EXPECT_EQ(token_of("/live?token=abc"), "abc");
  EXPECT_EQ(token_of("/live?a=b&token=abc&token=def#x"), "abc");
  EXPECT_EQ(token_of("/?token=abc#token=def"), "abc");
}

TEST(AccessToken, IsEmptyWhereNoneIsGiven) {
  for (const std::string_view target :
       {"", "/", "/?", "/?&&", "/?token", "/?token=", "/token=abc", "/?xtoken=abc", "/#?token",
        "/?a=token=abc", "/?a#token=abc", "/?a#&token=abc"})
    EXPECT_EQ(token_of(target), "") << target;
}

TEST(AccessToken, IsTheSameOnlyWhenEveryCharacterIs) {
  const std::string token = "0123456789abcdef0123456789abcdef";
  EXPECT_TRUE(is_same_secret(token, token));
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = 'x';
    EXPECT_FALSE(is_same_secret(other, token)) << i;
    EXPECT_FALSE(is_same_secret(token.substr(0, i), token)) << i;
  }
  EXPECT_FALSE(is_same_secret(token + "0", token));
  EXPECT_FALSE(is_same_secret("", ""));
}

TEST(AccessToken, IsUsableWhenItIsLongAndPlain) {
  EXPECT_TRUE(is_usable_token("0123456789abcdef"));
  EXPECT_TRUE(is_usable_token("A-long_word-of-the-lab"));
  for (const std::string_view token : {"", "short", "0123456789abcde", "0123456789abcdef&",
                                       "0123456789 abcdef", "0123456789abcde\n"})
    EXPECT_FALSE(is_usable_token(token)) << token;
}

}  // namespace
}  // namespace cordis::viz
