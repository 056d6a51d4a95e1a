// tests/render/palette_test.cpp -- views and the page have the same colours.
#include "viz_node/render/palette.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

std::string page_source(const std::string& name) {
  std::ifstream file(std::string(CORDIS_SOURCE_DIR) + "/viz_node/web/page/" + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// All colours that the page writes as three shares of 1.
std::vector<Colour> shares_in(const std::string& text, const std::string& before) {
  const std::regex shares(before + R"(\(([\d.]+), ([\d.]+), ([\d.]+)\))");
  const auto byte = [](const std::string& share) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::stod(share)));
  };
  std::vector<Colour> colours;
  for (auto match = std::sregex_iterator(text.begin(), text.end(), shares);
       match != std::sregex_iterator(); ++match) {
    colours.push_back({byte((*match)[1]), byte((*match)[2]), byte((*match)[3])});
  }
  return colours;
}

TEST(Palette, HasTheLinkColoursOfThePage) {
  EXPECT_EQ(palette_of(Theme::kDark).link_states,
            shares_in(page_source("mat_material.ts"), "new THREE\\.Color"));
}

TEST(Palette, HasTheMatterColoursOfThePage) {
  const std::vector<Colour> page = shares_in(page_source("mat_material.ts"), "vec3");
  const Palette& palette = palette_of(Theme::kDark);
  for (const Colour& colour : {palette.bodies.front(), palette.port, palette.fixed})
    EXPECT_NE(std::find(page.begin(), page.end(), colour), page.end()) << hex_of(colour);
}

TEST(Palette, HasThePlotColoursOfThePage) {
  const std::string text = page_source("plots.ts");
  for (const Colour& colour : palette_of(Theme::kDark).signals)
    EXPECT_NE(text.find(hex_of(colour)), std::string::npos) << hex_of(colour);
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

TEST(Palette, ReadsWhatItWritesAndRefusesWhatIsNoColour) {
  EXPECT_EQ(hex_of(colour_of("#0a80ff")), "#0a80ff");
  for (const char* text : {"", "#12345", "0a80ff0", "#12345g", "#1234567"})
    EXPECT_THROW(colour_of(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace cordis::viz
