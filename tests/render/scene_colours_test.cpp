// tests/render/scene_colours_test.cpp -- colours of the scene and patterns of links in figures.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/surfaces.h"
#include "viz_node/render/scene_painter.h"
#include "viz_node/render/scene_words.h"
#include "viz_node/render/vector_canvas.h"

namespace cordis::viz {
namespace {

msg::NamedRange named(const std::string& name, std::uint32_t first, std::uint32_t count) {
  msg::NamedRange range;
  range.name(name);
  range.first(first);
  range.count(count);
  return range;
}

msg::ColouredRange coloured(std::uint32_t first, std::uint32_t count, const Colour& colour) {
  msg::ColouredRange range;
  range.first(first);
  range.count(count);
  range.red(colour.red);
  range.green(colour.green);
  range.blue(colour.blue);
  return range;
}

constexpr Colour kGivenRed{0xc8, 0x1e, 0x1e};
constexpr Colour kGivenBlue{0x20, 0x80, 0xff};

/// Two copies of a part of two masses each, a mass alone, and a fixed point.
msg::SceneDescription two_copies() {
  msg::SceneDescription description;
  description.space(2);
  description.step_rate_hz(1000.0);
  description.frame_rate_hz(25.0);
  description.mat_kind({0, 0, 0, 0, 0, 1});
  description.mat_mass_kg().assign(6, 0.1F);
  description.mat_radius_m().assign(6, 0.01F);
  description.matter({named("stack[0].ball", 0, 1), named("stack[0].core", 1, 1),
                      named("stack[1].ball", 2, 1), named("stack[1].core", 3, 1),
                      named("bob", 4, 1), named("wall", 5, 1)});
  description.link_ends({0, 1, 1, 2, 2, 3, 3, 4});
  return description;
}

msg::SceneFrame frame_of(const msg::SceneDescription& description) {
  msg::SceneFrame frame;
  for (std::size_t mat = 0; mat < description.mat_kind().size(); ++mat) {
    frame.position_m().insert(frame.position_m().end(),
                              {0.1F * static_cast<float>(mat), 0.0F, 0.0F});
  }
  return frame;
}

std::string svg_of(const msg::SceneDescription& description, Theme theme = Theme::kDark) {
  ScenePainter painter(description, theme);
  const msg::SceneFrame frame = frame_of(description);
  painter.start(frame);
  const Box home = painter.bounds(frame);
  const ViewCamera camera(ViewPreset::kFront, true, home, 600.0, 300.0);
  SvgCanvas canvas(600.0, 330.0, painter.palette().background);
  const Rectangle area{0.0, 0.0, 600.0, 300.0};
  painter.draw(canvas, {.area = area, .inner = area}, camera, home, frame);
  draw_legend(canvas, painter, {10.0, 320.0, 0.0}, 12.0, 580.0);
  return canvas.text();
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t place = text.find(word); place != std::string::npos;
       place = text.find(word, place + 1))
    ++count;
  return count;
}

std::vector<std::string> names_of(const ScenePainter& painter) {
  std::vector<std::string> names;
  for (const Body& body : painter.bodies()) names.push_back(body.name + " " + hex_of(body.colour));
  return names;
}

TEST(SceneColours, OfTheSceneStandBeforeThoseOfBodiesAndAreNamed) {
  msg::SceneDescription description = two_copies();
  const Palette& palette = palette_of(Theme::kDark);
  EXPECT_EQ(names_of(ScenePainter(description, Theme::kDark)),
            (std::vector<std::string>{"stack " + hex_of(palette.bodies[0]),
                                      "bob " + hex_of(palette.bodies[1])}));

  description.colours(
      {coloured(1, 1, kGivenRed), coloured(3, 1, kGivenRed), coloured(4, 2, kGivenBlue)});
  const ScenePainter painter(description, Theme::kDark);
  EXPECT_EQ(names_of(painter),
            (std::vector<std::string>{"stack.ball " + hex_of(palette.bodies[0]),
                                      "stack.core " + hex_of(readable(kGivenRed, palette)),
                                      "bob " + hex_of(readable(kGivenBlue, palette)),
                                      "wall " + hex_of(readable(kGivenBlue, palette))}));
  EXPECT_EQ(painter.bodies().back().mark, MatterMark::kFixed);
  EXPECT_FALSE(painter.has_fixed_balls()) << "the wall has a colour of its own";
}

TEST(SceneColours, AreDrawn) {
  msg::SceneDescription description = two_copies();
  // A lit ball has a gradient per colour: stack, bob and what is fixed.
  EXPECT_EQ(count_of(svg_of(description), "<radialGradient"), 3u);
  description.colours({coloured(1, 1, kGivenRed)});
  EXPECT_EQ(count_of(svg_of(description), "<radialGradient"), 4u);
  description.colours({coloured(0, 6, kGivenRed)});
  EXPECT_EQ(count_of(svg_of(description), "<radialGradient"), 1u);
}

TEST(SceneColours, OfASurfaceAreThoseOfItsFaces) {
  msg::SceneDescription description = two_copies();
  description.surfaces(
      {test::surface("wall", msg::SURFACE_BOX, {0.5, 0.0, 0.0}, {}, {0.1, 0.1, 0.0})});
  const ScenePainter plain(description, Theme::kLight);
  EXPECT_TRUE(plain.has_surfaces());
  description.colours({coloured(5, 1, kGivenRed)});
  const ScenePainter painter(description, Theme::kLight);
  EXPECT_FALSE(painter.has_surfaces()) << "it is named by itself";
  EXPECT_EQ(painter.bodies().back().mark, MatterMark::kSurface);
  EXPECT_EQ(painter.bodies().back().colour, kGivenRed);
  EXPECT_NE(svg_of(description, Theme::kLight).find(">wall<"), std::string::npos);
}

msg::StateMachineDescription glue() {
  msg::StateMachineDescription liaison;
  liaison.name("glue");
  liaison.states({"sticks", "loose"});
  return liaison;
}

msg::StateMachineDescription hook() {
  msg::StateMachineDescription liaison;
  liaison.name("hook");
  liaison.states({"holds"});
  return liaison;
}

TEST(LinkPatterns, AreOfScenesWithSeveralLiaisonsTheMostFrequentSolid) {
  msg::SceneDescription description = two_copies();
  EXPECT_EQ(ScenePainter(description, Theme::kDark).link_groups().size(), 1u);
  description.state_machines({glue(), hook()});
  description.link_state_machine({0, 0, 0, 0});
  EXPECT_EQ(ScenePainter(description, Theme::kDark).link_groups().size(), 1u);
  const std::size_t solid_lines = count_of(svg_of(description), "L");

  description.link_state_machine({1, 1, 0, msg::NO_INDEX});
  const ScenePainter painter(description, Theme::kDark);
  ASSERT_EQ(painter.link_groups().size(), 3u);
  EXPECT_EQ(painter.link_groups()[0].name, "hook");
  EXPECT_EQ(painter.link_groups()[0].pattern, LinePattern::kSolid);
  EXPECT_EQ(painter.link_groups()[1].name, "glue");
  EXPECT_EQ(painter.link_groups()[1].pattern, LinePattern::kDashed);
  EXPECT_EQ(painter.link_groups()[2].name, "");
  EXPECT_EQ(painter.link_groups()[2].pattern, LinePattern::kDotted);
  const std::string svg = svg_of(description);
  EXPECT_GT(count_of(svg, "L"), solid_lines + 20) << "dashes and dots";
  for (const char* name :
       {">link, hook: holds<", ">glue: sticks<", ">glue: loose<", ">without states<"})
    EXPECT_NE(svg.find(name), std::string::npos) << name;
}

TEST(LinkPatterns, OfALiaisonOfOneStateHaveItsNameAlone) {
  msg::SceneDescription description = two_copies();
  msg::StateMachineDescription table = hook();
  table.name("table");
  table.states({""});
  description.state_machines({glue(), table});
  description.link_state_machine({1, 1, 0, msg::NO_INDEX});
  const std::string svg = svg_of(description);
  for (const char* name : {">link, table<", ">glue: sticks<", ">glue: loose<", ">without states<"})
    EXPECT_NE(svg.find(name), std::string::npos) << name;

  description.link_state_machine({1, 1, 1, 1});
  EXPECT_NE(svg_of(description).find(">link<"), std::string::npos);
}

TEST(LinkPatterns, AreOneForALiaisonWhateverItsParameters) {
  msg::SceneDescription description = two_copies();
  description.state_machines({hook(), glue(), glue(), glue()});
  description.link_state_machine({0, 1, 2, 3});
  const ScenePainter painter(description, Theme::kDark);
  ASSERT_EQ(painter.link_groups().size(), 2u);
  EXPECT_EQ(painter.link_groups()[0].name, "glue");
  EXPECT_EQ(painter.link_groups()[1].name, "hook");
}

TEST(HeldTools, AreRingsOfTheirTrueSizeAndNamed) {
  msg::SceneDescription description = two_copies();
  description.mat_kind()[5] = msg::MAT_PORT;
  msg::PortDescription port;
  port.name("bob");
  port.mat(5);
  description.ports({port});
  const std::string svg = svg_of(description);
  EXPECT_EQ(count_of(svg, "class=\"torus\""), 2u) << "the tool, and its mark in the legend";
  EXPECT_NE(svg.find(">tool that it holds, in true size<"), std::string::npos);
  EXPECT_NE(svg.find(">handle of a device<"), std::string::npos);

  description.mat_radius_m()[4] = 0.0F;
  const std::string punctual = svg_of(description);
  EXPECT_EQ(count_of(punctual, "class=\"torus\""), 0u);
  EXPECT_NE(punctual.find(">tool that it holds<"), std::string::npos);
}

}  // namespace
}  // namespace cordis::viz
