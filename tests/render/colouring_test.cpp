// tests/render/colouring_test.cpp -- what the colours of films and chronograms say.
#include "viz_node/render/colouring.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "viz_node/render/number_text.h"

namespace cordis::viz {
namespace {

const Palette& palette() {
  return palette_of(Theme::kDark);
}

/// Three masses on a line, joined to a chain.
msg::SceneDescription chain() {
  msg::SceneDescription description;
  description.mat_kind({msg::MAT_MASS, msg::MAT_MASS, msg::MAT_MASS});
  description.mat_mass_kg({1.0f, 1.0f, 1.0f});
  description.mat_radius_m({0.0f, 0.0f, 0.0f});
  description.link_ends({0, 1, 1, 2});
  return description;
}

msg::SceneFrame frame(double time_s, const std::vector<float>& x,
                      const std::vector<std::uint8_t>& states = {}) {
  msg::SceneFrame frame;
  frame.simulated_s(time_s);
  std::vector<float> positions;
  for (const float one : x) positions.insert(positions.end(), {one, 0.0f, 0.0f});
  frame.position_m(positions);
  frame.link_state(states);
  return frame;
}

Colouring colouring(ColourBy what) {
  Colouring colouring(chain(), palette());
  colouring.colour_by(what);
  return colouring;
}

TEST(Colouring, OfBodiesLeavesAllAsItIs) {
  Colouring bodies = colouring(ColourBy::kBody);
  bodies.take(frame(0.0, {0, 1, 2}));
  EXPECT_EQ(bodies.of_mass(0), std::nullopt);
  EXPECT_EQ(bodies.of_link(0), std::nullopt);
  EXPECT_FALSE(bodies.scale());
}

TEST(Colouring, OfSpeedEndsAtTheFastestFreeMass) {
  Colouring speeds = colouring(ColourBy::kSpeed);
  speeds.set_free_masses({true, true, false});
  speeds.take(frame(0.0, {0, 1, 2}));
  speeds.take(frame(0.5, {0, 2, 9}));
  EXPECT_EQ(speeds.of_mass(0), palette().speeds.front());
  EXPECT_EQ(speeds.of_mass(1), palette().speeds.back());
  EXPECT_EQ(speeds.scale()->high, "2 m/s");
  EXPECT_EQ(speeds.of_link(0), std::nullopt) << "links say their states";
}

TEST(Colouring, OfForceWaitsForThreeFrames) {
  Colouring forces = colouring(ColourBy::kForce);
  forces.take(frame(0.0, {0, 1, 2}));
  forces.take(frame(0.5, {0, 1, 2}));
  EXPECT_EQ(forces.of_mass(2), palette().quiet);
  forces.take(frame(1.0, {0, 1, 3}));
  EXPECT_EQ(forces.of_mass(0), palette().speeds.front());
  EXPECT_EQ(forces.of_mass(2), palette().speeds.back());
  EXPECT_EQ(forces.scale()->high, "4 N") << "2 m/s gained in 0.5 s";
  EXPECT_EQ(forces.scale()->caption, "net force on free masses, mean over 1 s");
}

TEST(Colouring, StaysWhereAFrameComesAgain) {
  for (const ColourBy what : {ColourBy::kSpeed, ColourBy::kForce, ColourBy::kStretch}) {
    Colouring one = colouring(what);
    one.take(frame(0.0, {0, 1, 2}));
    one.take(frame(0.5, {0, 1, 2}));
    one.take(frame(1.0, {0, 1, 3}));
    const std::string high = one.scale()->high;
    const std::optional<Colour> mass = one.of_mass(2);
    const std::optional<Colour> link = one.of_link(1);
    for (int repeat = 0; repeat < 5; ++repeat) one.take(frame(1.0, {0, 1, 3}));
    EXPECT_EQ(one.scale()->high, high);
    EXPECT_EQ(one.of_mass(2), mass);
    EXPECT_EQ(one.of_link(1), link);
  }
}

TEST(Colouring, OfComponentsFollowsLinksThatBreak) {
  constexpr std::uint8_t kBroken = 1 + msg::LINK_IS_IDLE;
  Colouring components = colouring(ColourBy::kComponents);
  components.take(frame(0.0, {0, 1, 2}, {0, 0}));
  EXPECT_EQ(components.of_mass(0), palette().bodies[0]);
  EXPECT_EQ(components.of_mass(2), palette().bodies[0]);
  components.take(frame(0.1, {0, 1, 2}, {0, kBroken}));
  EXPECT_EQ(components.of_mass(1), palette().bodies[0]);
  EXPECT_EQ(components.of_mass(2), palette().quiet) << "alone";
  EXPECT_FALSE(components.scale());
}

TEST(Colouring, OfStretchCountsFromTheFirstFrame) {
  constexpr std::uint8_t kBroken = 1 + msg::LINK_IS_IDLE;
  Colouring stretches = colouring(ColourBy::kStretch);
  stretches.take(frame(2.0, {0, 1, 3}, {0, 0}));
  stretches.take(frame(2.1, {0, 1.5f, 2.5f}, {0, 0}));
  EXPECT_EQ(stretches.of_link(0), palette().stretches.back()) << "longer by half";
  EXPECT_EQ(stretches.of_link(1), palette().stretches.front()) << "shorter by half";
  EXPECT_EQ(stretches.of_mass(1), palette().quiet);
  EXPECT_EQ(stretches.scale()->low, "\u221250 %");
  EXPECT_EQ(stretches.scale()->high, "+50 %");
  EXPECT_LT(stretches.radius_share(), 1.0);
  // One that does nothing does not count.
  Colouring broken = colouring(ColourBy::kStretch);
  broken.take(frame(2.0, {0, 1, 3}, {0, 0}));
  broken.take(frame(2.1, {0, 1.1f, 9}, {0, kBroken}));
  EXPECT_EQ(broken.of_link(0), palette().stretches.back());
  EXPECT_EQ(broken.scale()->high, "+10 %");
}

TEST(Colouring, OfFramesThatAreKnownHasOneScale) {
  const std::vector<msg::SceneFrame> frames{frame(0.0, {0, 1, 2}), frame(1.0, {0, 1, 4}),
                                            frame(2.0, {0, 1, 3})};
  Colouring speeds = colouring(ColourBy::kSpeed);
  speeds.find_scale(frames);
  for (const msg::SceneFrame& one : frames) {
    speeds.take(one);
    EXPECT_EQ(speeds.scale()->high, "2 m/s");
  }
  EXPECT_EQ(speeds.of_mass(2), palette().speeds[1]) << "half as fast: the middle of three colours";
}

TEST(PercentText, IsReadAgainToTwoDigits) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> exponent(-8.0, 2.0);
  for (int run = 0; run < 300; ++run) {
    const double share = std::pow(10.0, exponent(random));
    EXPECT_NEAR(std::stod(percent_text(share)), 100.0 * share, 5.01 * share) << share;
  }
  EXPECT_EQ(percent_text(0.0), "0 %");
  EXPECT_EQ(percent_text(0.005), "0.50 %");
  EXPECT_EQ(percent_text(0.1), "10 %");
  EXPECT_EQ(percent_text(2.6), "260 %");
}

}  // namespace
}  // namespace cordis::viz
