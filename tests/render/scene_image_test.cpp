// tests/render/scene_image_test.cpp -- six scenes, pixel for pixel as ever.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "cli/offline/offline_session.h"
#include "tests/support/golden_hashes.h"
#include "viz_node/render/film_view.h"
#include "viz_node/render/image.h"

namespace cordis::viz {
namespace {

struct Moment {
  const char* launch;
  double time_s;
  Theme theme;
  ColourBy colour_by;
};

class SceneImage : public testing::TestWithParam<Moment> {};

/// The film of a launch file with a frame every 40 ms, at its last image.
Image image_of(const Moment& moment) {
  cli::OfflineSession session(std::string(CORDIS_SOURCE_DIR) + "/launch_configs/" + moment.launch +
                              ".yaml");
  const msg::SceneDescription description = session.description();
  FilmView view(
      description,
      {.width = 640, .height = 360, .theme = moment.theme, .colour_by = moment.colour_by});
  for (double time_s = 0.0; time_s < moment.time_s - 1e-9; time_s += 0.04) {
    session.play_until(time_s);
    view.draw(session.frame());
  }
  session.play_until(moment.time_s);
  return view.draw(session.frame());
}

TEST_P(SceneImage, HasThePixelsItEverHad) {
  const Image image = image_of(GetParam());

  const std::string path = testing::TempDir() + GetParam().launch + ".png";
  std::ofstream(path, std::ios::binary) << png_of(image);
  EXPECT_EQ(test::hexadecimal(image.hash()), test::golden_hashes("images.yaml")[GetParam().launch])
      << "look at " << path;
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SceneImage,
    testing::Values(Moment{"plasticine", 1.6, Theme::kDark, ColourBy::kBody},
                    Moment{"bodies_meeting", 1.2, Theme::kLight, ColourBy::kBody},
                    Moment{"elementary_solid", 0.4, Theme::kDark, ColourBy::kBody},
                    Moment{"stacks_shattering", 1.4, Theme::kDark, ColourBy::kSpeed},
                    Moment{"plucked_string", 0.6, Theme::kLight, ColourBy::kBody},
                    Moment{"collage_and_rupture", 1.0, Theme::kDark, ColourBy::kBody}),
    [](const auto& moment) { return std::string(moment.param.launch); });

TEST(FilmView, DrawsTheSameFrameTheSameWay) {
  const Moment moment{"material_skin", 0.2, Theme::kDark, ColourBy::kBody};
  EXPECT_EQ(image_of(moment).bytes(), image_of(moment).bytes());
}

}  // namespace
}  // namespace cordis::viz
