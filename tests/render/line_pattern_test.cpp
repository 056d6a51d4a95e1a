// tests/render/line_pattern_test.cpp -- dashes and dots of links.
#include "viz_node/render/line_pattern.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

/// Keeps the links that are drawn.
class LinkList : public Canvas {
 public:
  struct Drawn {
    Place from;
    Place to;
    double width;
  };
  std::vector<Drawn> drawn;

  void begin_view(const Rectangle&, const std::string&) override {}
  void end_view() override {}
  void fill(const Rectangle&, const Colour&) override {}
  void ball(const Place&, double, const Colour&) override {}
  void torus(const Place&, double, double, const Colour&) override {}
  void ring(const Place&, double, double, const Colour&) override {}
  void link(const Place& from, const Place& to, double width, const Colour&) override {
    drawn.push_back({from, to, width});
  }
  void polygon(const std::vector<Corner>&, const Colour&) override {}
  void line(const std::vector<Place>&, double, const Colour&) override {}
  void text(const Place&, double, Anchor, const Colour&, std::string_view) override {}
};

double distance(const Place& a, const Place& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

constexpr Rectangle kWide{-1e4, -1e4, 2e4, 2e4};

/// Share of a long line that is inked, round ends counted.
double inked_share(LinePattern pattern) {
  LinkList canvas;
  const PatternedLine line{{0.0, 0.0, 0.0}, {3600.0, 0.0, 0.0}, 1.0, pattern, 1.0};
  draw_line(canvas, kWide, line, {});
  double inked = 0.0;
  for (const auto& [from, to, width] : canvas.drawn) inked += distance(from, to) + width;
  return inked / 3600.0;
}

TEST(LinePattern, IsInkedAsInThePage) {
  // viz_node/web/page/mat_material.ts: 5.5 of 9 pixels, and 1.7 of 4
  EXPECT_NEAR(inked_share(LinePattern::kSolid), 1.0, 1e-3);
  EXPECT_NEAR(inked_share(LinePattern::kDashed), 5.5 / 9.0, 1e-3);
  EXPECT_NEAR(inked_share(LinePattern::kDotted), 1.7 / 4.0, 1e-3);
}

TEST(LinePattern, LiesOnItsLineInAnyDirectionAndInDepth) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> any(-300.0, 300.0);
  for (int run = 0; run < 200; ++run) {
    const PatternedLine line{{any(random), any(random), any(random)},
                             {any(random), any(random), any(random)},
                             1.4,
                             run % 2 == 0 ? LinePattern::kDashed : LinePattern::kDotted,
                             1.0};
    LinkList canvas;
    draw_line(canvas, kWide, line, {});
    const double length = distance(line.from, line.to);
    for (const auto& drawn : canvas.drawn) {
      for (const Place& place : {drawn.from, drawn.to}) {
        const double share = distance(place, line.to) / length;
        EXPECT_LE(share, 1.0);
        EXPECT_NEAR(place.x, line.to.x + share * (line.from.x - line.to.x), 1e-9) << "run " << run;
        EXPECT_NEAR(place.y, line.to.y + share * (line.from.y - line.to.y), 1e-9) << "run " << run;
        EXPECT_NEAR(place.z, line.to.z + share * (line.from.z - line.to.z), 1e-9) << "run " << run;
      }
    }
  }
}

TEST(LinePattern, DrawsAllThatIsSeenOfALineThatGoesFarOutAndLittleMore) {
  const Rectangle area{0.0, 0.0, 100.0, 50.0};
  const auto seen = [&area](const PatternedLine& line) {
    LinkList canvas;
    draw_line(canvas, area, line, {});
    std::vector<double> places;
    for (const auto& drawn : canvas.drawn) {
      for (const Place& place : {drawn.from, drawn.to}) {
        if (place.x > 0.0 && place.x < 100.0) places.push_back(place.x);
      }
    }
    return std::pair{places, canvas.drawn.size()};
  };
  // 9 pixels divide 900000: the same dashes, counted from another end.
  const auto [near, near_count] =
      seen({{-90.0, 20.0, 0.0}, {180.0, 20.0, 0.0}, 1.4, LinePattern::kDashed, 1.0});
  const auto [far, far_count] =
      seen({{-900000.0, 20.0, 0.0}, {900000.0, 20.0, 0.0}, 1.4, LinePattern::kDashed, 1.0});
  ASSERT_EQ(near.size(), far.size());
  for (std::size_t i = 0; i < near.size(); ++i) EXPECT_NEAR(near[i], far[i], 1e-6);
  EXPECT_LE(far_count, 100u / 9u + 4u);
  EXPECT_EQ(seen({{-90.0, 80.0, 0.0}, {180.0, 80.0, 0.0}, 1.4, LinePattern::kDashed, 1.0}).second,
            0u);
}

TEST(LinePattern, IsLargerWhereMarksAre) {
  LinkList small;
  LinkList large;
  const PatternedLine line{{0.0, 0.0, 0.0}, {900.0, 0.0, 0.0}, 1.0, LinePattern::kDashed, 1.0};
  PatternedLine scaled = line;
  scaled.scale = 2.0;
  draw_line(small, kWide, line, {});
  draw_line(large, kWide, scaled, {});
  EXPECT_EQ(small.drawn.size(), 2 * large.drawn.size());
}

}  // namespace
}  // namespace cordis::viz
