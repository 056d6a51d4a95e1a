// tests/render/signal_plot_test.cpp
#include "viz_node/render/signal_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "viz_node/render/vector_canvas.h"

namespace cordis::viz {
namespace {

using testing::ElementsAre;

std::string svg_of(const SignalPlot& plot) {
  SvgCanvas canvas(plot.width(), plot.height(), plot.palette().background);
  plot.draw(canvas);
  return canvas.text();
}

/// The heights of the places of a curve of this colour; more than one line where it has gaps.
std::vector<std::vector<double>> heights_of(const std::string& svg, const std::string& colour) {
  // Not by std::regex, which recurses with each letter of a long list of places.
  const std::string begin = "stroke=\"" + colour + "\" stroke-width=\"1.6\"";
  const std::string list = "points=\"";
  std::vector<std::vector<double>> lines;
  for (std::size_t curve = svg.find(begin); curve != std::string::npos;
       curve = svg.find(begin, curve + 1)) {
    const std::size_t first = svg.find(list, curve) + list.size();
    std::istringstream places(svg.substr(first, svg.find('"', first) - first));
    lines.emplace_back();
    for (std::string place; places >> place;)
      lines.back().push_back(std::stod(place.substr(place.find(',') + 1)));
  }
  return lines;
}

TEST(SignalPlot, KeepsThePeakOfASingleRow) {
  std::vector<double> time;
  Curve curve{"force", "N", {}};
  for (int i = 0; i < 100'000; ++i) {
    time.push_back(i * 1e-4);
    curve.value.push_back(i == 54'321 ? 5.0 : std::sin(time.back()));
  }
  const SignalPlot plot(time, {curve}, {});
  const auto lines = heights_of(svg_of(plot), hex_of(plot.palette().signals[0]));

  ASSERT_EQ(lines.size(), 1u);
  const auto [top, bottom] = std::minmax_element(lines[0].begin(), lines[0].end());
  // From -1 to 5, with 6 % of that above and below, on 170 pixels.
  EXPECT_NEAR(*bottom - *top, 170.0 / 1.12, 0.02);
  EXPECT_LT(lines[0].size(), 8000u);
}

TEST(SignalPlot, LeavesAGapWhereThereIsNoValue) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const SignalPlot plot({0, 1, 2, 3, 4}, {{"place", "m", {1, 2, none, 2, 1}}}, {});
  const auto lines = heights_of(svg_of(plot), hex_of(plot.palette().signals[0]));

  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].size(), 2u);
  EXPECT_EQ(lines[1].size(), 2u);
}

TEST(SignalPlot, GivesEachUnitAPlotOfItsOwn) {
  const SignalPlot one({0, 1}, {{"a", "N", {0, 1}}, {"b", "N", {1, 0}}}, {});
  const SignalPlot two({0, 1}, {{"a", "N", {0, 1}}, {"b", "m", {1, 0}}}, {});
  EXPECT_GT(two.height(), one.height());
}

TEST(SignalPlot, DrawsWhatNeverChangesAndWhatIsNowhere) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const SignalPlot plot({0, 1}, {{"still", "m", {0.25, 0.25}}, {"gone", "N", {none, none}}}, {});
  const std::string svg = svg_of(plot);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(heights_of(svg, hex_of(plot.palette().signals[0])).size(), 1u);
}

/// The texts of the marks of the value axis, which end at the plot.
std::vector<std::string> marks_of(const std::string& svg) {
  const std::regex mark("text-anchor=\"end\"[^>]*>([^<]*)<");
  std::vector<std::string> marks;
  for (auto found = std::sregex_iterator(svg.begin(), svg.end(), mark);
       found != std::sregex_iterator(); ++found)
    marks.push_back((*found)[1]);
  return marks;
}

TEST(SignalPlot, GivesASignalThatStandsStillAnAxisWithDifferentMarks) {
  for (const double value : {0.0, 0.25, -3e-7, 1e-30}) {
    const SignalPlot plot({0, 1}, {{"still", "m", {value, value}}}, {});
    std::vector<std::string> marks = marks_of(svg_of(plot));
    ASSERT_GE(marks.size(), 3u) << value;
    std::ranges::sort(marks);
    EXPECT_EQ(std::ranges::adjacent_find(marks), marks.end()) << value;
  }
}

TEST(AxisMarks, AreRoundNumbers) {
  EXPECT_THAT(axis_marks(0.0, 10.0, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(axis_marks(-0.5, 0.5, 5),
              ElementsAre(testing::DoubleNear(-0.4, 1e-12), testing::DoubleNear(-0.2, 1e-12),
                          testing::DoubleNear(0.0, 1e-12), testing::DoubleNear(0.2, 1e-12),
                          testing::DoubleNear(0.4, 1e-12)));
}

}  // namespace
}  // namespace cordis::viz
