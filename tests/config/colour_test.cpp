// tests/config/colour_test.cpp -- the colours that a file may name.
#include "node/config/colour.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace cordis::config {
namespace {

std::string hex_of(std::uint32_t value) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%06x", value);
  return text.data();
}

TEST(Colour, OfEveryHexadecimalTextHasItsBytes) {
  std::mt19937 random(17);
  for (int run = 0; run < 1000; ++run) {
    const std::uint32_t value = random() & 0xffffffu;
    const auto colour = colour_of(hex_of(value));
    ASSERT_TRUE(colour) << hex_of(value);
    EXPECT_EQ(colour->red << 16 | colour->green << 8 | colour->blue, static_cast<int>(value));
  }
  EXPECT_EQ(colour_of("#FF8800"), (Colour{255, 136, 0}));
}

TEST(Colour, OfANameIsThatOfCss) {
  EXPECT_EQ(colour_of("red"), (Colour{255, 0, 0}));
  EXPECT_EQ(colour_of("green"), (Colour{0, 128, 0}));
  EXPECT_EQ(colour_of("aliceblue"), (Colour{240, 248, 255}));
  EXPECT_EQ(colour_of("yellowgreen"), (Colour{154, 205, 50}));
  EXPECT_EQ(colour_of("rebeccapurple"), (Colour{102, 51, 153}));
  EXPECT_EQ(colour_of("darkgrey"), colour_of("darkgray"));
}

TEST(Colour, HasAllNamesOfCssEachOnceInOrder) {
  const std::vector<std::string> names = colour_names();
  EXPECT_EQ(names.size(), 148u);  // of CSS Color Module Level 4
  EXPECT_TRUE(std::ranges::is_sorted(names));
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
  for (const std::string& name : names) EXPECT_TRUE(colour_of(name)) << name;
}

TEST(Colour, IsNoOtherWord) {
  for (const char* word :
       {"", "#", "#fff", "#12345", "#1234567", "#12345g", "# 12345", "#-12345", "#+12345", "ff8800",
        "0xff8800", "Red", "redd", "transparent", "rgb(1,2,3)", "1"})
    EXPECT_FALSE(colour_of(word)) << word;
}

}  // namespace
}  // namespace cordis::config
