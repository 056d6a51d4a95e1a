// tests/render/palette_test.cpp -- views have distinct colours, and those of the page's frame.
#include "viz_node/render/palette.h"

#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace cordis::viz {
namespace {

std::string page_source(const std::string& name) {
  std::ifstream file(std::string(CORDIS_SOURCE_DIR) + "/viz_node/web/page/" + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Palette, HasTheGroundAndTextColoursOfThePage) {
  const std::string text = page_source("page.css");
  const Palette& palette = palette_of(Theme::kDark);
  for (const Colour& colour : {palette.background, palette.text, palette.quiet, palette.frame})
    EXPECT_NE(text.find(hex_of(colour)), std::string::npos) << hex_of(colour);
}

TEST(Palette, DistinguishesBodiesInBothThemes) {
  for (const Theme theme : {Theme::kDark, Theme::kLight}) {
    const Palette& palette = palette_of(theme);
    std::set<std::string> distinct;
    for (const Colour& colour : palette.bodies) distinct.insert(hex_of(colour));
    EXPECT_EQ(distinct.size(), palette.bodies.size());
  }
}

TEST(Palette, ShowsColoursOfScenesAsThePageDoes) {
  // tests/viz/page_parts_test.mjs has the same table.
  std::ifstream file(std::string(CORDIS_SOURCE_DIR) + "/tests/golden/readable_colours.json");
  const nlohmann::json table = nlohmann::json::parse(file);
  ASSERT_FALSE(table["shown"].empty());
  for (const nlohmann::json& row : table["shown"]) {
    const Colour wanted = colour_of(row["wanted"]);
    EXPECT_EQ(hex_of(readable(wanted, palette_of(Theme::kDark))), row["dark"].get<std::string>())
        << row;
    EXPECT_EQ(hex_of(readable(wanted, palette_of(Theme::kLight))), row["light"].get<std::string>())
        << row;
  }
}

TEST(Palette, ShowsEveryColourAgainstBothBackgrounds) {
  std::mt19937 random(17);
  const auto byte = [&random] { return static_cast<std::uint8_t>(random() & 255u); };
  for (int run = 0; run < 1000; ++run) {
    const Colour wanted{byte(), byte(), byte()};
    for (const Theme theme : {Theme::kDark, Theme::kLight}) {
      const Palette& palette = palette_of(theme);
      const Colour shown = readable(wanted, palette);
      EXPECT_GE(contrast(shown, palette.background), kMinContrast) << hex_of(wanted);
      EXPECT_TRUE(shown == wanted || contrast(wanted, palette.background) < kMinContrast);
    }
  }
}

TEST(Palette, ReadsWhatItWritesAndRefusesWhatIsNoColour) {
  EXPECT_EQ(hex_of(colour_of("#0a80ff")), "#0a80ff");
  for (const char* text : {"", "#12345", "0a80ff0", "#12345g", "#1234567"})
    EXPECT_THROW(colour_of(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace cordis::viz
