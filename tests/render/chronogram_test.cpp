// tests/render/chronogram_test.cpp -- where balls stand in a figure, against where they were.
#include "viz_node/render/chronogram.h"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/offline/offline_session.h"
#include "tests/render/svg_reader.h"
#include "viz_node/render/vector_canvas.h"

namespace cordis::viz {
namespace {

struct Recording {
  msg::SceneDescription description;
  std::vector<msg::SceneFrame> frames;
};

Recording record(const std::string& launch, double first_s, double every_s, int count) {
  cli::OfflineSession session(std::string(CORDIS_SOURCE_DIR) + "/launch_configs/" + launch +
                              ".yaml");
  Recording recording{session.description(), {}};
  for (int i = 0; i < count; ++i) {
    session.play_until(first_s + i * every_s);
    recording.frames.push_back(session.frame());
  }
  return recording;
}

std::string svg_of(const Recording& recording, const ChronogramOptions& options) {
  Chronogram figure(recording.description, recording.frames, options);
  SvgCanvas canvas(figure.width(), figure.height(), figure.palette().background);
  figure.draw(canvas);
  return canvas.text();
}

constexpr double kRounding = 0.0101;  // two numbers of two decimals [pixels]

TEST(Chronogram, PutsBallsWhereTheyWere) {
  const Recording recording = record("bodies_meeting", 0.6, 0.12, 6);
  std::vector<std::uint32_t> mats(recording.description.mat_kind().size());
  std::iota(mats.begin(), mats.end(), 0u);
  for (const ChronogramLayout layout :
       {ChronogramLayout::kRow, ChronogramLayout::kGrid, ChronogramLayout::kOverlay}) {
    const auto views = test::views_of(svg_of(recording, {.layout = layout}));

    ASSERT_EQ(views.size(), recording.frames.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
      EXPECT_DOUBLE_EQ(views[i].time_s, recording.frames[i].simulated_s());
      // The ring of a port is a circle too, behind all balls.
      ASSERT_EQ(views[i].x.size(), mats.size());
      EXPECT_LT(test::largest_error(views[i], mats, recording.frames[i].position_m()), kRounding);
    }
  }
}

TEST(Chronogram, HasARulerOfItsScale) {
  const std::string svg = svg_of(record("material_skin", 0.0, 0.5, 2), {});
  const double metres_per_pixel = test::views_of(svg).front().metres_per_pixel;
  // The ruler is the last line of the figure, with two ticks; behind it stands its length.
  const std::regex ruler(
      R"re(points="([\d.]+),[\d.]+ [\d.]+,[\d.]+ ([\d.]+),[\d.]+ [\d.]+,[\d.]+"/>\s*<text[^>]*>([\d.]+) mm<)re");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(svg, found, ruler));
  EXPECT_NEAR((std::stod(found[2]) - std::stod(found[1])) * metres_per_pixel,
              std::stod(found[3]) * 1e-3, 0.011 * metres_per_pixel);
}

TEST(Chronogram, FadesWhatIsPastInAnOverlay) {
  const Recording recording = record("bouncing_ball", 0.0, 0.1, 3);
  const std::string overlay = svg_of(recording, {.layout = ChronogramLayout::kOverlay});
  const std::string row = svg_of(recording, {.layout = ChronogramLayout::kRow});
  const auto gradients = [](const std::string& svg) {
    const std::regex gradient("<radialGradient");
    return std::distance(std::sregex_iterator(svg.begin(), svg.end(), gradient), {});
  };
  EXPECT_GT(gradients(overlay), gradients(row));
}

TEST(Chronogram, FitsIntoItsFigure) {
  for (const int count : {1, 2, 5, 7, 12}) {
    const Recording recording = record("material_skin", 0.0, 0.04, count);
    for (const ChronogramLayout layout : {ChronogramLayout::kRow, ChronogramLayout::kGrid}) {
      Chronogram figure(recording.description, recording.frames, {.layout = layout});
      SvgCanvas canvas(figure.width(), figure.height(), figure.palette().background);
      figure.draw(canvas);
      const std::string svg = canvas.text();
      const std::regex clip(
          R"re(<clipPath id="c\d+"><rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)")re");
      int views = 0;
      for (auto match = std::sregex_iterator(svg.begin(), svg.end(), clip);
           match != std::sregex_iterator(); ++match, ++views) {
        EXPECT_LE(std::stod((*match)[1]) + std::stod((*match)[3]), figure.width());
        EXPECT_LE(std::stod((*match)[2]) + std::stod((*match)[4]), figure.height());
      }
      EXPECT_EQ(views, count);
    }
  }
}

TEST(Chronogram, SaysWhatItsColoursCountFrom) {
  const Recording recording = record("jelly_on_stairs", 1.0, 0.12, 4);
  const std::string stretch = svg_of(recording, {.colour_by = ColourBy::kStretch});
  EXPECT_NE(stretch.find("against that at 1.00 s"), std::string::npos);
  const std::string force = svg_of(recording, {.colour_by = ColourBy::kForce});
  EXPECT_NE(force.find("mean over 240 ms"), std::string::npos);
  Recording few = recording;
  few.frames.resize(2);
  const std::string none = svg_of(few, {.colour_by = ColourBy::kForce});
  EXPECT_NE(none.find("from the third frame on"), std::string::npos);
}

}  // namespace
}  // namespace cordis::viz
