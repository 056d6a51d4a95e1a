// tests/render/bond_image_test.cpp -- bonds of sets in images and chronograms.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "viz_node/render/chronogram.h"
#include "viz_node/render/film_view.h"
#include "viz_node/render/image.h"
#include "viz_node/render/palette.h"
#include "viz_node/render/vector_canvas.h"

namespace cordis::viz {
namespace {

constexpr std::uint8_t kStuck = 1;
constexpr std::uint8_t kTorn = 2;

/// Three balls side by side that touch, whose pairs may stick.
msg::SceneDescription row_of_balls() {
  msg::SceneDescription description;
  description.name("bonds");
  description.space(2);
  description.step_rate_hz(1000.0);
  description.frame_rate_hz(25.0);
  for (int ball = 0; ball < 3; ++ball) {
    description.mat_kind().push_back(msg::MAT_MASS);
    description.mat_mass_kg().push_back(0.001F);
    description.mat_radius_m().push_back(0.0101F);
  }
  msg::NamedRange balls;
  balls.name("balls");
  balls.count(3);
  description.matter({balls});
  msg::StateMachineDescription paste;
  paste.name("paste");
  paste.states({"apart", "stuck", "torn"});
  description.state_machines({paste});
  description.sets().resize(1);
  return description;
}

msg::SceneFrame frame_of_balls() {
  msg::SceneFrame frame;
  frame.position_m({-0.02F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.02F, 0.0F, 0.0F});
  frame.bond_count({0});
  return frame;
}

msg::SceneFrame bonded(std::uint8_t first, std::uint8_t second) {
  msg::SceneFrame frame = frame_of_balls();
  frame.bond_ends({0, 1, 1, 2});
  frame.bond_state({first, second});
  frame.bond_count({2});
  return frame;
}

Image image_of(const msg::SceneDescription& description, const msg::SceneFrame& frame) {
  FilmView view(description, {.width = 1280, .height = 720});
  return view.draw(frame);
}

int distance(const Colour& a, const Colour& b) {
  return std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue);
}

/// How many pixels of a half of two images differ, and how near one of the first is to a colour.
struct Difference {
  int left = 0;
  int right = 0;
  int nearest = 1000;
};

Difference difference_of(const Image& image, const Image& other, const Colour& colour) {
  Difference found;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (distance(image.at(x, y), other.at(x, y)) == 0) continue;
      ++(2 * x < image.width() ? found.left : found.right);
      found.nearest = std::min(found.nearest, distance(image.at(x, y), colour));
    }
  }
  return found;
}

TEST(BondImage, ShowsBondsBeforeTheBallsInTheColourOfTheirState) {
  const msg::SceneDescription description = row_of_balls();
  const std::vector<Colour>& states = palette_of(Theme::kDark).link_states;
  const Image without = image_of(description, frame_of_balls());
  for (const std::uint8_t state : {kStuck, kTorn}) {
    const Image image = image_of(description, bonded(state, kTorn + msg::LINK_IS_IDLE));
    const Difference found = difference_of(image, without, states[state]);
    EXPECT_GT(found.left, 300) << "from the middle of a ball to that of the next";
    EXPECT_LT(found.right, 12) << "what does nothing is not drawn, but for the round end";
    EXPECT_EQ(found.nearest, 0);
  }
}

TEST(BondImage, IsAsEverWithoutBonds) {
  msg::SceneFrame older = frame_of_balls();
  older.bond_count().clear();
  EXPECT_EQ(image_of(row_of_balls(), older).bytes(),
            image_of(row_of_balls(), frame_of_balls()).bytes());
}

std::string svg_of_bonds(const msg::SceneDescription& description) {
  Chronogram figure(description, {bonded(kStuck, kStuck)}, {.layout = ChronogramLayout::kRow});
  SvgCanvas canvas(figure.width(), figure.height(), figure.palette().background);
  figure.draw(canvas);
  return canvas.text();
}

TEST(BondImage, HasTheStatesOfBondsInItsLegend) {
  msg::SceneDescription description = row_of_balls();
  std::string svg = svg_of_bonds(description);
  EXPECT_NE(svg.find(">bond of sets, paste: stuck<"), std::string::npos);
  EXPECT_NE(svg.find(">paste: torn<"), std::string::npos);
  EXPECT_EQ(svg.find("apart"), std::string::npos) << "the state of the start is not drawn";
  EXPECT_EQ(svg.find(">link"), std::string::npos) << "there are no links";

  description.link_ends({0, 2});
  svg = svg_of_bonds(description);
  EXPECT_NE(svg.find(">link<"), std::string::npos);
  EXPECT_NE(svg.find(">bond of sets, paste: stuck<"), std::string::npos);
}

}  // namespace
}  // namespace cordis::viz
