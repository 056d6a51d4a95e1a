// tests/render/view_camera_test.cpp
#include "viz_node/render/view_camera.h"

#include <cstddef>
#include <random>

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

constexpr Box kRoom{{-1.0, -0.5, -0.25}, {1.0, 0.5, 0.25}};

TEST(ViewCamera, ShowsLengthsAtOneScaleInParallel) {
  const ViewCamera camera(ViewPreset::kFront, true, kRoom, 448.0, 448.0);

  // 2 m and an eighth more of room, on 448 pixels: 200 pixels per metre.
  EXPECT_NEAR(camera.metres_per_pixel(), 0.005, 1e-12);
  const Projected place = camera.project({0.5, 0.25, 0.1});
  EXPECT_NEAR(place.x, 224.0 + 100.0, 1e-9);
  EXPECT_NEAR(place.y, 224.0 - 50.0, 1e-9);
  EXPECT_NEAR(place.z, 20.0, 1e-9);
  EXPECT_NEAR(camera.radius_of(place, 0.02), 4.0, 1e-9);
}

TEST(ViewCamera, ShowsWhatIsFartherSmaller) {
  const ViewCamera camera(ViewPreset::kFront, false, kRoom, 640.0, 480.0);

  const Projected near = camera.project({0.0, 0.0, 0.25});
  const Projected far = camera.project({0.0, 0.0, -0.25});
  EXPECT_GT(near.scale, far.scale);
  EXPECT_GT(near.z, far.z);
  EXPECT_NEAR(camera.project({0.0, 0.0, 0.0}).scale * camera.metres_per_pixel(), 1.0, 0.2);
}

TEST(ViewCamera, HasEveryBoxInViewFromEverySide) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  for (int round = 0; round < 500; ++round) {
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = place(random);
      box.high[k] = box.low[k] + std::abs(place(random));
    }
    for (const ViewPreset preset :
         {ViewPreset::kFront, ViewPreset::kSide, ViewPreset::kTop, ViewPreset::kFree}) {
      for (const bool is_parallel : {true, false}) {
        const ViewCamera camera(preset, is_parallel, box, 800.0, 450.0);
        for (unsigned corner = 0; corner < 8; ++corner) {
          const Projected projected = camera.project({corner & 1 ? box.high[0] : box.low[0],
                                                      corner & 2 ? box.high[1] : box.low[1],
                                                      corner & 4 ? box.high[2] : box.low[2]});
          ASSERT_GT(projected.scale, 0.0) << "round " << round;
          ASSERT_GE(projected.x, 0.0) << "round " << round;
          ASSERT_LE(projected.x, 800.0) << "round " << round;
          ASSERT_GE(projected.y, 0.0) << "round " << round;
          ASSERT_LE(projected.y, 450.0) << "round " << round;
        }
      }
    }
  }
}

TEST(ViewCamera, LeavesOutWhatIsBehindTheViewer) {
  const ViewCamera camera(ViewPreset::kFront, false, kRoom, 640.0, 480.0);

  EXPECT_EQ(camera.project({0.0, 0.0, 100.0}).scale, 0.0);
}

}  // namespace
}  // namespace cordis::viz
